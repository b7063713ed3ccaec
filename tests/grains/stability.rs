//! The largest stable step, found by bisection, against the roots of the linear system.
//!
//! The leapfrog has a dashpot act on the velocity of half a step ago. A mode of frequency w and damping ratio Z is then
//! stable for `dt < (2/w) (sqrt(1 + Z^2) - Z)`.

use crate::scenes::{DENSITY, RADIUS, alone, close, mass, norm, open, sphere, springs, sub};
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, Domain, Gravity, Limits, Linear, Sphere,
};

const NORMAL: f64 = 1e6;
/// What modes are set off by \[m/s\] \[rad/s\]: so little that no contact opens and none slips.
const NUDGE: f64 = 1e-7;
/// With each wall \[m\].
const OVERLAP: f64 = 1e-5;

fn limit(frequency: f64, ratio: f64) -> f64 {
    2.0 / frequency * ((1.0 + ratio * ratio).sqrt() - ratio)
}

/// A mode set off in a bed.
struct Trial {
    bed: Bed<f64>,
    body: BodyId,
    /// Motion that leaves the linear range \[m\].
    large: f64,
    damped: bool,
}

impl Trial {
    /// Largest change of velocity in a step, as a way; none where it leaves the linear range. Slow drifts do not show
    /// in it.
    fn jolt(&self, bed: &mut Bed<f64>, steps: u64) -> Option<f64> {
        let mut most: f64 = 0.0;
        for _ in 0..steps {
            let before = bed.body_state(self.body);
            bed.step().ok()?;
            let after = bed.body_state(self.body);
            let change = norm(sub(after.velocity, before.velocity)) + RADIUS * norm(sub(after.spin, before.spin));
            most = most.max(bed.time_step() * change);
        }
        (most < self.large).then_some(most)
    }

    /// Whether the motion grows. Near the border a damped mode turns its sign every step and grows or decays by a fixed
    /// factor; an undamped one is bounded below the border and grows by a factor above.
    fn grows(&self, dt: f64) -> bool {
        let mut bed = self.bed.clone();
        // the border itself is looked for, which a healthy run keeps away from
        bed.set_limits(Limits { growth: false, ..Limits::default() });
        bed.set_time_step(dt);
        let mut jolts = || Some([self.jolt(&mut bed, 500)?, self.jolt(&mut bed, 100)?, self.jolt(&mut bed, 2400)?]);
        let Some([first, early, _]) = jolts() else { return true };
        let Some(late) = self.jolt(&mut bed, 100) else { return true };
        if self.damped { late > early.max(1e-2 * first) } else { late > 100.0 * first }
    }

    /// The step from which the motion grows \[s\].
    fn boundary(&self, expected: f64) -> f64 {
        let (mut low, mut high) = (0.9 * expected, 1.1 * expected);
        assert!(!self.grows(low) && self.grows(high), "the border lies within 10 % of {expected}");
        while high - low > 2e-5 * expected {
            let middle = 0.5 * (low + high);
            if self.grows(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    fn meets(&self, what: &str, expected: f64) {
        let found = alone(|| self.boundary(expected));
        println!("{what}: {found:.4e} s, exact {expected:.4e} s");
        close(found, expected, 5e-5, "largest stable step");
    }
}

/// A sphere that overlaps the wall below it, and the one above it as well where there are `two`.
fn between_walls(law: Linear, two: bool) -> (Bed<f64>, BodyId, f64) {
    let mut bed = open(law);
    let id = bed.add_sphere(&sphere([0.0, 0.0, RADIUS - OVERLAP]));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    if two {
        bed.add_plane([0.0, 0.0, 2.0 * (RADIUS - OVERLAP)], [0.0, 0.0, -1.0], 0);
    }
    (bed, id, RADIUS - 0.5 * OVERLAP)
}

#[test]
fn a_sphere_between_two_walls_normal() {
    let m = mass(RADIUS, DENSITY);
    for z in [0.0, 0.1, 0.3, 0.7] {
        let law = Linear { dashpot: Dashpot::Ratio { normal: z, shear: 0.0 }, ..springs(NORMAL, 0.0) };
        let (mut bed, body, _) = between_walls(law, true);
        bed.set_velocity(body, [0.0, 0.0, NUDGE], [0.0; 3]);
        let trial = Trial { bed, body, large: 1e-6, damped: z > 0.0 };
        trial.meets(&format!("normal, ratio {z}"), limit((2.0 * NORMAL / m).sqrt(), 2.0f64.sqrt() * z));
    }
}

/// Translation and rotation of a sphere between two walls, and both at once on one wall, on which its weight holds it.
#[test]
fn a_sphere_on_walls_tangential() {
    let m = mass(RADIUS, DENSITY);
    let (normal, shear) = (1e-2 * NORMAL, NORMAL);
    for z in [0.0, 0.1, 0.3] {
        let dashpot = Dashpot::Ratio { normal: 0.0, shear: z };
        let law = Linear { friction: 1e9, dashpot, ..springs(normal, shear) };
        for (name, two) in [("translation", true), ("rotation", true), ("both", false)] {
            let (mut bed, body, arm) = between_walls(law, two);
            let spin = arm * arm / (0.4 * m * RADIUS * RADIUS);
            // what a unit force of the contacts does at the contact point
            let (inverse, velocity, turning) = match name {
                "translation" => (2.0 / m, NUDGE, 0.0),
                "rotation" => (2.0 * spin, 0.0, NUDGE / RADIUS),
                // as a push at the contact would do it, so that nothing rolls away
                _ => (1.0 / m + spin, NUDGE, -2.5 * arm / (RADIUS * RADIUS) * NUDGE),
            };
            if !two {
                bed.set_gravity(Gravity::Constant([0.0, 0.0, -normal * OVERLAP / m]));
            }
            bed.set_velocity(body, [velocity, 0.0, 0.0], [0.0, turning, 0.0]);
            let frequency = (shear * inverse).sqrt();
            let dashpot = 2.0 * z * (m * shear).sqrt();
            let trial = Trial { bed, body, large: 1e-6, damped: z > 0.0 };
            trial.meets(&format!("{name}, ratio {z}"), limit(frequency, 0.5 * dashpot * inverse / frequency));
        }
    }
}

/// Two spheres of different mass, pressed on each other by walls that are a hundred thousand times softer.
#[test]
fn two_spheres_on_each_other() {
    let soft = springs(1e-5 * NORMAL, 0.0);
    for z in [0.0, 0.1, 0.3, 0.7] {
        let law = Linear { dashpot: Dashpot::Ratio { normal: z, shear: 0.0 }, ..springs(NORMAL, 0.0) };
        let mut laws = ContactLaws::uniform(2, ContactLaw::Linear(law));
        laws.set(0, 1, ContactLaw::Linear(soft));
        let mut bed = Bed::<f64>::new(Domain::open(), laws);
        let (small, large) = (RADIUS, 1.5 * RADIUS);
        let (deep, overlap) = (5e-3, 5e-8);
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 1);
        let body = bed.add_sphere(&Sphere { radius: small, ..sphere([0.0, 0.0, small - deep]) });
        let place = small - deep + small + large - overlap;
        let other = bed.add_sphere(&Sphere { radius: large, ..sphere([0.0, 0.0, place]) });
        bed.add_plane([0.0, 0.0, place + large - deep], [0.0, 0.0, -1.0], 1);
        let (a, b) = (mass(small, DENSITY), mass(large, DENSITY));
        let nudge = 0.05 * NUDGE;
        bed.set_velocity(body, [0.0, 0.0, nudge], [0.0; 3]);
        bed.set_velocity(other, [0.0, 0.0, -nudge * a / b], [0.0; 3]);
        let trial = Trial { bed, body, large: 1e-8, damped: z > 0.0 };
        trial.meets(&format!("pair, ratio {z}"), limit((NORMAL * (1.0 / a + 1.0 / b)).sqrt(), z));
    }
}
