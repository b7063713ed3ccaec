//! Map of passages that fail: integrators, time steps, contacts and voids, most of them outside the range that a scene
//! may have.
//!
//! Every cell of the map is a passage of the first bogie over the transition. It is compared with a passage over the
//! same track, contact and void at a sixteenth of the scene's step. A cell is **wrong** if it differs much from this
//! passage, is unstable or holds a value that is not a number, and no diagnostic has warned of it. No cell may be
//! wrong.

use super::planned::Planned;
use super::stress::{Stress, stresses};
use super::variant::{Case, METHODS, Prepared, Variant};
use super::verdict::{Foreseen, Verdict, check, judge, refused};
use super::void::{Void, middle};
use crate::scenario::{Given, Integrator, Loading, Scenario, TimeStep};
use crate::solvers::track::Direction;
use crate::solvers::track::TrackError;
use serde::Serialize;

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

/// Maps a scene and tries it under stress. Fails if the scene itself cannot be prepared.
pub fn stability(
    scenario: &Scenario,
    planned: &Planned,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Stability, TrackError> {
    let trials = Void::ALL.len() * CONTACTS.len() * (METHODS.len() + 2) + 40;
    let mut done = 0;
    let mut tick = || {
        done += 1;
        progress(done.min(trials as u64), trials as u64);
    };
    let map = map(scenario, planned, &mut tick)?;
    let stresses = stresses(scenario, &mut tick);
    Ok(Stability { title: scenario.title.clone(), time_step: planned.blocks.passage.usual_step(), map, stresses })
}

fn map(scenario: &Scenario, planned: &Planned, tick: &mut dyn FnMut()) -> Result<Map, TrackError> {
    let own = Variant::planned(planned).even();
    let time_steps: Vec<f64> = STEPS.iter().map(|s| s * own.time_step).collect();
    let prepare = |variant| Prepared::new(&planned.node, &planned.responses, variant, own.time_step);
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
            let case = bogie(planned, middle(&scenario.track), contact, void.settlement(&scenario.track))
                .aligned(time_steps[0]);
            let reference = reference.run(&case);
            tick();
            for (i, (method, time_step, prepared)) in prepared.iter().enumerate() {
                let verdict = match (&warnings[i % STEPS.len()], prepared) {
                    (Foreseen::Refused(code, message), _) => Verdict::Refused { code, message: message.clone() },
                    (_, Err(cause)) => refused(cause, planned),
                    (foreseen, Ok(prepared)) => match (prepared.run(&case), &reference) {
                        (Err(failure), _) => refused(&failure.cause, planned),
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

/// The first bogie of the train over the transition at x (m).
fn bogie(planned: &Planned, x: f64, contact: f64, settlement: Vec<f64>) -> Case {
    let mut case = Case::planned(planned, settlement);
    let base = case.train.wheel_base();
    // the leading wheel runs at the right end of a train that goes right
    let (behind, ahead) =
        if case.direction == Direction::Backward { (APPROACH, base + APPROACH) } else { (base + APPROACH, APPROACH) };
    (case.left, case.right) = (case.left.max(x - behind), case.right.min(x + ahead));
    for (vehicle, _) in &mut case.train.vehicles {
        vehicle.hertz *= contact;
    }
    case
}

fn foreseen(scenario: &Scenario, time_step: f64, contact: f64) -> Foreseen {
    let mut scenario = scenario.clone();
    scenario.solve.time_step = TimeStep::Fixed(Given::derived(time_step));
    if let Some(Loading::Traffic(traffic)) = &mut scenario.loading {
        traffic.train.vehicles.iter_mut().for_each(|v| v.hertz.value *= contact);
    }
    check(&scenario).1
}
