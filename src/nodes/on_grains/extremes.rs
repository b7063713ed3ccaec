//! Extremes and recorded histories of a passage over the rail of the coupled model: the content of [`PassageOutcome`].

use crate::graph::{History, PassagePlan, Record, TrackNode, Train};
use crate::nodes::{PassageOutcome, Sample, SampledPart, SeatOutcome, Unloaded};
use crate::solvers::track::LeapfrogView;
use serde::{Deserialize, Serialize};

/// Reads a passage, step by step.
pub struct Extremes<'a> {
    track: &'a TrackNode,
    unloaded: &'a Unloaded,
    train: &'a Train,
    /// Chainages between which a wheel counts.
    passed: std::ops::Range<f64>,
    moments: Vec<f64>,
    wanted: Vec<(usize, History)>,
    /// Steps between two samples.
    every: u64,
    pub seen: Seen,
}

/// The extremes so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Seen {
    seats: Vec<SeatOutcome>,
    rail_moments: Vec<(f64, f64)>,
    rail_displacements: Vec<(f64, f64)>,
    /// Least and largest force of each wheel, N.
    wheels: Vec<(f64, f64)>,
    samples: Vec<Sample>,
    steps: u64,
}

const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

fn widen(range: &mut (f64, f64), value: f64) {
    *range = (range.0.min(value), range.1.max(value));
}

/// Records of a passage, and their interval.
pub struct Recorded<'a> {
    pub records: &'a [Record],
    pub axles: u64,
    /// Interval of histories, s.
    pub interval: f64,
}

impl<'a> Extremes<'a> {
    /// Nothing seen yet of a train over a track; with histories where something is recorded.
    pub fn new(
        track: &'a TrackNode,
        unloaded: &'a Unloaded,
        (train, plan): (&'a Train, &PassagePlan),
        recorded: Option<Recorded<'_>>,
        time_step: f64,
    ) -> Self {
        let mut wanted = Vec::new();
        for record in recorded.iter().flat_map(|r| r.records.iter().filter(|record| record.after.contains(&r.axles))) {
            wanted.extend(record.quantities.iter().flat_map(|quantity| record.seats.iter().map(|s| (*s, *quantity))));
        }
        wanted.dedup();
        let nodes = unloaded.rail.len();
        let interval = recorded.as_ref().map_or(f64::INFINITY, |recorded| recorded.interval);
        Extremes {
            moments: vec![0.0; nodes],
            seen: Seen {
                seats: vec![SeatOutcome::default(); track.seats.len()],
                rail_moments: vec![NOTHING; nodes],
                rail_displacements: vec![NOTHING; nodes],
                wheels: vec![NOTHING; train.axles() as usize],
                ..Seen::default()
            },
            passed: plan.passed(train),
            every: if interval.is_finite() { (interval / time_step).round().max(1.0) as u64 } else { u64::MAX },
            track,
            unloaded,
            train,
            wanted,
        }
    }

    /// Takes the state after a step of so long, s.
    pub fn see(&mut self, view: &LeapfrogView<'_>, time_step: f64, began: f64) {
        let seen = &mut self.seen;
        for (seat, outcome) in seen.seats.iter_mut().enumerate() {
            outcome.max_rail_seat_load = outcome.max_rail_seat_load.max(view.seat_load(seat));
            let lowered = view.foot_displacement(seat) - self.unloaded.seats[seat].sleeper_level;
            outcome.max_sleeper_displacement = outcome.max_sleeper_displacement.max(lowered);
            let Some(force) = view.contact_force(seat) else { continue };
            outcome.max_contact_force = outcome.max_contact_force.max(force);
            if force <= 0.0 {
                outcome.contact_loss += time_step;
            }
        }
        for (node, range) in seen.rail_displacements.iter_mut().enumerate() {
            widen(range, view.rail_deflection(node) - self.unloaded.rail[node].deflection);
        }
        view.rail_moments(&mut self.moments);
        seen.rail_moments.iter_mut().zip(&self.moments).for_each(|(range, moment)| widen(range, *moment));
        let wheels = view.wheel_positions().zip(view.wheel_forces());
        for ((x, force), range) in wheels.zip(&mut seen.wheels) {
            if self.passed.contains(&x) {
                widen(range, force);
            }
        }
        let due = seen.steps.is_multiple_of(self.every) && self.every < u64::MAX;
        seen.steps += 1;
        if due {
            self.sample(view, began);
        }
    }

    fn sample(&mut self, view: &LeapfrogView<'_>, began: f64) {
        let time = view.time() - began;
        let wheels = view.wheel_positions().zip(view.wheel_forces()).take(self.train.axles() as usize).enumerate();
        self.seen.samples.extend(wheels.map(|(wheel, (x, value))| Sample {
            time,
            quantity: History::WheelForce,
            part: SampledPart::Wheel(wheel),
            x,
            value,
        }));
        for (seat, quantity) in &self.wanted {
            let node = view.track().seat_node(*seat);
            let rest = &self.unloaded.seats[*seat];
            let value = match quantity {
                History::RailSeatLoad => Some(view.seat_load(*seat)),
                History::ContactForce => view.contact_force(*seat),
                History::RailDisplacement => Some(view.rail_deflection(node) - self.unloaded.rail[node].deflection),
                History::RailMoment => Some(self.moments[node]),
                History::SleeperDisplacement => Some(view.foot_displacement(*seat) - rest.sleeper_level),
                History::SleeperVelocity => Some(view.foot_velocity(*seat)),
                History::SleeperAcceleration => Some(view.foot_acceleration(*seat)),
                History::WheelForce => None,
            };
            let x = self.track.seats[*seat].x;
            let sample = |value| Sample { time, quantity: *quantity, part: SampledPart::Seat(*seat), x, value };
            self.seen.samples.extend(value.map(sample));
        }
    }

    /// The outcome of the passage.
    pub fn outcome(self) -> PassageOutcome {
        let (gravity, seen) = (self.track.gravity, self.seen);
        let over_the_way = |ranges: &[(f64, f64)]| {
            let places = ranges.iter().zip(&self.unloaded.rail).filter(|(_, point)| self.passed.contains(&point.x));
            places.map(|(range, _)| range.1).fold(0.0, f64::max)
        };
        let wheels =
            || seen.wheels.iter().zip(self.train.static_wheel_loads(gravity)).filter(|(range, _)| range.1 >= range.0);
        let shares = wheels().map(|(range, load)| (range.0 / load, range.1 / load));
        let shares = shares.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).filter(|_| gravity > 0.0);
        PassageOutcome {
            max_wheel_force: wheels().map(|(range, _)| range.1).fold(0.0, f64::max),
            min_wheel_force: wheels().map(|(range, _)| range.0).reduce(f64::min).unwrap_or(0.0),
            amplification: shares.map(|(_, most)| most),
            unloading: shares.map(|(least, _)| 1.0 - least),
            max_rail_moment: over_the_way(&seen.rail_moments),
            max_rail_displacement: over_the_way(&seen.rail_displacements),
            peaks: vec![Vec::new(); seen.seats.len()],
            seats: seen.seats,
            rail_moments: seen.rail_moments,
            rail_displacements: seen.rail_displacements,
            time_steps: seen.steps,
            newton_iterations: 0,
            samples: seen.samples,
            forces: None,
            wheels: None,
        }
    }
}
