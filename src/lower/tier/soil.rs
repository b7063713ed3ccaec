//! The soil below the grains of a track: the layers of its section, and the layers that stretches and approach slabs
//! put in their place.

use crate::diag::{Code, Diagnostic};
use crate::graph::{SoilBlock, SoilLayer, SoilNode};
use crate::scenario::{self, ApproachSlab, Base, Groundwork, Layer, Material, Scenario};
use crate::solvers::continuum::Strength;
use crate::units::number;

/// Default size of the soil elements, m: two or three elements in the width of the base of a sleeper.
const ELEMENT: f64 = 0.1;
/// Poisson's ratio of the concrete of an approach slab.
const CONCRETE: f64 = 0.2;
/// Lengths that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// The soil of a scene. If a layer varies along the track, each element has the value at its middle.
pub(super) fn soil(scenario: &Scenario) -> SoilNode {
    let grains = &scenario.solve.grains;
    let element = grains.soil_element.map_or(ELEMENT, |size| *size);
    let parts: Vec<Groundwork> = parts(scenario);
    let all: Vec<SoilBlock> = parts.iter().flat_map(|part| blocks(part, element)).collect();
    let layers = all.first().map(|block| block.layers.clone()).unwrap_or_default();
    let mut blocks: Vec<SoilBlock> = Vec::new();
    for block in all.into_iter().filter(|block| block.layers != layers) {
        match blocks.last_mut() {
            Some(last) if last.layers == block.layers && (last.end - block.start).abs() < TINY => last.end = block.end,
            _ => blocks.push(block),
        }
    }
    SoilNode {
        layers,
        blocks,
        element,
        quiet_base: scenario.track.bed.base == Base::Quiet,
        gravity: *scenario.solve.gravity,
    }
}

/// Diagnostics for approach slabs inside layers of grains; `beds` are the ends (m) of the beds. A slab must lie in
/// soil.
pub(super) fn refusals(scenario: &Scenario, beds: &[[f64; 2]]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (number_of, section) in scenario.track.sections.iter().enumerate() {
        let grains = granular(&section.layers, 0.5 * (section.start + section.end));
        for part in scenario.track.ground(number_of) {
            let inside = beds.iter().any(|[left, right]| part.start < right - TINY && part.end > left + TINY);
            if !inside || grains.is_empty() {
                continue;
            }
            let thickness: f64 = grains.iter().map(|(_, thickness)| thickness).sum();
            if let Some(slab) = part.approach_slab.filter(|slab| *slab.depth < thickness - TINY) {
                let over = format!("from {} to {} m", number(part.start), number(part.end));
                let message = format!(
                    "{over} the approach slab lies {} m below the sleepers, inside the layers of grains, which are {} m thick",
                    number(*slab.depth),
                    number(thickness)
                );
                let help = format!("give the slab a `depth` of at least {} m", number(thickness));
                found.push(Diagnostic::new(Code::E0604, message).help(help));
            }
        }
    }
    found
}

/// Names and thicknesses (m) of the layers of grains at a chainage, m.
fn granular(layers: &[Layer], x: f64) -> Vec<(&str, f64)> {
    let of_grains = layers.iter().filter(|layer| layer.granular().is_some());
    of_grains.map(|layer| (layer.name.as_str(), (layer.thickness.value_at(x) / TINY).round() * TINY)).collect()
}

/// The ground along the track, from left to right; only sections with grains on soil.
fn parts(scenario: &Scenario) -> Vec<Groundwork> {
    let track = &scenario.track;
    let on_soil = |section: &usize| {
        let layers = &track.sections[*section].layers;
        layers.iter().any(|layer| layer.soil().is_some()) && layers.iter().any(|layer| layer.granular().is_some())
    };
    let mut sections: Vec<usize> = (0..track.sections.len()).filter(on_soil).collect();
    // if there are no grains, the plan still shows the soil
    if sections.is_empty() {
        sections = (0..track.sections.len()).collect();
    }
    let mut parts: Vec<Groundwork> = sections.into_iter().flat_map(|section| track.ground(section)).collect();
    parts.retain(|part| part.layers.iter().any(|layer| layer.soil().is_some()));
    parts
}

/// Divides a part into blocks of constant layers: one block, or one block for each element if a layer varies.
fn blocks(part: &Groundwork, element: f64) -> Vec<SoilBlock> {
    let [start, end] = [part.start, part.end];
    let count = ((end - start) / element).ceil().max(1.0) as usize;
    let line = |i: usize| start + (end - start) * i as f64 / count as f64;
    let pieces = (0..count).map(|i| [line(i), line(i + 1)]);
    let pieces = pieces.map(|[a, b]| SoilBlock { start: a, end: b, layers: layers(part, 0.5 * (a + b)) });
    let mut found: Vec<SoilBlock> = Vec::new();
    for piece in pieces {
        match found.last_mut() {
            Some(last) if last.layers == piece.layers => last.end = piece.end,
            _ => found.push(piece),
        }
    }
    found
}

/// The layers of soil at a chainage (m), downwards from the grains.
fn layers(part: &Groundwork, x: f64) -> Vec<SoilLayer> {
    let of_soil = part.layers.iter().filter_map(|layer| match &layer.material {
        Material::Soil(soil) => Some(SoilLayer {
            name: layer.name.clone(),
            thickness: layer.thickness.value_at(x),
            youngs_modulus: soil.youngs_modulus.value_at(x),
            poisson_ratio: *soil.poisson_ratio,
            density: *soil.density,
            strength: strength(&soil.strength),
        }),
        Material::Granular(_) => None,
    });
    let soil: Vec<SoilLayer> = of_soil.filter(|layer| layer.thickness > TINY).collect();
    let grains: f64 = granular(&part.layers, x).iter().map(|(_, thickness)| thickness).sum();
    match part
        .approach_slab
        .filter(|slab| (slab.ends[0].min(slab.ends[1])..slab.ends[0].max(slab.ends[1])).contains(&x))
    {
        Some(slab) => with_slab(&soil, &slab, *slab.depth - grains),
        None => soil,
    }
}

/// Layers with a slab in them; `top` is the depth of its top below the grains, m. The slab replaces the soil there.
fn with_slab(soil: &[SoilLayer], slab: &ApproachSlab, top: f64) -> Vec<SoilLayer> {
    let plate = SoilLayer {
        name: "approach slab".into(),
        thickness: *slab.thickness,
        youngs_modulus: *slab.youngs_modulus,
        poisson_ratio: CONCRETE,
        density: *slab.density,
        strength: None,
    };
    let [top, base] = [top.max(0.0), top.max(0.0) + *slab.thickness];
    let (mut above, mut below, mut level) = (Vec::new(), Vec::new(), 0.0);
    for layer in soil {
        let (from, to) = (level, level + layer.thickness);
        let part = |thickness: f64| SoilLayer { thickness, ..layer.clone() };
        above.extend((to.min(top) - from > TINY).then(|| part(to.min(top) - from)));
        below.extend((to - from.max(base) > TINY).then(|| part(to - from.max(base))));
        level = to;
    }
    [above, vec![plate], below].concat()
}

fn strength(strength: &scenario::Strength) -> Option<Strength> {
    match strength {
        scenario::Strength::Elastic => None,
        scenario::Strength::MohrCoulomb { cohesion, friction_angle, dilation, tension } => Some(Strength {
            cohesion: **cohesion,
            friction_angle: **friction_angle,
            dilation_angle: **dilation,
            tension: **tension,
        }),
    }
}
