//! Steps until a bed is at rest. All callers that wait for rest use this loop: a lift under its plate, a plate load
//! test, sleepers, a specimen, cells side by side.
//!
//! Forces are checked at regular intervals. A bed is at rest if several checks in a row find its forces in balance and
//! the applied force close to its target. A bed that is not at rest in time is an error of the caller.

use super::bed::Bed;
use super::failure::Failure;
use super::lanes::Real;
use super::measure::unbalance;
use super::snapshot::Snapshot;

/// When a bed counts as at rest, and the longest waiting time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Criterion {
    /// Limit of the force out of balance divided by the acting forces, mean over all bodies.
    pub unbalance: f64,
    /// Limit of the relative difference between the applied force and its target.
    pub missed: f64,
    /// Steps between two checks.
    pub every: u64,
    /// Number of checks in a row that must find rest.
    pub looks: usize,
    /// Time after which the bed counts as restless, s.
    pub longest: f64,
    /// Whether the first check comes before the first step; a bed at rest for which no time has passed needs no further
    /// check.
    pub look_first: bool,
}

/// The result of a check.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub snapshot: Snapshot,
    /// Force out of balance divided by the acting forces, mean over all bodies.
    pub unbalance: f64,
    /// Relative difference between the applied force and its target.
    pub missed: f64,
    /// Waiting time so far, s.
    pub time: f64,
}

/// Progress towards rest: the force out of balance decreases about as exp(-t).
#[derive(Debug, Clone, Copy, Default)]
pub struct Fading {
    /// Logarithm of the distance from rest at the first check.
    first: Option<f64>,
    /// The last reported share: it never decreases.
    told: f64,
}

impl Fading {
    /// Progress as a share of 1; `times` is the present unrest divided by the limit for rest.
    pub fn share(&mut self, times: f64) -> f64 {
        let far = times.ln().max(0.0);
        self.told = self.told.max(1.0 - (far / *self.first.get_or_insert(far.max(1.0))).min(1.0));
        self.told
    }
}

/// A bed that a caller waits for, with the load on it.
pub(super) trait Waiting<R: Real> {
    type Error;

    fn bed(&mut self) -> &mut Bed<R>;

    /// Does the steps up to the next check.
    fn advance(&mut self, steps: u64) -> Result<(), Failure>;

    /// Relative difference between the applied force and its target; 0 without an applied force.
    fn missed(&self) -> f64 {
        0.0
    }

    /// Receives every check, and may end the wait.
    fn hear(&mut self, _look: &Look) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Fails if waiting longer for a bed that is not at rest is useless.
    fn worth_waiting(&self, _look: &Look) -> Result<(), Self::Error> {
        Ok(())
    }

    /// The error of a bed that is not at rest in time; `look` is the last check.
    fn restless(&self, look: &Look) -> Self::Error;

    /// The error of a bed that cannot do its steps.
    fn failed(&self, failure: Failure) -> Self::Error;
}

/// Runs a bed until it is at rest, and returns the check that found rest. The wait counts from the time `since`, s.
pub(super) fn until_rest<R: Real, W: Waiting<R>>(
    waiting: &mut W,
    criterion: &Criterion,
    since: f64,
) -> Result<Look, W::Error> {
    let (mut calm, mut moves) = (0, !criterion.look_first);
    loop {
        if moves {
            waiting.advance(criterion.every).map_err(|failure| waiting.failed(failure))?;
        }
        let look = look_at(waiting, since)?;
        let rests = look.unbalance <= criterion.unbalance && look.missed <= criterion.missed;
        calm = if rests { calm + 1 } else { 0 };
        waiting.hear(&look)?;
        if calm >= criterion.looks || rests && look.time == 0.0 {
            return Ok(look);
        }
        waiting.worth_waiting(&look)?;
        if look.time > criterion.longest {
            return Err(waiting.restless(&look));
        }
        moves = true;
    }
}

fn look_at<R: Real, W: Waiting<R>>(waiting: &mut W, since: f64) -> Result<Look, W::Error> {
    let snapshot = waiting.bed().snapshot().map_err(|failure| waiting.failed(failure))?;
    let bed = waiting.bed();
    let (unbalance, time) = (unbalance(bed, &snapshot), bed.time() - since);
    Ok(Look { snapshot, unbalance, missed: waiting.missed(), time })
}

#[cfg(test)]
mod tests {
    use super::super::law::{ContactLaw, Dashpot, DashpotMode, FrictionLimit, Linear};
    use super::super::{ContactLaws, Domain, Gravity, Sphere};
    use super::*;

    const RADIUS: f64 = 0.03;

    /// A sphere over a floor, and a log of the calls.
    struct Fall {
        bed: Bed<f64>,
        steps: u64,
        looks: usize,
        /// Number of checks after which the wait ends.
        patience: usize,
    }

    impl Fall {
        /// Starts with this many times the overlap that carries the weight of the sphere; below 0 there is no contact.
        fn new(overlaps: f64) -> Fall {
            let (normal, density) = (1e6, 2700.0);
            let law = ContactLaw::Linear(Linear {
                normal_stiffness: normal,
                shear_stiffness: normal,
                friction: 0.5,
                dashpot: Dashpot::Ratio { normal: 0.5, shear: 0.5 },
                mode: DashpotMode::default(),
                limit: FrictionLimit::default(),
            });
            let mass = density * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
            let mut bed = Bed::new(Domain::open(), ContactLaws::single(law));
            bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
            let height = RADIUS - overlaps * mass * 9.81 / normal;
            bed.add_sphere(&Sphere { centre: [0.0, 0.0, height], radius: RADIUS, density, surface: 0 });
            bed.set_gravity(Gravity::Constant([0.0, 0.0, -9.81]));
            bed.set_time_step(1e-5);
            Fall { bed, steps: 0, looks: 0, patience: usize::MAX }
        }
    }

    impl Waiting<f64> for Fall {
        type Error = &'static str;

        fn bed(&mut self) -> &mut Bed<f64> {
            &mut self.bed
        }

        fn advance(&mut self, steps: u64) -> Result<(), Failure> {
            self.steps += steps;
            self.bed.run(steps)
        }

        fn hear(&mut self, _: &Look) -> Result<(), &'static str> {
            self.looks += 1;
            if self.looks < self.patience { Ok(()) } else { Err("stopped") }
        }

        fn restless(&self, _: &Look) -> &'static str {
            "restless"
        }

        fn failed(&self, _: Failure) -> &'static str {
            "failed"
        }
    }

    const CRITERION: Criterion =
        Criterion { unbalance: 1e-3, missed: 0.0, every: 100, looks: 3, longest: 0.5, look_first: false };

    #[test]
    fn rest_must_be_found_in_some_looks_in_a_row() {
        let mut resting = Fall::new(1.0);
        let look = until_rest(&mut resting, &CRITERION, 0.0).unwrap();
        assert_eq!((resting.steps, resting.looks), (300, 3));
        assert!(look.unbalance <= CRITERION.unbalance && (look.time - 300e-5).abs() < 1e-12);
        let mut bouncing = Fall::new(2.0);
        until_rest(&mut bouncing, &CRITERION, 0.0).unwrap();
        assert!(bouncing.looks > 3 && bouncing.steps == 100 * bouncing.looks as u64);
    }

    #[test]
    fn a_bed_that_lies_at_rest_needs_no_step_where_it_is_looked_at_first() {
        let first = Criterion { look_first: true, ..CRITERION };
        let mut resting = Fall::new(1.0);
        until_rest(&mut resting, &first, 0.0).unwrap();
        assert_eq!((resting.steps, resting.looks), (0, 1));
        // time that has passed before counts
        let mut later = Fall::new(1.0);
        until_rest(&mut later, &first, -0.1).unwrap();
        assert_eq!((later.steps, later.looks), (200, 3));
    }

    #[test]
    fn what_is_not_at_rest_in_time_is_restless() {
        let mut falling = Fall::new(-1e4);
        let soon = Criterion { longest: 0.0105, ..CRITERION };
        assert_eq!(until_rest(&mut falling, &soon, 0.0).unwrap_err(), "restless");
        let mut watched = Fall { patience: 2, ..Fall::new(-1.0) };
        assert_eq!(until_rest(&mut watched, &soon, 0.0).unwrap_err(), "stopped");
        assert_eq!(watched.looks, 2);
        assert_eq!(falling.steps, 1100);
    }
}
