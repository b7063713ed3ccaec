//! A transition zone that runs in a moment, and a listener that keeps what a run tells.

use std::ops::ControlFlow;
use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::execute::{Checkpoint, Event, Listener};
use trackbed::graph::Graph;
use trackbed::nodes::PassageOutcome;
use trackbed::scenario::Scenario;

/// Six trains, each of them a block.
pub const SCENE: &str = r#"use std
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 12 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 24 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s }
scenario { allow = [stiffness_jump: "a test", track_too_short: "a test"] }
"#;

pub fn planned() -> (Scenario, Graph) {
    let compiled = compile("scene.track", SCENE, &NoModules, &[]);
    assert!(compiled.diagnostics.iter().all(|d| !d.is_error()), "{:?}", compiled.diagnostics);
    (compiled.scenario.unwrap(), compiled.graph.unwrap())
}

/// A block as it was told: what its trains did, and the settlement that they left, m.
#[derive(Debug, Clone, PartialEq)]
pub struct ToldBlock {
    pub axles: u64,
    pub passages: Vec<PassageOutcome>,
    /// Those that were computed for it, and not only those that are shown.
    pub computed: u64,
    pub settlement: Vec<f64>,
}

/// Keeps every block and every checkpoint, and ends the run after so many of them.
#[derive(Default)]
pub struct Told {
    pub blocks: Vec<ToldBlock>,
    kept: Vec<String>,
    stop_after: Option<usize>,
}

impl Told {
    pub fn until(checkpoints: usize) -> Told {
        Told { stop_after: Some(checkpoints), ..Told::default() }
    }

    /// The last checkpoint, as it comes from a disk.
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        self.kept.last().map(|text| serde_json::from_str(text).unwrap())
    }
}

impl Listener for Told {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Block { axles, block, passages, after, .. } => self.blocks.push(ToldBlock {
                axles: *axles,
                passages: passages.iter().map(|passage| (*passage).clone()).collect(),
                computed: block.map_or(0, |(_, measured)| measured.passages),
                settlement: after.to_vec(),
            }),
            Event::Between(between) => {
                self.kept.push(serde_json::to_string(&between.checkpoint().unwrap()).unwrap());
                if self.stop_after == Some(self.kept.len()) {
                    return ControlFlow::Break(());
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
