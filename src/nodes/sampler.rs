//! Takes histories of a passage: every wheel force, what the scene records, and the force histories of sleepers if the
//! ground needs them.

use super::{Forces, Sample, SampledPart, SeatForces, WheelHistories};
use crate::graph::{History, Record};
use crate::solvers::track::{Observer, StepView};

pub(super) struct Sampler {
    /// Seats and quantities, each once, in the order of the scene, with the distance of a wheel within which they are
    /// kept.
    wanted: Vec<(usize, History, f64)>,
    every: usize,
    recorded: bool,
    pub samples: Vec<Sample>,
}

impl Sampler {
    /// Takes what `records` want at an axle count, every so many steps.
    pub fn new(records: &[Record], axles: u64, every: u64, recorded: bool) -> Self {
        let mut wanted = Vec::new();
        for record in records.iter().filter(|r| r.after.contains(&axles)) {
            for quantity in &record.quantities {
                for seat in &record.seats {
                    if !wanted.iter().any(|(s, q, _)| (s, q) == (seat, quantity)) {
                        wanted.push((*seat, *quantity, record.near.unwrap_or(f64::INFINITY)));
                    }
                }
            }
        }
        Sampler { wanted, every: every.max(1) as usize, recorded, samples: Vec::new() }
    }
}

impl Observer for Sampler {
    fn observe(&mut self, view: &StepView<'_>) {
        if !self.recorded || !view.is_on_grid(self.every) {
            return;
        }
        let time = view.time();
        let wheels = view.wheel_positions().iter().zip(view.wheel_forces()).enumerate();
        self.samples.extend(wheels.map(|(wheel, (x, value))| Sample {
            time,
            quantity: History::WheelForce,
            part: SampledPart::Wheel(wheel),
            x: *x,
            value: *value,
        }));
        for (seat, quantity, near) in &self.wanted {
            let x = view.track().model().seats[*seat].x;
            if view.wheel_positions().iter().all(|wheel| (wheel - x).abs() > *near) {
                continue;
            }
            if let Some(value) = at_seat(view, *seat, *quantity) {
                self.samples.push(Sample { time, quantity: *quantity, part: SampledPart::Seat(*seat), x, value });
            }
        }
    }
}

/// A quantity at a seat; `None` if it does not exist there.
fn at_seat(view: &StepView<'_>, seat: usize, quantity: History) -> Option<f64> {
    let node = view.track().seat_node(seat);
    Some(match quantity {
        History::RailSeatLoad => view.seat_load(seat),
        History::ContactForce => view.contact_force(seat)?,
        History::RailDisplacement => view.rail_deflection(node) - view.unloaded().rail_deflection[node],
        History::RailMoment => view.rail_moment(node),
        History::SleeperDisplacement => view.foot_displacement(seat) - view.unloaded().foot_displacements[seat],
        History::SleeperVelocity => view.foot_velocity(seat),
        History::SleeperAcceleration => view.foot_acceleration(seat),
        History::WheelForce => return None,
    })
}

/// Takes places and forces of all wheels at every longest step.
pub(super) struct WheelSampler(Option<WheelHistories>);

impl WheelSampler {
    /// Takes them where `forces` asks for wheels, at intervals of `step` (s), of a train so fast (m/s).
    pub fn new(forces: Forces, step: f64, speed: f64) -> WheelSampler {
        let histories = WheelHistories { interval: step, speed, wheels: 0, values: Vec::new() };
        WheelSampler((forces == Forces::Wheels).then_some(histories))
    }

    pub fn taken(self) -> Option<WheelHistories> {
        self.0
    }
}

impl Observer for WheelSampler {
    fn observe(&mut self, view: &StepView<'_>) {
        let Some(histories) = self.0.as_mut().filter(|_| view.is_on_grid(1)) else { return };
        histories.wheels = view.wheel_positions().len();
        histories.values.extend(view.wheel_positions().iter().copied().zip(view.wheel_forces().iter().copied()));
    }
}

/// Takes the forces of all sleepers at every longest step.
pub(super) struct ForceSampler(Option<SeatForces>);

impl ForceSampler {
    /// Takes them where `forces` asks for histories, at intervals of `step` (s).
    pub fn new(forces: Forces, seats: usize, step: f64) -> ForceSampler {
        ForceSampler(
            (forces == Forces::Histories).then(|| SeatForces { interval: step, seats: vec![Vec::new(); seats] }),
        )
    }

    pub fn taken(self) -> Option<SeatForces> {
        self.0
    }
}

impl Observer for ForceSampler {
    fn observe(&mut self, view: &StepView<'_>) {
        let Some(forces) = self.0.as_mut().filter(|_| view.is_on_grid(1)) else { return };
        for (seat, history) in forces.seats.iter_mut().enumerate() {
            history.extend(view.contact_force(seat));
        }
    }
}
