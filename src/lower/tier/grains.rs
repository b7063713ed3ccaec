//! Tiers `zone` and `full`: grains under the bays of a track that differ from the far field, or under the whole window.

use super::soil::{self, soil};
use super::volumes::{self, volumes};
use super::{Proposal, Tier, edges, refused, waiting};
use crate::diag::{Diagnostic, Severity};
use crate::graph::{
    BedPlan, Blocks, ExpectedError, GrainStretch, GrainsNode, Model, Node, Passing, PointLoad, Schedule,
    SleeperOnGrains, StiffnessFrom, Update,
};
use crate::lower::bays::{differing, wanted};
use crate::lower::bed::{self, BedUse, beds, beds_of_spheres};
use crate::lower::tier::rig::cost::grains_under_track;
use crate::lower::{Draft, crib, glue, track};
use crate::scenario::{Foot, Loading, Scenario, Seat, Section, SleeperBody, Track};
use crate::schema::Reads;
use crate::solvers::track::{Pitch, RailEnds, UnderPad};

pub struct Zone;
pub struct Full;

/// Fields of the grains and the soil under a track.
pub(super) const READS: Reads = Reads {
    fields: &[
        "soil.youngs_modulus",
        "soil.poisson_ratio",
        "soil.bulk_modulus",
        "soil.shear_modulus",
        "soil.density",
        "solve.coupling",
        "solve.passages",
        "solve.grain_step",
        "track.base",
        "usp.bedding_modulus",
        "approach_slab.density",
    ],
    acts_where: "where grains lie under a track: `substructure = cells`, `zone` or `full`",
};
/// Fields of bays that rail and soil connect.
const JOINED: Reads = Reads {
    fields: &[
        "solve.window",
        "track.bed_ends",
        "soil.strength",
        "solve.support_from",
        "solve.sleeper_pitch",
        "solve.soil_element",
    ],
    acts_where: "where grains lie under bays of a track: `substructure = zone` or `full`",
};

/// Fields that both tiers read.
const ALL: &[&Reads] = &[&track::READS, &bed::READS, &bed::VOLUMES, &READS, &JOINED];

/// Largest errors / settlement on packings of `transition_short.track` (docs/validation.md, "The shortened scene in
/// every tier"): by grains in some bays only, and by exchanges of forces and settlement after every train and after 20
/// axles.
const OF_ZONE: f64 = 0.21;
const OF_COUPLING: [f64; 2] = [0.01, 0.06];

impl Tier for Zone {
    fn name(&self) -> &'static str {
        "zone"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        ALL
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        // a scene that does not ask for this tier has no chosen bays, but its law may give them
        let seats = draft.scenario.track.seats.len();
        let windows = match draft.by_law.filter(|settlement| settlement.len() == seats) {
            _ if !draft.bays.is_empty() => draft.bays.clone(),
            Some(settlement) => differing(draft.scenario, settlement),
            None => wanted(draft.scenario),
        };
        let of_zone = ExpectedError {
            of_tier: Some(OF_ZONE + of_coupling(draft)),
            evidence: "with grains under six bays instead of ten, the far field of two packings of a dense bed differs by 1.6 \
                       and 6.1 um, at most 21 % of the largest settlement"
                .into(),
            ..ExpectedError::default()
        };
        propose(draft, "grains under the bays that differ from the far field", windows, of_zone)
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
        let of_full = ExpectedError {
            of_tier: Some(of_coupling(draft)),
            evidence: "against vehicles that run over the grains, exchanges after every train change the settlement of two packings \
                       by 1 %, after 20 axles by 1 to 6 %; another packing changes it by 10 to 20 %"
                .into(),
            ..ExpectedError::default()
        };
        propose(draft, "grains under the whole window", wanted(draft.scenario), of_full)
    }
}

/// Error by the exchange of forces and settlement in turn / settlement; vehicles that run over the grains have none.
fn of_coupling(draft: &Draft<'_>) -> f64 {
    let every_train = |blocks: &Blocks| blocks.wanted(0) == Some(1) || blocks.adaptive().is_some();
    match &draft.blocks {
        _ if draft.scenario.solve.grains.monolithic => 0.0,
        Some(blocks) if every_train(blocks) => OF_COUPLING[0],
        _ => OF_COUPLING[1],
    }
}

fn propose(draft: &Draft<'_>, what: &str, windows: Vec<[f64; 2]>, error: ExpectedError) -> Result<Proposal, String> {
    let scenario = draft.scenario;
    if !scenario.track.has_rails() {
        return Err("there are no rails".into());
    }
    // no clumps for a scene that does not ask for grains: they take time to make
    let found = match scenario.solve.grains.tier.has_grains() {
        true => beds(scenario, BedUse::Track),
        false => beds_of_spheres(scenario, BedUse::Track),
    };
    // grains take hours: only for scenes that ask for them by name
    let runs = scenario.solve.grains.tier.has_grains();
    let (beds, mut refusals): (_, Vec<Diagnostic>) = match found {
        Ok(beds) if beds.is_empty() => return Err("no section has a layer of grains".into()),
        Ok(beds) => (beds, Vec::new()),
        // a bed that cannot be packed is only a reason against the run, as with E0604
        Err(refusals) => {
            (Vec::new(), refusals.into_iter().map(|refusal| refusal.severity(Severity::Warning)).collect())
        }
    };
    let schedule = match (&scenario.loading, &draft.blocks) {
        (Some(Loading::Traffic(_)), Some(blocks)) => Schedule::Blocks(Box::new(train_by_train(blocks))),
        (Some(Loading::Static(_) | Loading::Rig(_)), _) => Schedule::Static { loads: Vec::<PointLoad>::new() },
        _ => return Err("nothing acts on the track".into()),
    };
    let soil = soil(scenario);
    let stretches = if beds.is_empty() { Vec::new() } else { stretches(scenario, &beds, &windows) };
    // a window also covers the structure, which has no grains
    let length: f64 = match stretches.is_empty() {
        true => windows.iter().map(|[a, b]| b - a).sum(),
        false => extents(&beds, &stretches).iter().map(|[a, b]| b - a).sum(),
    };
    let passing = Passing { length, headway: headway(scenario) };
    let blocks = if let Schedule::Blocks(blocks) = &schedule { Some(&**blocks) } else { None };
    let cost = grains_under_track(draft, blocks, passing);
    if runs {
        refusals.extend(refused::of_traffic(scenario));
        refusals.extend(refused::few_sleepers(&stretches));
        refusals.extend(refused::other_grains(scenario, &extents(&beds, &stretches)));
        refusals.extend(volumes::refusals(scenario));
        refusals.extend(soil::refusals(scenario, &extents(&beds, &stretches)));
    } else {
        refusals.extend(waiting::refusal(scenario));
    }
    let sampled = draft.passages.first().map_or(0.0, |plan| plan.sample_every as f64 * plan.time_step);
    let grains = GrainsNode {
        volumes: volumes(scenario, &beds, &stretches, sampled),
        beds,
        window: windows,
        stretches,
        on_soil: !soil.layers.is_empty(),
        ridden: scenario.solve.grains.monolithic,
        settlement: scenario.track.seats.iter().map(|seat| *seat.initial_settlement).collect(),
        pads: scenario.track.seats.iter().map(pad).collect(),
        stiffness_from: match scenario.solve.grains.support_from_passage {
            true => StiffnessFrom::Passage,
            false => StiffnessFrom::StaticLoad,
        },
        headway: passing.headway,
        damping_time: DAMPING_TIME,
        gravity: *scenario.solve.gravity,
        time_step: scenario.solve.grains.step.map(|step| *step),
        added_inertia: ADDED,
    };
    let ridden = scenario.solve.grains.monolithic;
    let mut track = Box::new(track::track(draft));
    if ridden && track.rail_ends == RailEnds::Clamped {
        // wheels that come over a clamped end drop from its level, and the load on the first ten seats oscillates by
        // three quarters
        track.rail_ends = RailEnds::Absorbing;
    }
    let mut nodes = vec![
        Node::new("track", if ridden { Model::Riding(track) } else { Model::Track(track) }),
        Node::new("grains", Model::Grains(grains)),
    ];
    if !soil.layers.is_empty() {
        nodes.push(Node::new("soil", Model::Soil(soil)));
    }
    Ok(Proposal {
        edges: edges(&nodes),
        nodes,
        schedule,
        cost,
        what: what.into(),
        why: "the scene asks for grains".into(),
        error,
        runs: runs && refusals.is_empty(),
        refusals,
    })
}

/// Blocks for grains. If the scene asks for adaptive blocks, forces and settlement are exchanged after every train.
pub(super) fn train_by_train(blocks: &Blocks) -> Blocks {
    let mut blocks = blocks.clone();
    if matches!(blocks.update, Update::Adaptive { .. }) {
        blocks.update = Update::Fixed { axles: blocks.train.axles() };
    }
    // one passage of the plane track gives the forces of all trains of a block, and no block is shortened
    blocks.cure = false;
    blocks
}

/// Inertia that is added to a bed at rest / its mass: contacts under wheels need slightly more, and the sum stays below
/// 10 %. Steps are a fifth longer than with 2 %, and the stiffness under a train changes by less than 1 % (map of the
/// bed, `trackbed stability`; `benches/grain_inertia.py`).
pub(super) const ADDED: f64 = 0.095;
/// Damping / stiffness of a support of grains, s (methods 2; Nielsen 2008).
pub(super) const DAMPING_TIME: f64 = 1e-3;
/// Length of a rail pad along the rail, m.
const PAD_LENGTH: f64 = 0.15;
/// Density of the rubber of an under sleeper pad, kg/m3; its lower half moves with the ballast.
const PAD_DENSITY: f64 = 1100.0;

/// Distance between the fronts of trains that follow each other, m; `None` if trains run one by one.
pub(super) fn headway(scenario: &Scenario) -> Option<f64> {
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return None };
    let lengths = traffic.train.vehicles.iter().map(|vehicle| vehicle.length.map(|length| *length));
    scenario.solve.grains.continuous.then(|| lengths.sum::<Option<f64>>()).flatten()
}

/// Cells in each window: as many as fit, and one more as a buffer at each end that is not an end of the section. Each
/// sleeper on them has half a bay before it.
fn stretches(scenario: &Scenario, beds: &[BedPlan], windows: &[[f64; 2]]) -> Vec<GrainStretch> {
    windows.iter().filter_map(|window| stretch(scenario, beds, *window, windows)).collect()
}

fn stretch(scenario: &Scenario, beds: &[BedPlan], window: [f64; 2], windows: &[[f64; 2]]) -> Option<GrainStretch> {
    let track = &scenario.track;
    let seats = || track.seats.iter().enumerate().filter(|(_, seat)| seat.is_ballasted() && seat.sleeper.is_some());
    let (_, first) = seats().find(|(_, seat)| (window[0]..=window[1]).contains(&seat.x))?;
    let section = &track.sections[first.section];
    let bed = beds.iter().position(|bed| bed.section == section.name).unwrap_or(0);
    let [cell, _] = beds[bed].numbers().plan;
    let read = whole_cells(track, section, window, cell);
    // the cells of neighbouring windows and their buffers stay apart
    let free = |x: f64| !windows.iter().any(|[a, b]| [*a, *b] != window && (a - cell..=b + cell).contains(&x));
    let before = read[0] - cell > section.start - TINY && free(read[0] - cell);
    let behind = read[1] + cell < section.end + TINY && free(read[1] + cell);
    let all = [read[0] - if before { cell } else { 0.0 }, read[1] + if behind { cell } else { 0.0 }];
    let fits = |seat: &Seat, [start, end]: [f64; 2]| {
        let half = 0.5 * *section.spacing;
        seat.x - half > start - TINY && seat.x + half.min(END) < end + TINY
    };
    let sleepers = seats().filter(|(_, seat)| fits(seat, all)).filter_map(|(number, seat)| {
        Some(SleeperOnGrains { buffer: !fits(seat, read), ..standing(scenario, number, seat, all[0])? })
    });
    let copies = ((all[1] - all[0]) / cell).round() as u32;
    let glued = glue::along(scenario, first.section, all);
    let sleepers = sleepers.collect();
    Some(GrainStretch { bed, start: all[0], copies, sleepers, crib: crib::planned(section), glued })
}

/// Chainages of the ends of the whole cells that fit in a window and a section, at least one cell. The cells begin at
/// the structure; the other end is adjusted.
fn whole_cells(track: &Track, section: &Section, [left, right]: [f64; 2], cell: f64) -> [f64; 2] {
    let [start, end] = [left.max(section.start), right.min(section.end)];
    let length = ((end - start) / cell + TINY).floor().max(1.0) * cell;
    let structure_at_left =
        track.sections.first().is_some_and(|first| first.start < section.start) && section.start >= left;
    if structure_at_left { [start, start + length] } else { [end - length, end] }
}

/// Chainages between which the grains of each stretch lie, m.
fn extents(beds: &[BedPlan], stretches: &[GrainStretch]) -> Vec<[f64; 2]> {
    let end = |stretch: &GrainStretch| stretch.start + f64::from(stretch.copies) * beds[stretch.bed].numbers().plan[0];
    stretches.iter().map(|stretch| [stretch.start, end(stretch)]).collect()
}

/// Lengths that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// Least distance between a sleeper and the end of the grains, m.
const END: f64 = 0.2;

/// A sleeper on grains; `start` is the chainage at which the grains begin, m.
pub(super) fn standing(scenario: &Scenario, number: usize, seat: &Seat, start: f64) -> Option<SleeperOnGrains> {
    let Foot::Sleeper { mass, .. } = &seat.foot else { return None };
    let SleeperBody { length, base_width, height, base_area, .. } = seat.sleeper?;
    let rail = scenario.track.sections[seat.section].rail.as_ref()?;
    Some(SleeperOnGrains {
        seat: number,
        place: [seat.x - start, 0.0],
        // the bearing area is as wide as the sleeper and at most as long
        size: [base_width, (base_area / base_width).min(length), height],
        mass: **mass,
        rail_mass: *rail.mass * scenario.track.bay(number),
        pad: pad(seat),
        pitch: seat.pad.as_ref().filter(|_| scenario.solve.grains.sleepers_pitch).map(|pad| Pitch {
            inertia: **mass * (base_width * base_width + height * height) / 12.0,
            stiffness: *pad.stiffness * PAD_LENGTH * PAD_LENGTH / 12.0,
        }),
        buffer: false,
    })
}

/// The pad under the sleeper of a seat.
fn pad(seat: &Seat) -> Option<UnderPad> {
    let Foot::Sleeper { usp: Some(usp), .. } = &seat.foot else { return None };
    let area = seat.sleeper?.base_area / 2.0;
    Some(UnderPad {
        mass: 0.5 * PAD_DENSITY * usp.thickness.max(THIN) * area,
        stiffness: *usp.stiffness,
        damping: *usp.damping,
    })
}

/// Least thickness of a pad for its mass, m.
const THIN: f64 = 0.007;
