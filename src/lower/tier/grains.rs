//! Tiers `cells`, `zone` and `full`: grains under the sleepers of a track, one cell for each distinct sleeper, under the bays that
//! differ, or under all of the window. This version plans them and cannot run them.

use super::{ExpectedError, Proposal, Tier, edges, waiting};
use crate::diag::{Diagnostic, Severity};
use crate::graph::{GrainsNode, Model, Node, PointLoad, Schedule, SoilLayer, SoilNode};
use crate::lower::bed::{self, BedUse, beds, beds_of_spheres};
use crate::lower::tier::rig::cost::grains_under_track;
use crate::lower::{Draft, track};
use crate::scenario::{Loading, Material, Scenario};
use crate::schema::Reads;

pub struct Cells;
pub struct Zone;
pub struct Full;

/// Fields of the grains and the soil under a track.
const READS: Reads = Reads {
    fields: &[
        "solve.window",
        "track.bed_ends",
        "soil.youngs_modulus",
        "soil.poisson_ratio",
        "soil.bulk_modulus",
        "soil.shear_modulus",
    ],
    acts_where: "where grains lie under a track: `substructure = cells`, `zone` or `full`",
};

/// What each of these tiers reads.
const ALL: &[&Reads] = &[&track::READS, &bed::READS, &bed::VOLUMES, &READS];

impl Tier for Cells {
    fn name(&self) -> &'static str {
        "cells"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        ALL
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let bays = draft.scenario.track.sections.iter().map(|section| *section.spacing).sum();
        propose(draft, "a cell of grains for each distinct sleeper", bays)
    }
}

impl Tier for Zone {
    fn name(&self) -> &'static str {
        "zone"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        ALL
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        propose(draft, "grains under the bays that differ", window_length(draft.scenario).min(ZONE))
    }
}

impl Tier for Full {
    fn name(&self) -> &'static str {
        "full"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        ALL
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        propose(draft, "grains under all of the window", window_length(draft.scenario))
    }
}

/// Length of track beside a transition that differs from the far field, m, until a pass chooses it.
const ZONE: f64 = 10.0;

fn propose(draft: &Draft<'_>, what: &str, length: f64) -> Result<Proposal, String> {
    let scenario = draft.scenario;
    if !scenario.track.has_rails() {
        return Err("there are no rails".into());
    }
    // the clumps of a scene that only might ask for grains are not worth their time
    let found = match scenario.solve.grains.tier.has_grains() {
        true => beds(scenario, BedUse::Track),
        false => beds_of_spheres(scenario, BedUse::Track),
    };
    let (beds, unpackable): (_, Vec<Diagnostic>) = match found {
        Ok(beds) if beds.is_empty() => return Err("no section has a layer of grains".into()),
        Ok(beds) => (beds, Vec::new()),
        // what cannot be packed stands against a run only, as E0604 does
        Err(refusals) => {
            (Vec::new(), refusals.into_iter().map(|refusal| refusal.severity(Severity::Warning)).collect())
        }
    };
    let schedule = match (&scenario.loading, &draft.blocks) {
        (Some(Loading::Traffic(_)), Some(blocks)) => Schedule::Blocks(Box::new(blocks.clone())),
        (Some(Loading::Static(_) | Loading::Rig(_)), _) => Schedule::Static { loads: Vec::<PointLoad>::new() },
        _ => return Err("nothing acts on the track".into()),
    };
    let soil = soil(scenario);
    let grains = GrainsNode { beds, window: window(scenario), on_soil: !soil.layers.is_empty() };
    let mut nodes = vec![
        Node::new("track", Model::Track(Box::new(track::track(scenario)))),
        Node::new("grains", Model::Grains(grains)),
    ];
    if !soil.layers.is_empty() {
        nodes.push(Node::new("soil", Model::Soil(soil)));
    }
    Ok(Proposal {
        edges: edges(&nodes),
        nodes,
        schedule,
        cost: grains_under_track(draft, length),
        what: what.into(),
        why: "the scene asks for grains, and this version plans them without running them".into(),
        error: ExpectedError { share: None, evidence: "its error is not measured yet".into() },
        runs: false,
        refusals: waiting::refusal(scenario).into_iter().chain(unpackable).collect(),
    })
}

/// Chainages between which grains are modelled: those of the scene, else all of it.
fn window(scenario: &Scenario) -> Vec<[f64; 2]> {
    let all = || vec![[scenario.track.start(), scenario.track.end()]];
    scenario.solve.grains.window.clone().unwrap_or_else(all)
}

fn window_length(scenario: &Scenario) -> f64 {
    window(scenario).iter().map(|[a, b]| b - a).sum()
}

/// The layers of soil below the grains of the first section that has some.
fn soil(scenario: &Scenario) -> SoilNode {
    let middle = |section: &crate::scenario::Section| 0.5 * (section.start + section.end);
    let layers = scenario.track.sections.iter().map(|section| {
        let of_soil = section.layers.iter().filter_map(|layer| match &layer.material {
            Material::Soil(soil) => Some(SoilLayer {
                name: layer.name.clone(),
                thickness: layer.thickness.value_at(middle(section)),
                youngs_modulus: soil.youngs_modulus.value_at(middle(section)),
                poisson_ratio: *soil.poisson_ratio,
            }),
            Material::Granular(_) => None,
        });
        of_soil.collect::<Vec<_>>()
    });
    SoilNode { layers: layers.into_iter().find(|layers| !layers.is_empty()).unwrap_or_default() }
}
