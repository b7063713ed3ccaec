//! The track at rest under test loads, on supports of known stiffness.

use super::{ExpectedError, Proposal, Tier, edges};
use crate::graph::{LoadedPart, Model, Node, PointLoad, Schedule, SpringsNode};
use crate::lower::{Draft, cost, track};
use crate::scenario::{Loading, Scenario, Seat, StaticLoad, Target};
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
        let node = track::track(draft.scenario);
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
            error: ExpectedError { share: None, evidence: "as good as the stiffness of its supports".into() },
            runs: true,
            refusals: Vec::new(),
        })
    }
}

/// A load on sleepers acts on the nearest one.
fn point_loads(scenario: &Scenario, loads: &[StaticLoad]) -> Vec<PointLoad> {
    let seats = &scenario.track.seats;
    let distance = |seat: &Seat, x: f64| (seat.x - x).abs();
    let nearest = |x: f64| {
        (0..seats.len()).min_by(|&a, &b| distance(&seats[a], x).total_cmp(&distance(&seats[b], x))).unwrap_or(0)
    };
    // loads on the rail first: sums are taken in that order
    let part = |load: &StaticLoad| match load.on {
        Target::Rail => LoadedPart::Rail { x: load.x },
        Target::Sleepers | Target::Bed => LoadedPart::Sleeper { seat: nearest(load.x) },
    };
    loads.iter().map(|load| PointLoad { on: part(load), force: *load.force }).collect()
}
