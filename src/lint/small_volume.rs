//! L1024: a volume in which ballast is averaged contains few grains, or none.
//!
//! Ratio of the smallest side of the volume to the median grain d50 of the layer at its depth. Below three the mean
//! depends on a few grains, and another packing has another mean.

use super::grains::{GrainLayer, beds, mm};
use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Model, Node};
use crate::scenario::{Scenario, Volume, VolumeRecord};
use crate::units::number;

/// Median grains across a volume.
const FEWEST: f64 = 3.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> =
        scenario.volumes.iter().filter_map(|record| without_grains(scenario, graph, record)).collect();
    for record in &scenario.volumes {
        let Some(bed) = at_depth(scenario, graph, record) else { continue };
        let (median, side) = (bed.granular.grading.d(50.0), least_side(record.volume));
        if side >= FEWEST * median {
            continue;
        }
        let diagnostic = Diagnostic::new(
            Code::L1024,
            format!(
                "a volume of {} mm is only {} median grains of `{}` wide, d50 = {} mm",
                mm(side),
                number((side / median * 10.0).round() / 10.0),
                bed.layer.name,
                mm(median)
            ),
        )
        .help(format!(
            "make it at least {} mm ({FEWEST} x d50) for a reliable mean; `repeats` gives its scatter",
            mm(FEWEST * median)
        ));
        found.push(match record.span {
            Some(span) => diagnostic.label(span, "too few grains"),
            None => diagnostic,
        });
    }
    found
}

/// Seats of a record under which a track has no grains.
fn without_grains(scenario: &Scenario, graph: &Graph, record: &VolumeRecord) -> Option<Diagnostic> {
    let grains =
        |node: &Node| if let Model::Grains(grains) = &node.model { Some(!grains.stretches.is_empty()) } else { None };
    graph.nodes.iter().find_map(grains).filter(|laid| *laid)?;
    let on_grains = |seat: &usize| graph.volumes().iter().any(|volume| volume.seat == *seat);
    let track = &scenario.track;
    let seats = record.seats.iter().filter(|seat| !on_grains(seat)).filter_map(|seat| track.seats.get(*seat));
    let names: Vec<String> = seats.map(|seat| track.seat_name(seat)).collect();
    if names.is_empty() {
        return None;
    }
    let message = format!("no grains lie under seat {}: its volume is not recorded", names.join(", "));
    let help = "record sleepers on grains, or extend `solve.window` to these sleepers";
    let diagnostic = Diagnostic::new(Code::L1024, message).help(help);
    Some(match record.span {
        Some(span) => diagnostic.label(span, "no grains in it"),
        None => diagnostic,
    })
}

/// m.
fn least_side(volume: Volume) -> f64 {
    match volume {
        Volume::Sphere { radius } => 2.0 * radius,
        Volume::Box { along, across, height } => across.unwrap_or(f64::INFINITY).min(along).min(height),
    }
}

/// The layer of grains in which a record lies, under its first ballasted seat.
fn at_depth<'a>(scenario: &'a Scenario, graph: &Graph, record: &VolumeRecord) -> Option<GrainLayer<'a>> {
    let sections = record.seats.iter().filter_map(|seat| scenario.track.seats.get(*seat)).map(|seat| seat.section);
    let section = sections.into_iter().find(|section| !scenario.track.sections[*section].layers.is_empty())?;
    let layers = &scenario.track.sections[section].layers;
    let depth = record.depth.unwrap_or_else(|| layers[0].thickness.largest() / 2.0);
    let mut bottom = 0.0;
    let layer = layers.iter().find(|layer| {
        bottom += layer.thickness.largest();
        depth <= bottom
    })?;
    beds(scenario, graph).into_iter().find(|bed| bed.index == section && std::ptr::eq(bed.layer, layer))
}
