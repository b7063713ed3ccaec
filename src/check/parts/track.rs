//! From the objects of a track to the track of the scenario: sections, seats and their supports.

use super::asked::Asked;
use super::bed::bed;
use super::ground::{Carrying, Under};
use super::groundwork::groundworks;
use super::layers::lay_layers;
use super::layout::Layout;
use super::seats::{lay_seats, usual_damping_time};
use super::stretch::{Instance, described, stand};
use super::trackform::Built;
use super::under_stretches::{Unchanged, auxiliary_spans, change_seats};
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::Record;
use crate::check::findings::Findings;
use crate::check::places::along::{Along, along, lay_profile};
use crate::check::places::chainage::Places;
use crate::check::places::cover::Cover;
use crate::check::places::spacing::{sleepers_apart, usual_spacing};
use crate::scenario::{
    AuxiliaryRailSpan, Curve, Given, Groundwork, Layer, Origin, Piece, Profile, RailEnds, Seat, Section, Track,
};

/// The parts of the sections of a track, in order.
#[derive(Default)]
struct Parts {
    sections: Vec<Section>,
    seats: Vec<Seat>,
    groundworks: Vec<Groundwork>,
    auxiliary_rails: Vec<AuxiliaryRailSpan>,
}

/// The track of a layout, from a complete record.
pub fn track(record: &Record, layout: &Layout, asked: Asked, eval: &mut Evaluator<'_>) -> Option<Track> {
    let places = &layout.places;
    let irregularity = irregularity(record, places, &mut eval.findings);
    let bed = bed(record, &layout.built, &mut eval.findings);
    let stood = stand(&layout.stretches, places, &mut eval.findings);
    let mut sound = layout.sound && stood.is_some();
    let stood = stood.unwrap_or_default();
    let carrying = Carrying { asked, damping_time: usual_damping_time(eval) };
    let mut parts = Parts::default();
    for section in 0..layout.built.len() {
        sound &= add_section(&mut parts, layout, section, &stood, carrying, eval);
    }
    if !sound {
        return None;
    }
    sleepers_apart(&parts.seats, &layout.forms, places, &mut eval.findings)?;
    let auxiliary_rails = auxiliary_spans(&layout.forms, &stood, places, parts.auxiliary_rails, eval)?;
    let rail_ends = match record.word("rail_ends") {
        Some("pinned") => RailEnds::Pinned,
        Some("free") => RailEnds::Free,
        Some("absorbing") => RailEnds::Absorbing,
        _ => RailEnds::Clamped,
    };
    Some(Track {
        name: record.name.clone(),
        sections: parts.sections,
        transitions: places.transitions.clone(),
        seats: parts.seats,
        auxiliary_rails,
        stretches: described(&stood),
        groundworks: parts.groundworks,
        rail_ends,
        irregularity: irregularity?,
        bed: bed?,
    })
}

/// Adds a section with its seats, changed by the stretches over it; returns whether all was understood.
fn add_section(
    parts: &mut Parts,
    layout: &Layout,
    section: usize,
    stood: &[Instance],
    carrying: Carrying,
    eval: &mut Evaluator<'_>,
) -> bool {
    let (places, built, form) = (&layout.places, &layout.built[section], &*layout.forms[section]);
    let mut sound = true;
    let layers = lay_layers(built, places, section, &mut eval.findings);
    let under = Under::Section(layers.as_deref());
    let mut laid = lay_seats(built, places, section, places.seats_of(section), under, carrying, &mut eval.findings);
    if let Some(laid) = &mut laid {
        let unchanged = Unchanged { form, section, layers: layers.as_deref() };
        sound &= change_seats(&unchanged, stood, places, laid, carrying, eval);
    }
    if let Some(before) = layers.as_deref().filter(|_| laid.is_some()) {
        let found = groundworks(form, stood, places, section, before, carrying.asked, eval);
        sound &= found.is_some();
        parts.groundworks.extend(found.unwrap_or_default());
    }
    let (start, end) = places.sections[section];
    let spacing = built.spacing.or_else(|| usual_spacing(form));
    let found = layers.and_then(|layers| whole_section(built, spacing, (start, end), layout.lengths[section], layers));
    sound &= laid.is_some() && found.is_some() && built.auxiliary_rails.is_some();
    parts.seats.extend(laid.unwrap_or_default());
    parts.sections.extend(found);
    let rails = built.auxiliary_rails.clone().flatten();
    parts.auxiliary_rails.extend(rails.map(|rails| AuxiliaryRailSpan { start, end, rails }));
    sound
}

/// The level of the rail as built; `None` if it is not understood.
fn irregularity(record: &Record, places: &Places, findings: &mut Findings) -> Option<Option<Profile>> {
    let (start, end) = (places.sections.first()?.0, places.sections.last()?.1);
    match along(record, "irregularity")? {
        Along::Fixed(level) if *level == 0.0 => Some(None),
        Along::Fixed(level) => {
            let curve = Curve::constant(*level);
            Some(Some(Profile { pieces: vec![Piece { start, end, curve }], origin: level.origin }))
        }
        Along::Varies(shape, origin) => {
            let what = format!("the irregularity of track `{}`", record.name);
            let cover = Cover { what, start, end, seats: None, smooth: true };
            lay_profile(&shape, origin, places, &cover, findings).map(Some)
        }
    }
}

/// The parts of a section that do not vary.
fn whole_section(
    built: &Built,
    spacing: Option<Given>,
    (start, end): (f64, f64),
    length_origin: Origin,
    layers: Vec<Layer>,
) -> Option<Section> {
    Some(Section {
        name: built.name.clone(),
        start,
        end,
        length_origin,
        rail: built.rail.clone()?,
        spacing: spacing?,
        slab: built.slab.clone(),
        layers,
        layers_span: Some(built.layers_span),
        crib: built.crib,
    })
}
