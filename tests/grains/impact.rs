//! Impacts against the closed forms of the linear law: spring and dashpot, Cundall's damping, friction in an oblique
//! impact.

use crate::scenes::{DENSITY, RADIUS, alone, close, extrapolated, mass, open, shown, speed, sphere, springs};
use std::f64::consts::PI;
use trackbed::solvers::granular::{Bed, BodyId, Dashpot, DashpotMode, FrictionLimit, Linear};

const STIFFNESS: f64 = 1e7;
const SPEED: f64 = 1.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Partner {
    Sphere,
    Wall,
}

/// What an impact shows: restitution, duration times frequency, largest overlap times frequency over speed.
#[derive(Clone, Copy, Debug)]
struct Impact {
    restitution: f64,
    duration: f64,
    overlap: f64,
}

impl Impact {
    fn values(&self) -> [f64; 3] {
        [self.restitution, self.duration, self.overlap]
    }
}

/// A normal impact of a sphere that touches at time 0, with `fine` steps in the time `1/w0`.
fn impact(law: Linear, damping: f64, partner: Partner, fine: f64) -> Impact {
    let m = mass(RADIUS, DENSITY);
    let effective = if partner == Partner::Wall { m } else { m / 2.0 };
    let frequency = (law.normal_stiffness / effective).sqrt();
    let dt = 1.0 / (frequency * fine);
    let mut bed = open(law);
    bed.set_time_step(dt);
    bed.set_damping(damping);
    let low = bed.add_sphere(&sphere([0.0, 0.0, RADIUS]));
    let share = match partner {
        Partner::Wall => {
            bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
            1.0
        }
        Partner::Sphere => {
            let high = bed.add_sphere(&sphere([0.0, 0.0, -RADIUS]));
            bed.set_velocity(high, [0.0, 0.0, 0.5 * SPEED], [0.0; 3]);
            0.5
        }
    };
    bed.set_velocity(low, [0.0, 0.0, -share * SPEED], [0.0; 3]);
    let overlap = |bed: &Bed<f64>| (RADIUS - bed.body_state(low).place[2]) / share;
    let (mut forces, mut overlaps) = (vec![0.0], vec![0.0]);
    while *overlaps.last().unwrap() >= 0.0 {
        let before = speed(&bed, low, 2);
        bed.step().unwrap();
        forces.push((speed(&bed, low, 2) - before) / dt);
        overlaps.push(overlap(&bed));
    }
    // the end of the overlap, or of the force where it does not pull, straight between or beyond the last steps
    let steps = if law.mode == DashpotMode::NoTension {
        let last = forces.iter().rposition(|f| *f > 0.0).unwrap();
        (last - 1) as f64 + forces[last] / (forces[last - 1] - forces[last])
    } else {
        let [.., before, after] = overlaps[..] else { unreachable!() };
        (overlaps.len() - 2) as f64 + before / (before - after)
    };
    Impact {
        restitution: speed(&bed, low, 2) / (share * SPEED),
        duration: steps * dt * frequency,
        overlap: overlaps.iter().copied().fold(0.0, f64::max) * frequency / SPEED,
    }
}

fn damped(ratio: f64, mode: DashpotMode) -> Linear {
    Linear { dashpot: Dashpot::Ratio { normal: ratio, shear: 0.0 }, mode, ..springs(STIFFNESS, 0.0) }
}

/// Ratio of damping, restitution and duration where the dashpot may pull and where not, largest overlap.
const CLOSED: [[f64; 6]; 6] = [
    [0.05, 0.854468, 0.858758, 3.145527, 3.045360, 0.926692],
    [0.1, 0.729248, 0.744079, 3.157419, 2.956075, 0.862600],
    [0.2, 0.526621, 0.571740, 3.206375, 2.795354, 0.756135],
    [0.3, 0.372326, 0.450975, 3.293284, 2.654475, 0.671547],
    [0.5, 0.163034, 0.298436, 3.627599, 2.418399, 0.546293],
    [0.7, 0.045988, 0.210285, 4.399110, 2.227562, 0.458568],
];

/// Restitution, duration, largest overlap in closed form (Schwager and Poeschel 2007 where the dashpot does not pull).
fn closed(z: f64, mode: DashpotMode) -> [f64; 3] {
    let s = (1.0 - z * z).sqrt();
    let overlap = (-z * z.acos() / s).exp();
    match mode {
        DashpotMode::Full => [(-PI * z / s).exp(), PI / s, overlap],
        _ => [(-2.0 * z * z.acos() / s).exp(), 2.0 * z.acos() / s, overlap],
    }
}

#[test]
fn a_dashpot_that_does_not_pull() {
    let (mut coarse, mut worst) = ([0.0f64; 3], [0.0f64; 3]);
    for [z, _, free, _, short, depth] in CLOSED {
        let exact = closed(z, DashpotMode::NoTension);
        agrees(exact, [free, short, depth]);
        for partner in [Partner::Sphere, Partner::Wall] {
            let law = damped(z, DashpotMode::NoTension);
            let [whole, half] = [1000.0, 2000.0].map(|fine| alone(|| impact(law, 0.0, partner, fine)).values());
            for k in 0..3 {
                coarse[k] = coarse[k].max((whole[k] / exact[k] - 1.0).abs());
                worst[k] = worst[k].max((extrapolated(whole[k], half[k]) / exact[k] - 1.0).abs());
            }
        }
    }
    println!("restitution, duration, overlap: {} with 1000 steps, {} without", shown(&coarse), shown(&worst));
    assert!(coarse.iter().all(|e| *e < 2e-3) && worst.iter().all(|e| *e < 1e-5));
}

/// The pull ends between two steps, so the error is of the first power of the step and not smooth.
#[test]
fn a_dashpot_that_may_pull() {
    let mut worst = [0.0f64; 3];
    for [z, pulled, _, long, _, depth] in CLOSED {
        let exact = closed(z, DashpotMode::Full);
        agrees(exact, [pulled, long, depth]);
        for partner in [Partner::Sphere, Partner::Wall] {
            let found = alone(|| impact(damped(z, DashpotMode::Full), 0.0, partner, 20_000.0)).values();
            for k in 0..3 {
                worst[k] = worst[k].max((found[k] / exact[k] - 1.0).abs());
            }
        }
    }
    println!("restitution, duration, overlap: {} with 20000 steps", shown(&worst));
    assert!(worst.iter().all(|e| *e < 1.5e-4));
}

fn agrees(formula: [f64; 3], table: [f64; 3]) {
    for (formula, table) in formula.iter().zip(table) {
        assert!((formula - table).abs() < 6e-7, "{formula} {table}");
    }
}

/// Overcritical: restitution by acosh, and exp(-2) at the critical ratio.
#[test]
fn an_overcritical_contact_does_not_stick() {
    for (z, exact) in [(1.0, (-2.0f64).exp()), (1.5, (-2.0 * 1.5 * 1.5f64.acosh() / (1.5f64 * 1.5 - 1.0).sqrt()).exp())]
    {
        let [whole, half] = [1000.0, 2000.0]
            .map(|fine| alone(|| impact(damped(z, DashpotMode::NoTension), 0.0, Partner::Sphere, fine)).restitution);
        close(extrapolated(whole, half), exact, 2e-5, "restitution");
    }
}

#[test]
fn local_damping_sets_restitution_and_overlap() {
    for partner in [Partner::Sphere, Partner::Wall] {
        for a in [0.2f64, 0.7] {
            let [whole, half] =
                [1000.0, 2000.0].map(|fine| alone(|| impact(springs(STIFFNESS, 0.0), a, partner, fine)));
            let exact = ((1.0 - a) / (1.0 + a)).sqrt();
            close(half.restitution, exact, 1e-3, "restitution");
            close(extrapolated(whole.restitution, half.restitution), exact, 1e-3, "restitution at a step of zero");
            close(half.overlap, 1.0 / (1.0 + a).sqrt(), 1e-6, "largest overlap");
        }
    }
}

/// An oblique impact on a plane: velocity along the plane and surface speed `r w` after it.
fn oblique(law: Linear, down: f64, along: f64, fine: f64) -> (f64, f64, f64) {
    let frequency = (law.normal_stiffness / mass(RADIUS, DENSITY)).sqrt();
    let mut bed = open(law);
    bed.set_time_step(1.0 / (frequency * fine));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let id: BodyId = bed.add_sphere(&sphere([0.0, 0.0, RADIUS]));
    bed.set_velocity(id, [along, 0.0, -down], [0.0; 3]);
    while bed.body_state(id).place[2] <= RADIUS {
        bed.step().unwrap();
    }
    let state = bed.body_state(id);
    (state.velocity[0], RADIUS * state.spin[1], state.velocity[2])
}

#[test]
fn an_oblique_impact_that_slides_throughout() {
    let (down, friction) = (0.01, 0.3);
    let elastic = Linear { friction, ..springs(STIFFNESS, STIFFNESS) };
    // friction counts the dashpot here, so that its impulse is that of the whole normal force
    let damped = Linear { friction, limit: FrictionLimit::Total, ..damped(0.3, DashpotMode::NoTension) };
    // the dashpot pushes at once, so the shear spring must be quick
    let damped = Linear { shear_stiffness: 1e3 * STIFFNESS, ..damped };
    for (law, e) in [(elastic, 1.0), (damped, 0.450975)] {
        let along = 4.0 * friction * (1.0 + e) * down * 2.0;
        let (v, surface, rebound) = alone(|| oblique(law, down, along, 4000.0));
        close(rebound, e * down, 1e-3, "rebound");
        // with the rebound of the same run, so that its error does not count twice
        let impulse = friction * (down + rebound);
        close(along - v, impulse, 1e-4, "loss of speed along the plane");
        close(surface, 2.5 * impulse, 1e-4, "surface speed");
    }
}

#[test]
fn an_oblique_impact_without_slip() {
    let (down, along) = (0.01, 0.004);
    for (ratio, share) in [(2.0 / 7.0, 5e-5), (1.0, 5e-4), (0.5, 5e-4)] {
        let law = Linear { friction: 1e9, ..springs(STIFFNESS, ratio * STIFFNESS) };
        let (v, surface, _) = alone(|| oblique(law, down, along, 4000.0));
        let turned = (PI * (3.5f64 * ratio).sqrt()).cos();
        let slip = v - surface;
        assert!((slip / along - turned).abs() < share, "{slip} against {}", along * turned);
        let change = -2.0 / 7.0 * along * (1.0 - turned);
        assert!((v - along - change).abs() < share * along, "{v} against {}", along + change);
    }
}
