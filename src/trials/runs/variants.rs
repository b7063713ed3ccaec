//! The ways of computing one scene: what applies to it, as edits of its lines.

use crate::check::Override;
use crate::graph::Update;
use crate::scenario::{Granular, Scenario, Shape, Tier, TimeStep};
use serde::Serialize;

/// Size of larger grains / size of the grains of the scene.
const LARGER: f64 = 1.25;

/// What a variant changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// The finest run.
    Reference,
    /// The scene with its own settings.
    Scene,
    Tier,
    /// How and how often track and ground exchange forces and settlement.
    Exchange,
    /// How trains follow each other.
    Passages,
    /// Bays of grains: in the window or in a cell.
    Bays,
    Soil,
    /// Step, dashpots, size and shape of the grains.
    Grains,
    /// Trains that cells leave out.
    Jumps,
    /// Mesh of the rail and time step of a passage.
    Passage,
    /// Another packing of the same bed.
    Packing,
}

impl Group {
    pub const ALL: [Group; 11] = [
        Group::Reference,
        Group::Scene,
        Group::Tier,
        Group::Exchange,
        Group::Passages,
        Group::Bays,
        Group::Soil,
        Group::Grains,
        Group::Jumps,
        Group::Passage,
        Group::Packing,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Group::Reference => "reference",
            Group::Scene => "scene",
            Group::Tier => "tier",
            Group::Exchange => "exchange",
            Group::Passages => "passages",
            Group::Bays => "bays",
            Group::Soil => "soil",
            Group::Grains => "grains",
            Group::Jumps => "jumps",
            Group::Passage => "passage",
            Group::Packing => "packing",
        }
    }
}

/// A way of computing the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunVariant {
    /// Also the name of its directory.
    pub name: String,
    pub group: Group,
    /// Lines of the scene that it edits.
    pub edits: Vec<Override>,
}

impl RunVariant {
    fn new(group: Group, name: &str, edits: &[(&str, &str)]) -> RunVariant {
        let edits = edits.iter().map(|(path, value)| edit(path, value)).collect();
        RunVariant { name: name.to_owned(), group, edits }
    }

    /// Whether it names no tier with grains in a part of the window only.
    pub fn is_whole(&self) -> bool {
        self.edits.iter().all(|edit| edit.path != "solve.substructure" || edit.value == "full")
    }
}

/// Candidates for the reference, the finest first.
pub fn reference(scenario: &Scenario) -> Vec<RunVariant> {
    let of = |name: &str, edits: &[(&str, &str)]| RunVariant::new(Group::Reference, name, edits);
    if !is_on_grains(scenario) {
        let step = finer_step(scenario);
        let step = step.iter().map(|step| ("solve.time_step", step.as_str()));
        let elements = (2 * *scenario.solve.elements_per_bay).clamp(8, 32).to_string();
        let fine = [("solve.update_every", "adaptive(0.0003 mm)"), ("solve.elements_per_bay", elements.as_str())];
        let finer = [("solve.update_every", "adaptive(0.001 mm)")];
        return vec![
            of("fine", &fine.into_iter().chain(step.clone()).collect::<Vec<_>>()),
            of("finer", &finer.into_iter().chain(step).collect::<Vec<_>>()),
        ];
    }
    let full = ("solve.substructure", "full");
    vec![
        of("full_monolithic", &[full, ("solve.coupling", "monolithic")]),
        of("full_every_4", &[full, ("solve.coupling", "iterated"), ("solve.update_every", "4 axles")]),
        of("full", &[full]),
        of("zone", &[("solve.substructure", "zone")]),
        of("cells_of_3", &[("solve.substructure", "cells"), ("solve.cell_bays", "3")]),
    ]
}

/// Everything that applies to a scene, the scene itself first. `packings` counts the packings of the scene's own
/// settings, its own among them.
pub fn variants(scenario: &Scenario, packings: u64) -> Vec<RunVariant> {
    let mut all = vec![RunVariant::new(Group::Scene, "scene", &[])];
    all.extend(if is_on_grains(scenario) { on_grains(scenario, packings) } else { by_law(scenario) });
    all
}

fn on_grains(scenario: &Scenario, packings: u64) -> Vec<RunVariant> {
    let tier = |name: &str| RunVariant::new(Group::Tier, name, &[("solve.substructure", name)]);
    let exchange = |name: &str, update: &str| RunVariant::new(Group::Exchange, name, &[("solve.update_every", update)]);
    let cells = |bays: &str| {
        let edits = [("solve.substructure", "cells"), ("solve.cell_bays", bays)];
        RunVariant::new(Group::Bays, &format!("cells_of_{bays}"), &edits)
    };
    let grains = &scenario.solve.grains;
    let (follow, passages) = if *grains.continuous { ("alone", "isolated") } else { ("train", "continuous") };
    let support = if grains.support_from_passage { "static_load" } else { "passage" };
    let mut all = ["law", "cells", "zone", "full"].map(tier).to_vec();
    all.extend([
        exchange("every_4", "4 axles"),
        exchange("every_20", "20 axles"),
        exchange("adaptive", "adaptive(0.05 mm)"),
        RunVariant::new(Group::Exchange, "monolithic", &[("solve.coupling", "monolithic")]),
        RunVariant::new(Group::Exchange, &format!("support_from_{support}"), &[("solve.support_from", support)]),
        RunVariant::new(Group::Passages, follow, &[("solve.passages", passages)]),
        cells("2"),
        cells("3"),
        RunVariant::new(Group::Soil, "soil_200_mm", &[("solve.soil_element", "200 mm")]),
    ]);
    all.extend(["10 us", "30 us"].map(|step| {
        let name = format!("grain_step_{}", step.replace(' ', "_"));
        RunVariant::new(Group::Grains, &name, &[("solve.grain_step", step)])
    }));
    all.extend(of_materials(scenario));
    all.extend(["1 %", "20 %"].map(|tolerance| {
        let name = format!("cells_at_{}_percent", tolerance.trim_end_matches(" %"));
        RunVariant::new(Group::Jumps, &name, &[("solve.substructure", "cells"), ("solve.tolerance", tolerance)])
    }));
    let seed = scenario.solve.seed;
    all.extend((1..packings).map(|more| {
        let seed = (seed + more).to_string();
        RunVariant::new(Group::Packing, &format!("packing_{seed}"), &[("solve.seed", seed.as_str())])
    }));
    all
}

/// Dashpots, size and shape of the grains that the file of the scene declares.
fn of_materials(scenario: &Scenario) -> Vec<RunVariant> {
    let layers = scenario.track.sections.iter().flat_map(|section| &section.layers);
    let mut grains: Vec<(&str, &Granular)> =
        layers.filter_map(|layer| Some((layer.name.as_str(), layer.granular()?))).collect();
    // entries of the library have a point in their name, and belong to other scenes too
    grains.retain(|(name, _)| !name.contains('.'));
    grains.sort_by_key(|(name, _)| *name);
    grains.dedup_by_key(|(name, _)| *name);
    if grains.is_empty() {
        return Vec::new();
    }
    let each = |name: &str, field: &str, value: &dyn Fn(&Granular) -> String| {
        let of = |(material, grains): &(&str, &Granular)| edit(&format!("{material}.{field}"), &value(grains));
        RunVariant { name: name.to_owned(), group: Group::Grains, edits: grains.iter().map(of).collect() }
    };
    let other_shape = |grains: &Granular| match grains.shape {
        Shape::Spheres => "clumps(2 .. 3)".to_owned(),
        Shape::Clumps { .. } => "spheres".to_owned(),
    };
    vec![
        each("half_the_dashpots", "viscous_damping", &|grains| (0.5 * *grains.viscous_damping).to_string()),
        each("dashpots_in_shear", "shear_damping", &|grains| grains.viscous_damping.to_string()),
        each("larger_grains", "scale", &|grains| (LARGER * *grains.scale).to_string()),
        each("other_shape", "shape", &other_shape),
    ]
}

fn by_law(scenario: &Scenario) -> Vec<RunVariant> {
    let exchange = |name: &str, update: &str| RunVariant::new(Group::Exchange, name, &[("solve.update_every", update)]);
    let elements = |count: u32| {
        let text = count.to_string();
        RunVariant::new(Group::Passage, &format!("elements_{text}"), &[("solve.elements_per_bay", text.as_str())])
    };
    let step = |name: &str, value: &str| RunVariant::new(Group::Passage, name, &[("solve.time_step", value)]);
    let mut all = vec![
        exchange("adaptive_0.001_mm", "adaptive(0.001 mm)"),
        exchange("adaptive_0.01_mm", "adaptive(0.01 mm)"),
        exchange("adaptive_0.03_mm", "adaptive(0.03 mm)"),
        exchange("adaptive_0.1_mm", "adaptive(0.1 mm)"),
        exchange("adaptive_0.3_mm", "adaptive(0.3 mm)"),
    ];
    if let Update::Adaptive { .. } = scenario.solve.update {
        all.push(exchange("geometric_0.5", "geometric(20 axles, ratio = 0.5)"));
        all.push(exchange("geometric_2", "geometric(20 axles, ratio = 2)"));
    }
    all.extend([1, 2, 8].map(elements));
    all.extend([
        step("step_0.05_ms", "0.05 ms"),
        step("step_0.2_ms", "0.2 ms"),
        step("step_0.5_ms", "0.5 ms"),
        step("step_adaptive", "adaptive(1e-4)"),
    ]);
    all
}

/// Half of the time step that the scene states, or a half of the usual one.
fn finer_step(scenario: &Scenario) -> Option<String> {
    match scenario.solve.time_step {
        TimeStep::Fixed(step) => Some(format!("{} s", 0.5 * *step)),
        TimeStep::Auto => Some("0.05 ms".to_owned()),
        TimeStep::Adaptive { .. } => None,
    }
}

pub(super) fn edit(path: &str, value: &str) -> Override {
    Override { path: path.to_owned(), value: value.to_owned() }
}

/// Whether the scene asks for grains.
pub(super) fn is_on_grains(scenario: &Scenario) -> bool {
    matches!(*scenario.solve.grains.tier, Tier::Cells | Tier::Zone | Tier::Full)
}
