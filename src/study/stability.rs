//! Where a passage fails: integrators, time steps, contacts and voids, most of them beyond what a scene may state.
//!
//! Every cell of the map is a passage of the first bogie over the transition. It is compared with a passage over the same
//! track, contact and void at a sixteenth of the scene's step. A cell that is far from it, that has run away or holds what is
//! no number, and of which nothing has warned, is **wrong**: the one end that must not be.

use super::stress::{Stress, stresses};
use super::variant::{Case, METHODS, Measured, Prepared, Variant};
use crate::diag::Code;
use crate::graph::{Blocks, Graph, RUNAWAY, RunError, Schedule};
use crate::lint::lint;
use crate::lower::lower;
use crate::results::diagnose;
use crate::scenario::{Given, Integrator, Loading, Scenario, TimeStep, Track};
use crate::solvers::track::TrackError;
use crate::units::number;
use serde::Serialize;

/// How a trial ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "ends")]
pub enum Verdict {
    /// Within [`TOLERATED`] of the reference.
    Stable { error: f64 },
    /// Further away, and a diagnostic has said so before the run.
    Coarse { error: f64, code: &'static str },
    /// Ran away by its numerics, where the reference does not, and a run says so.
    Unstable { why: String, code: &'static str },
    /// Refused, before or during the run.
    Refused { code: &'static str, message: String },
    /// Neither right nor diagnosed.
    Wrong { why: String },
}

impl Verdict {
    pub fn name(&self) -> &'static str {
        match self {
            Verdict::Stable { .. } => "stable",
            Verdict::Coarse { .. } => "coarse",
            Verdict::Unstable { .. } => "unstable",
            Verdict::Refused { .. } => "refused",
            Verdict::Wrong { .. } => "wrong",
        }
    }

    pub fn is_wrong(&self) -> bool {
        matches!(self, Verdict::Wrong { .. })
    }

    pub fn error(&self) -> Option<f64> {
        match self {
            Verdict::Stable { error } | Verdict::Coarse { error, .. } => Some(*error),
            _ => None,
        }
    }

    pub fn code(&self) -> Option<&'static str> {
        match self {
            Verdict::Coarse { code, .. } | Verdict::Unstable { code, .. } | Verdict::Refused { code, .. } => Some(code),
            _ => None,
        }
    }

    /// In a line.
    pub fn told(&self) -> String {
        let percent = |error: &f64| number((error * 1e5).round() / 1e3);
        match self {
            Verdict::Stable { error } => format!("{} % off", percent(error)),
            Verdict::Coarse { error, code } => format!("{} % off, {code} warns", percent(error)),
            Verdict::Unstable { why, code } => format!("{code}: {why}"),
            Verdict::Refused { code, message } => format!("{code}: {message}"),
            Verdict::Wrong { why } => why.clone(),
        }
    }

    /// What else is to be said.
    pub fn why(&self) -> &str {
        match self {
            Verdict::Unstable { why, .. } | Verdict::Wrong { why } => why,
            Verdict::Refused { message, .. } => message,
            _ => "",
        }
    }
}

/// Largest error of a passage that still shows what happens: of the wheel force as a root mean square over the static one,
/// and of the peak seat loads over the largest of them.
pub const TOLERATED: f64 = 0.1;

/// A gap under sleepers of an unsettled track.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Void {
    /// m.
    pub depth: f64,
    /// Under so many sleepers nearest to the transition; where absent all supports lie lower, and the stiff side does not.
    pub sleepers: Option<usize>,
}

impl Void {
    const ALL: [Void; 7] = [
        Void { depth: 0.0, sleepers: Some(0) },
        Void { depth: 0.05e-3, sleepers: Some(1) },
        Void { depth: 1e-3, sleepers: Some(1) },
        Void { depth: 1e-3, sleepers: Some(3) },
        Void { depth: 20e-3, sleepers: Some(1) },
        Void { depth: 20e-3, sleepers: Some(3) },
        Void { depth: 20e-3, sleepers: None },
    ];

    /// The settlement of every seat that leaves this void, m.
    pub fn settlement(self, track: &Track) -> Vec<f64> {
        let middle = middle(track);
        let mut ballasted: Vec<usize> = (0..track.seats.len()).filter(|i| track.seats[*i].is_ballasted()).collect();
        let distance = |i: &usize| (track.seats[*i].x - middle).abs();
        ballasted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut settlement = vec![0.0; track.seats.len()];
        for seat in ballasted.into_iter().take(self.sleepers.unwrap_or(usize::MAX)) {
            settlement[seat] = self.depth;
        }
        settlement
    }
}

/// Where the first transition is, or the middle of a track that has none, m.
pub(super) fn middle(track: &Track) -> f64 {
    track.transitions.first().map_or((track.start() + track.end()) / 2.0, |t| t.x)
}

/// One passage of the map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cell {
    pub method: Integrator,
    /// s.
    pub time_step: f64,
    /// Times the Hertz constant of the scene.
    pub contact: f64,
    pub void: Void,
    pub verdict: Verdict,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Map {
    pub methods: Vec<Integrator>,
    /// s, the coarsest first.
    pub time_steps: Vec<f64>,
    pub contacts: Vec<f64>,
    pub voids: Vec<Void>,
    pub cells: Vec<Cell>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stability {
    pub title: String,
    /// The time step of the scene, s.
    pub time_step: f64,
    pub map: Map,
    pub stresses: Vec<Stress>,
}

impl Stability {
    /// Cells and scenes that are neither right nor diagnosed.
    pub fn wrong(&self) -> usize {
        let verdicts = self.map.cells.iter().map(|c| &c.verdict).chain(self.stresses.iter().map(|s| &s.verdict));
        verdicts.filter(|v| v.is_wrong()).count()
    }
}

const CONTACTS: [f64; 4] = [0.1, 1.0, 10.0, 100.0];
/// Time steps over that of the scene.
const STEPS: [f64; 4] = [16.0, 4.0, 1.0, 0.25];
const REFERENCE_STEP: f64 = 1.0 / 16.0;
/// Run of the leading wheel before and after the transition, m.
const APPROACH: f64 = 5.0;

/// Maps a scene and tries it under stress. Fails where the scene itself cannot be prepared.
pub fn stability(
    scenario: &Scenario,
    graph: &Graph,
    blocks: &Blocks,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Stability, TrackError> {
    let trials = Void::ALL.len() * CONTACTS.len() * (METHODS.len() + 2) + 40;
    let mut done = 0;
    let mut tick = || {
        done += 1;
        progress(done.min(trials as u64), trials as u64);
    };
    let map = map(scenario, graph, blocks, &mut tick)?;
    let stresses = stresses(scenario, &mut tick);
    Ok(Stability { title: scenario.title.clone(), time_step: blocks.passage.usual_step(), map, stresses })
}

fn map(scenario: &Scenario, graph: &Graph, blocks: &Blocks, tick: &mut dyn FnMut()) -> Result<Map, TrackError> {
    let own = Variant::of(graph, blocks).even();
    let time_steps: Vec<f64> = STEPS.iter().map(|s| s * own.time_step).collect();
    let prepare = |variant| Prepared::new(&graph.track, variant, own.time_step);
    let reference = prepare(Variant { time_step: REFERENCE_STEP * own.time_step, ..own })?;
    let mut prepared = Vec::new();
    for method in METHODS {
        for time_step in &time_steps {
            prepared.push((method, *time_step, prepare(Variant { method, time_step: *time_step, ..own })));
        }
    }
    let ballasted = scenario.track.seats.iter().any(|s| s.is_ballasted());
    let voids: Vec<Void> = Void::ALL.into_iter().filter(|v| v.depth == 0.0 || ballasted).collect();
    let mut cells = Vec::new();
    for contact in CONTACTS {
        let warnings: Vec<Foreseen> = time_steps.iter().map(|step| foreseen(scenario, *step, contact)).collect();
        for void in &voids {
            let case = bogie(graph, blocks, contact, void.settlement(&scenario.track)).aligned(time_steps[0]);
            let reference = reference.run(&case);
            tick();
            for (i, (method, time_step, prepared)) in prepared.iter().enumerate() {
                let verdict = match (&warnings[i % STEPS.len()], prepared) {
                    (Foreseen::Refused(code, message), _) => Verdict::Refused { code, message: message.clone() },
                    (_, Err(cause)) => refused(cause, scenario, graph),
                    (foreseen, Ok(prepared)) => match (prepared.run(&case), &reference) {
                        (Err(failure), _) => refused(&failure.cause, scenario, graph),
                        (Ok(_), Err(failure)) => {
                            Verdict::Wrong { why: format!("the reference fails: {}", failure.cause) }
                        }
                        (Ok(measured), Ok(reference)) => {
                            judge(&measured, reference, case.static_wheel_force(), foreseen.warning())
                        }
                    },
                };
                if i % STEPS.len() == 0 {
                    tick();
                }
                cells.push(Cell { method: *method, time_step: *time_step, contact, void: *void, verdict });
            }
        }
    }
    Ok(Map { methods: METHODS.to_vec(), time_steps, contacts: CONTACTS.to_vec(), voids, cells })
}

/// The first bogie of the train over the transition.
fn bogie(graph: &Graph, blocks: &Blocks, contact: f64, settlement: Vec<f64>) -> Case {
    let mut case = Case::of(graph, blocks, settlement);
    let (x, base) = (middle(&case.node.track), case.train.wheel_base());
    // the leading wheel runs at the right end of a train that goes right
    let (behind, ahead) = if case.direction == crate::scenario::Direction::Backward {
        (APPROACH, base + APPROACH)
    } else {
        (base + APPROACH, APPROACH)
    };
    (case.left, case.right) = (case.left.max(x - behind), case.right.min(x + ahead));
    for vehicle in &mut case.train.vehicles {
        vehicle.hertz.value *= contact;
    }
    case
}

/// What `check` says of a time step before anything runs.
pub(super) enum Foreseen {
    Fine,
    Warned(&'static str),
    Refused(&'static str, String),
}

impl Foreseen {
    pub fn warning(&self) -> Option<&'static str> {
        if let Foreseen::Warned(code) = self { Some(code) } else { None }
    }
}

fn foreseen(scenario: &Scenario, time_step: f64, contact: f64) -> Foreseen {
    let mut scenario = scenario.clone();
    scenario.solve.time_step = TimeStep::Fixed(Given::derived(time_step));
    if let Some(Loading::Traffic(traffic)) = &mut scenario.loading {
        traffic.train.vehicles.iter_mut().for_each(|v| v.hertz.value *= contact);
    }
    check(&scenario).1
}

/// Lowers a scene and says what its diagnostics foresee of its numerics, whatever rules it silences.
pub(super) fn check(scenario: &Scenario) -> (Option<Graph>, Foreseen, Vec<&'static str>) {
    let (graph, diagnostics) = lower(scenario);
    if let Some(error) = diagnostics.iter().find(|d| d.is_error()) {
        return (None, Foreseen::Refused(error.code.as_str(), error.message.clone()), Vec::new());
    }
    let Some(graph) = graph.filter(|g| matches!(g.schedule, Schedule::Blocks(_))) else {
        return (None, Foreseen::Refused(Code::E0601.as_str(), "nothing runs over the track".into()), Vec::new());
    };
    let aloud = Scenario { allow: Vec::new(), deny: Vec::new(), ..scenario.clone() };
    let mut warnings = lint(&aloud, &graph);
    warnings.dedup_by_key(|d| d.code);
    // of the step, and of a speed at which the track answers no longer as at rest
    let foreseen = match warnings.iter().find(|d| [Code::L1005, Code::L1002].contains(&d.code)) {
        Some(warning) => Foreseen::Warned(warning.code.as_str()),
        None => Foreseen::Fine,
    };
    (Some(graph), foreseen, warnings.iter().map(|d| d.code.as_str()).collect())
}

/// The diagnostic that a user would see.
pub(super) fn refused(cause: &TrackError, scenario: &Scenario, graph: &Graph) -> Verdict {
    let diagnostic = diagnose(&RunError::Track { axles: 0, cause: cause.clone() }, scenario, graph);
    Verdict::Refused { code: diagnostic.code.as_str(), message: diagnostic.message }
}

/// A passage against its reference. `warning` is the code that has spoken of its numerics before.
pub(super) fn judge(
    measured: &Measured,
    reference: &Measured,
    static_force: f64,
    warning: Option<&'static str>,
) -> Verdict {
    let errors = measured.errors(reference, static_force);
    let error = errors.wheel_force_rms.max(errors.seat_load);
    let code = Code::E0703.as_str();
    if measured.wheel_peak > RUNAWAY * static_force {
        let message = format!("a wheel force of {:.1} times the static one", measured.wheel_peak / static_force);
        // of the scene itself, or of its numerics
        return if reference.wheel_peak > 0.5 * RUNAWAY * static_force {
            Verdict::Refused { code, message }
        } else {
            Verdict::Unstable { why: message, code }
        };
    }
    match warning {
        _ if !error.is_finite() => Verdict::Wrong { why: "a force is not a number".into() },
        _ if error <= TOLERATED => Verdict::Stable { error },
        Some(code) => Verdict::Coarse { error, code },
        None => Verdict::Wrong { why: format!("{:.0} % from the reference", 100.0 * error) },
    }
}
