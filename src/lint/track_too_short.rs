//! L1003: wheels come so near to the ends of the model that the ends take part in the answer.
//!
//! The static deflection decays as exp(-lambda x); three characteristic lengths leave 5 %.

use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Schedule};
use crate::scenario::{RailEnds, Scenario};
use crate::units::number;

const LENGTHS: f64 = 3.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Vec::new() };
    let track = &scenario.track;
    if track.rail_ends == RailEnds::Free {
        return Vec::new(); // asked for
    }
    let last = track.sections.len().saturating_sub(1);
    let ends = [(0, blocks.passage.left - track.start(), "left"), (last, track.end() - blocks.passage.right, "right")];
    ends.into_iter()
        .filter_map(|(section, distance, side)| {
            let needed = LENGTHS / Winkler::of(track, section)?.lambda();
            (distance < needed).then(|| {
                Diagnostic::new(
                    Code::L1003,
                    format!("wheels come within {} m of the {side} end of the track", number((distance * 10.0).round() / 10.0)),
                )
                .help(format!(
                    "lengthen section `{}`: {} m, three characteristic lengths of the rail, keep the end out of the answer",
                    track.sections[section].name,
                    number((needed * 10.0).ceil() / 10.0)
                ))
            })
        })
        .collect()
}
