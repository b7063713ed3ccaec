//! The passage against a plain implementation: one dense system for track and vehicle, factored in every iteration of a
//! full Newton method, without influence columns, phases or contact compliances.
//!
//! Its support law replaces the jump at contact by a ramp 1e-12 m wide.

use super::scenes::*;
use crate::solvers::track::*;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

const RAMP: f64 = 1e-12;

struct Plain<'a> {
    track: &'a Track,
    level: &'a TrackLevel,
    scheme: Scheme,
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    weight: DVector<f64>,
    contacts: Vec<WheelContact>,
    unknowns: Vec<Option<usize>>,
    /// Indentation of the rail by each wheel, at the ends of the last two steps.
    indentations: Vec<[f64; 2]>,
    u: DVector<f64>,
    v: DVector<f64>,
    a: DVector<f64>,
    positions: Vec<f64>,
    wheel_forces: Vec<f64>,
    support_forces: Vec<f64>,
}

impl<'a> Plain<'a> {
    fn new(passage: &Passage<'a>, vehicle: &Multibody) -> Self {
        let (track, level) = (&*passage.stepper.track, passage.level);
        let (n, order) = (track.order(), track.order() + vehicle.order());
        let m_v = DMatrix::from_diagonal(&DVector::from_column_slice(&vehicle.masses));
        let joined = |of_track: &crate::linalg::banded::SymmetricBanded, of_vehicle: &DMatrix<f64>| {
            DMatrix::from_fn(order, order, |i, j| match (i < n, j < n) {
                (true, true) => of_track.get(i, j),
                (false, false) => of_vehicle[(i - n, j - n)],
                _ => 0.0,
            })
        };
        let (mut stiffness, mut damping) =
            (joined(&track.stiffness, &vehicle.stiffness), joined(&track.damping, &vehicle.damping));
        for sleeper in &track.sleepers {
            stiffness[(sleeper.unknown, sleeper.unknown)] -= sleeper.support_stiffness;
            damping[(sleeper.unknown, sleeper.unknown)] -= sleeper.support_damping;
        }
        let w_v = vehicle.weight(track.model.gravity);
        let join = |of_track: &[f64], of_vehicle: &[f64]| {
            DVector::from_iterator(order, of_track.iter().copied().chain(of_vehicle.iter().copied()))
        };
        let running = &passage.vehicles[0].0;
        Self {
            track,
            level,
            scheme: passage.stepper.scheme,
            mass: joined(&track.mass, &m_v),
            damping,
            stiffness,
            weight: join(&track.weight, &w_v),
            contacts: vehicle.wheels.iter().map(|w| w.contact).collect(),
            unknowns: vehicle.wheels.iter().map(|w| w.unknown).collect(),
            indentations: passage.interface.indentations.iter().map(|d| [*d; 2]).collect(),
            u: join(&passage.displacement, &running.displacement),
            v: join(&passage.velocity, &running.velocity),
            a: join(&passage.acceleration, &running.acceleration),
            positions: passage.wheel_positions.clone(),
            wheel_forces: passage.interface.forces.clone(),
            support_forces: passage.support_forces.clone(),
        }
    }

    /// Effect of a unit force of each wheel on all unknowns, with the compliance and the unevenness of the rail there.
    fn directions(&self, positions: &[f64]) -> Vec<(DVector<f64>, f64, f64)> {
        let n = self.track.order();
        let direction = |(w, x): (usize, &f64)| {
            let point = self.track.rail_point(*x).unwrap();
            let mut direction = DVector::zeros(self.u.len());
            self.track.add_force(&point, -1.0, direction.as_mut_slice());
            if let Some(unknown) = self.unknowns[w] {
                direction[n + unknown] = 1.0;
            }
            (direction, point.local_compliance, self.track.model.irregularity.depth_at(*x))
        };
        positions.iter().enumerate().map(direction).collect()
    }

    /// Force and its derivative for a wheel that approaches the rail nodes by `approach`.
    fn wheel(&self, w: usize, approach: f64, local: f64) -> (f64, f64) {
        match self.contacts[w] {
            WheelContact::Given(force) => (force, 0.0),
            WheelContact::Linear { stiffness, damping } => {
                let [before, last] = self.indentations[w];
                let slope = stiffness + 1.5 * damping / self.scheme.time_step;
                let offset = damping * (before - 4.0 * last) / (2.0 * self.scheme.time_step);
                ((slope * approach + offset) / (1.0 + local * slope), slope / (1.0 + local * slope))
            }
            WheelContact::Hertz(_) if approach <= 0.0 => (0.0, 0.0),
            WheelContact::Hertz(constant) => {
                let mut d = approach; // Hertz part
                for _ in 0..60 {
                    let (f, slope) = (constant * d.powf(1.5), 1.5 * constant * d.sqrt());
                    d -= (d + local * f - approach) / (1.0 + local * slope);
                }
                let slope = 1.5 * constant * d.sqrt();
                (constant * d.powf(1.5), slope / (1.0 + local * slope))
            }
        }
    }

    /// Force of a support and its derivative by displacement and by velocity.
    fn support(&self, s: usize, u: f64, v: f64, rate: f64) -> (f64, f64) {
        let sleeper = &self.track.sleepers[s];
        let (k, c) = (sleeper.support_stiffness, sleeper.support_damping);
        let gap = u - self.level.settlements[sleeper.seat];
        let (spring, k) = match sleeper.seating {
            Some(s) if gap < s.closure => (s.stiffness * gap, s.stiffness),
            Some(s) => (s.stiffness * s.closure + k * (gap - s.closure), k),
            None => (k * gap, k),
        };
        let passing = v - rate * gap; // speed at which the gap closes within this step
        if passing <= 0.0 {
            let force = spring + c * v;
            if force > 0.0 { (force, k + rate * c) } else { (0.0, 0.0) }
        } else if gap <= 0.0 {
            (0.0, 0.0)
        } else if gap < RAMP {
            (c * passing * gap / RAMP, c * passing / RAMP)
        } else {
            (spring + c * v, k + rate * c)
        }
    }

    fn step(&mut self, positions: &[f64]) {
        let scheme = self.scheme;
        let (dt, alpha_m, alpha_f) = (scheme.time_step, scheme.alpha_m, scheme.alpha_f);
        let (share, velocity_share, rate) = (scheme.displacement_share(), scheme.velocity_share(), scheme.rate());
        let (old, new) = (self.directions(&self.positions), self.directions(positions));
        let u_star = &self.u + dt * &self.v + (0.5 - scheme.beta) * dt * dt * &self.a;
        let v_star = &self.v + (1.0 - scheme.gamma) * dt * &self.a;
        let mut old_forces = &self.stiffness * &self.u + &self.damping * &self.v;
        for ((direction, ..), force) in old.iter().zip(&self.wheel_forces) {
            old_forces += *force * direction;
        }
        for (sleeper, force) in self.track.sleepers.iter().zip(&self.support_forces) {
            old_forces[sleeper.unknown] += force;
        }
        let mut a = self.a.clone();
        let residual = |a: &DVector<f64>, mut jacobian: Option<&mut DMatrix<f64>>| {
            let (u, v) = (&u_star + share * a, &v_star + velocity_share * a);
            let mut forces = &self.stiffness * &u + &self.damping * &v;
            if let Some(jacobian) = &mut jacobian {
                **jacobian = &self.stiffness * share + &self.damping * velocity_share;
            }
            let mut wheel_forces = Vec::new();
            for (w, (direction, local, uneven)) in new.iter().enumerate() {
                let (force, slope) = self.wheel(w, direction.dot(&u) - uneven, *local);
                forces += force * direction;
                wheel_forces.push(force);
                if let Some(jacobian) = &mut jacobian {
                    **jacobian += share * slope * direction * direction.transpose();
                }
            }
            let mut support_forces = Vec::new();
            for (s, sleeper) in self.track.sleepers.iter().enumerate() {
                let i = sleeper.unknown;
                let (force, slope) = self.support(s, u[i], v[i], rate);
                forces[i] += force;
                support_forces.push(force);
                if let Some(jacobian) = &mut jacobian {
                    jacobian[(i, i)] += share * slope;
                }
            }
            let mut r = &self.mass * ((1.0 - alpha_m) * a + alpha_m * &self.a)
                + (1.0 - alpha_f) * forces
                + alpha_f * &old_forces
                - &self.weight;
            if let Some(jacobian) = &mut jacobian {
                **jacobian *= 1.0 - alpha_f;
                **jacobian += &self.mass * (1.0 - alpha_m);
            }
            for (unknown, _) in &self.track.held {
                r[*unknown] = 0.0;
                if let Some(jacobian) = &mut jacobian {
                    jacobian.fill_row(*unknown, 0.0);
                    jacobian[(*unknown, *unknown)] = 1.0;
                }
            }
            (r, wheel_forces, support_forces)
        };
        for iteration in 0.. {
            let mut jacobian = DMatrix::zeros(a.len(), a.len());
            let (r, wheel_forces, support_forces) = residual(&a, Some(&mut jacobian));
            let size = r.amax();
            // On the ramp the rounding of a displacement alone makes some tenths of a newton.
            let on_ramp = self.track.sleepers.iter().any(|sleeper| {
                let u = u_star[sleeper.unknown] + share * a[sleeper.unknown];
                (0.0..RAMP).contains(&(u - self.level.settlements[sleeper.seat]))
            });
            if size < if on_ramp { 0.5 } else { 1e-6 } {
                (self.wheel_forces, self.support_forces) = (wheel_forces, support_forces);
                break;
            }
            assert!(iteration < 200, "the plain Newton method fails, residual {size} N");
            let step = jacobian.lu().solve(&r).unwrap();
            // The residual is the gradient of a convex function: go to the point at which it stops falling along the
            // step.
            let fall = |factor: f64| step.dot(&residual(&(&a - factor * &step), None).0);
            let (mut low, mut factor) = (0.0, 1.0);
            if fall(1.0) < -0.1 * step.dot(&r) {
                let mut high = 1.0;
                for _ in 0..50 {
                    factor = 0.5 * (low + high);
                    if fall(factor) > 0.0 { low = factor } else { high = factor }
                }
            }
            a -= factor * step;
        }
        self.u = u_star + share * &a;
        for (w, (direction, local, uneven)) in new.iter().enumerate() {
            let indentation = direction.dot(&self.u) - uneven - local * self.wheel_forces[w];
            self.indentations[w] = [self.indentations[w][1], indentation];
        }
        self.v = v_star + velocity_share * &a;
        self.a = a;
        self.positions = positions.to_vec();
    }
}

/// Largest differences of wheel forces and support forces, N, and of displacements, m; number of phase changes, and of
/// touching supports, over all steps.
fn compare(passage: &mut Passage<'_>, vehicle: &Multibody, steps: usize) -> ([f64; 3], usize, usize) {
    let mut plain = Plain::new(passage, vehicle);
    let (mut worst, mut changes, mut touching) = ([0.0f64; 3], 0, 0);
    let mut phases = passage.interface.phases.clone();
    for _ in 0..steps {
        passage.step().unwrap();
        plain.step(&passage.wheel_positions);
        let differ = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        worst[0] = worst[0].max(differ(&passage.interface.forces, &plain.wheel_forces));
        worst[1] = worst[1].max(differ(&passage.support_forces, &plain.support_forces));
        worst[2] = worst[2].max(differ(&passage.displacement, plain.u.as_slice()));
        changes += phases.iter().zip(&passage.interface.phases).filter(|(a, b)| a != b).count();
        touching += passage.interface.phases.iter().filter(|p| **p == SupportPhase::Touching).count();
        phases.clone_from(&passage.interface.phases);
    }
    println!("{changes} changes of phase, {touching} touching; wheels, supports, displacements differ by {worst:?}");
    (worst, changes, touching)
}

#[test]
fn agrees_with_a_plain_implementation() {
    // A short wagon, so that a short track is sufficient.
    let vehicle =
        Vehicle { bogie_spacing: 1.3, wheelset_spacing: 0.5, car_body_mass: 6e3, car_body_inertia: 4e3, ..wagon() };
    let train = Train::single(vehicle, Direction::Forward);
    let mut seen = 0;
    // Voids under the middle of the track close before the wagon and open behind it; strong dampers make sleepers touch
    // before they close; in the last case only every third sleeper carries.
    for (damping, void, every, time_step, speed) in
        [(50e3, 1e-3, 1, 1e-4, 55.56), (2e6, 1e-3, 1, 1e-4, 55.56), (10e3, 4e-3, 3, 2e-4, 90.0)]
    {
        let mut model = ballast(13);
        model.elements_per_bay = 2;
        model.rail_ends = RailEnds::Pinned;
        for seat in &mut model.seats {
            seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: damping, seating: None };
        }
        let mut level = TrackLevel { ends: [0.0; 2], ..TrackLevel::as_built(&model) };
        for (i, settlement) in level.settlements.iter_mut().enumerate() {
            *settlement = if every == 1 && (3..11).contains(&i) || i % every != 0 { void } else { 0.0 };
        }
        let stepper =
            Stepper::new(Arc::new(Track::new(model).unwrap()), Scheme::generalised_alpha(time_step, 0.85).unwrap())
                .unwrap();
        let run = Run { train: &train, start: 1.9, finish: 7.7, motion: &Motion::Constant(speed) };
        let mut passage = Passage::new(&stepper, &level, run).unwrap();
        let steps = passage.planned_steps();
        let (worst, changes, touching) = compare(&mut passage, &vehicle.into(), steps);
        let still = vehicle.mass() * 9.81 / 4.0;
        // If sleepers touch, the plain method stops at half a newton on its ramp, which is the difference.
        let (force, displacement) = if touching > 0 { (1e-4 * still, 1e-9) } else { (1e-6 * still, 1e-12) };
        assert!(worst[0] < force && worst[1] < force && worst[2] < displacement, "{worst:?}");
        assert!(changes >= 4);
        seen += touching;
    }
    assert!(seen > 0, "no sleeper touched");
}

/// Supports that seat: some close under the wagon, some hang, strong dampers make some touch.
#[test]
fn seating_supports_agree_with_a_plain_implementation() {
    let vehicle =
        Vehicle { bogie_spacing: 1.3, wheelset_spacing: 0.5, car_body_mass: 6e3, car_body_inertia: 4e3, ..wagon() };
    let train = Train::single(vehicle, Direction::Forward);
    let mut touched = 0;
    for (damping, void) in [(20e3, 0.0), (50e3, 1e-3), (2e6, 1e-3)] {
        let mut model = ballast(13);
        model.elements_per_bay = 2;
        for seat in &mut model.seats {
            let seating = Some(Seating { stiffness: 10e6, closure: 0.4e-3 });
            seat.foot = Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: damping, seating };
        }
        let level = TrackLevel { ends: [0.0; 2], ..hollow(&model, 0.0, void, 4.0, 1.5) };
        let stepper = stepper(model, 1e-4, 0.85);
        let run = Run { train: &train, start: 1.9, finish: 6.5, motion: &Motion::Constant(55.56) };
        let mut passage = Passage::new(&stepper, &level, run).unwrap();
        let steps = passage.planned_steps();
        let (worst, changes, touching) = compare(&mut passage, &vehicle.into(), steps);
        let (force, displacement) = if touching > 0 { (5.0f64, 1e-9) } else { (1e-6, 1e-12) };
        assert!(worst[0] < force.max(1e-5) && worst[1] < force && worst[2] < displacement, "{worst:?}");
        assert!(changes >= 4);
        touched += touching;
    }
    println!("{touched} touching");
}

/// Wheels on springs and dampers beside a given force, on an uneven rail.
#[test]
fn linear_wheels_agree_with_a_plain_implementation() {
    let mut vehicle =
        Multibody::sprung_wheel(3e3, 2e6, 20e3, 300.0, WheelContact::Linear { stiffness: 40e6, damping: 30e3 });
    vehicle.wheels.push(Wheel { unknown: None, offset: 1.1, contact: WheelContact::Given(25e3) });
    vehicle.wheels.push(Wheel { unknown: Some(1), offset: 0.4, contact: WheelContact::Hertz(2e9) });
    let train = Train::single(vehicle.clone(), Direction::Backward);
    let mut model = ballast(13);
    model.elements_per_bay = 2;
    let wave = |i: i32| (0.1 * f64::from(i), 2e-4 * f64::from(i).sin());
    model.irregularity = Irregularity::spline((0..80).map(wave).collect()).unwrap();
    let level = TrackLevel { ends: [0.0; 2], ..hollow(&model, 0.0, 1e-3, 4.0, 1.5) };
    let stepper = stepper(model, 1e-4, 0.85);
    let run = Run { train: &train, start: 5.7, finish: 1.9, motion: &Motion::Constant(55.56) };
    let mut passage = Passage::new(&stepper, &level, run).unwrap();
    let steps = passage.planned_steps();
    let (worst, ..) = compare(&mut passage, &vehicle, steps);
    assert!(worst[0] < 1e-5 && worst[1] < 1e-5 && worst[2] < 1e-11, "{worst:?}");
}
