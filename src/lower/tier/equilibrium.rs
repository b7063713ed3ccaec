//! The track at rest under test loads, on supports of known stiffness.

use super::{Proposal, Tier, edges};
use crate::diag::{Code, Diagnostic};
use crate::graph::{ExpectedError, LoadedPart, Model, Node, PointLoad, Schedule, SpringsNode};
use crate::lower::{Draft, cost, track};
use crate::scenario::{Foot, Loading, Scenario, StaticLoad, Target, Track};
use crate::schema::Reads;

pub struct Equilibrium;

impl Tier for Equilibrium {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn answers(&self, word: &str) -> bool {
        word == "law"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&track::READS, &track::SUPPORTS]
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let Some(Loading::Static(loads)) = &draft.scenario.loading else {
            return Err("no constant loads act on the track".into());
        };
        if loads.iter().any(|load| load.on == Target::Bed) {
            return Err("a plate presses on a bed of grains".into());
        }
        if !draft.is_sprung() {
            return Err("rails, pads or supports of known stiffness are missing".into());
        }
        let node = track::track(draft);
        let cost = cost::at_rest(&node);
        let supports = SpringsNode { supports: draft.supports.clone() };
        let nodes =
            vec![Node::new("track", Model::Track(Box::new(node))), Node::new("substructure", Model::Springs(supports))];
        Ok(Proposal {
            edges: edges(&nodes),
            nodes,
            schedule: Schedule::Static { loads: point_loads(draft.scenario, loads) },
            cost,
            what: "no settlement".into(),
            why: "test loads act on a track at rest".into(),
            error: ExpectedError::default(),
            runs: true,
            refusals: unmoved(draft.scenario, loads),
        })
    }
}

/// A load on sleepers acts on the nearest one.
fn point_loads(scenario: &Scenario, loads: &[StaticLoad]) -> Vec<PointLoad> {
    let nearest = |x: f64| nearest(&scenario.track, x).unwrap_or(0);
    // loads on the rail first: the sums use this order
    let part = |load: &StaticLoad| match load.on {
        Target::Rail => LoadedPart::Rail { x: load.x },
        Target::Sleepers | Target::Bed => LoadedPart::Sleeper { seat: nearest(load.x) },
    };
    loads.iter().map(|load| PointLoad { on: part(load), force: *load.force }).collect()
}

fn nearest(track: &Track, x: f64) -> Option<usize> {
    let distance = |seat: &usize| (track.seats[*seat].x - x).abs();
    (0..track.seats.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// Diagnostics for loads on sleepers that no spring carries: on a rigid support, or on a slab.
fn unmoved(scenario: &Scenario, loads: &[StaticLoad]) -> Vec<Diagnostic> {
    let track = &scenario.track;
    let refused = |load: &StaticLoad| {
        let seat = &track.seats[nearest(track, load.x).filter(|_| load.on == Target::Sleepers)?];
        let why = match seat.foot {
            Foot::Sleeper { .. } => return None,
            Foot::Rigid => "`support = rigid`: its sleeper does not move",
            Foot::Slab => "a slab, without a sleeper",
        };
        let (name, load_name) = (track.seat_name(seat), &load.name);
        let message = format!("`{load_name}` acts on sleeper {name}, which has {why}");
        let help = "write `on = rail`, or give the trackform a `sleeper` and a `support` with a stiffness";
        Some(Diagnostic::new(Code::E0617, message).label(load.span, "on this load").help(help))
    };
    loads.iter().filter_map(refused).collect()
}
