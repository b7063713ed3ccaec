//! Takes histories of a passage: every wheel force, and what the scene records.

use super::track::{Sample, Target};
use crate::scenario::Record;
use crate::scenario::response::Response;
use crate::solvers::track::{Observer, StepView};

pub(super) struct Sampler {
    /// Seats and quantities, each once, in the order of the scene, with the distance of a wheel within which they are kept.
    wanted: Vec<(usize, Response, f64)>,
    every: usize,
    recorded: bool,
    pub samples: Vec<Sample>,
}

impl Sampler {
    /// Takes what `records` want at an axle count, every so many steps.
    pub fn new(records: &[Record], axles: u64, every: u64, recorded: bool) -> Self {
        let mut wanted = Vec::new();
        for record in records.iter().filter(|r| r.after.contains(&axles)) {
            for quantity in record.quantities.iter().filter(|q| varies_in_time(**q)) {
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

/// Quantities of seats that a passage changes; all others stand in the tables.
fn varies_in_time(quantity: Response) -> bool {
    matches!(
        quantity,
        Response::RailSeatLoad
            | Response::ContactForce
            | Response::RailDisplacement
            | Response::RailMoment
            | Response::SleeperDisplacement
            | Response::SleeperVelocity
            | Response::SleeperAcceleration
    )
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
            quantity: Response::WheelForce,
            target: Target::Wheel(wheel),
            x: *x,
            value: *value,
        }));
        for (seat, quantity, near) in &self.wanted {
            let x = view.track().model().seats[*seat].x;
            if view.wheel_positions().iter().all(|wheel| (wheel - x).abs() > *near) {
                continue;
            }
            if let Some(value) = at_seat(view, *seat, *quantity) {
                self.samples.push(Sample { time, quantity: *quantity, target: Target::Seat(*seat), x, value });
            }
        }
    }
}

/// A quantity at a seat; `None` where it does not exist there.
fn at_seat(view: &StepView<'_>, seat: usize, quantity: Response) -> Option<f64> {
    let node = view.track().seat_node(seat);
    Some(match quantity {
        Response::RailSeatLoad => view.seat_load(seat),
        Response::ContactForce => view.contact_force(seat)?,
        Response::RailDisplacement => view.rail_deflection(node) - view.unloaded().rail_deflection[node],
        Response::RailMoment => view.rail_moment(node),
        Response::SleeperDisplacement => view.foot_displacement(seat) - view.unloaded().foot_displacements[seat],
        Response::SleeperVelocity => view.foot_velocity(seat),
        Response::SleeperAcceleration => view.foot_acceleration(seat),
        _ => return None,
    })
}
