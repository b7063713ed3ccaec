//! The force of one contact at one instant, term by term: dashpot modes, limits of friction, properties of pairs.

use crate::scenes::{DENSITY, RADIUS, Vec3, alone, close, mass, open, sphere, springs};
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Linear, Surface, in_series,
};

const DT: f64 = 1e-6;
const NORMAL: f64 = 2e6;
const SHEAR: f64 = 1e6;
const MODES: [DashpotMode; 4] =
    [DashpotMode::Full, DashpotMode::NoTension, DashpotMode::RestInSlip, DashpotMode::NoTensionRestInSlip];

/// Force on a sphere above another at `overlap`, when it moves with `velocity` and has no history.
fn force(law: Linear, overlap: f64, velocity: Vec3) -> Vec3 {
    let mut bed = open(law);
    bed.set_time_step(DT);
    bed.add_sphere(&sphere([0.0; 3]));
    let upper = bed.add_sphere(&sphere([0.0, 0.0, 2.0 * RADIUS - overlap]));
    bed.set_velocity(upper, velocity, [0.0; 3]);
    let snapshot = alone(|| bed.snapshot()).unwrap();
    let Some(contact) = snapshot.contacts.first() else { return [0.0; 3] };
    let sign = if contact.first.body() == Some(upper) { 1.0 } else { -1.0 };
    contact.force.map(|f| sign * f)
}

fn law(mode: DashpotMode) -> Linear {
    Linear { friction: 0.5, dashpot: Dashpot::Constant { normal: 300.0, shear: 200.0 }, mode, ..springs(NORMAL, SHEAR) }
}

#[test]
fn modes_say_what_dashpots_may_do() {
    let overlap = 1e-5;
    let spring = NORMAL * overlap;
    for mode in MODES {
        // closing: dashpots push in every mode
        let [_, _, closing] = force(law(mode), overlap, [0.0, 0.0, -0.1]);
        close(closing, spring + 300.0 * 0.1, 1e-9, "closing");
        // opening slowly: less push
        let [_, _, opening] = force(law(mode), overlap, [0.0, 0.0, 0.05]);
        close(opening, spring - 300.0 * 0.05, 1e-9, "opening slowly");
        // opening fast: the whole would pull
        let [_, _, fast] = force(law(mode), overlap, [0.0, 0.0, 0.1]);
        let pull = if mode.pulls() { spring - 30.0 } else { 0.0 };
        assert!((fast - pull).abs() < 1e-8, "{mode:?}: {fast} against {pull}");
        // sticking: spring and dashpot against the slip
        let along = 0.01;
        let [stick, _, _] = force(law(mode), overlap, [along, 0.0, 0.0]);
        close(stick, -(SHEAR * along * DT + 200.0 * along), 1e-9, "sticking");
        // slipping: the spring at its limit, the dashpot by mode
        let along = 20.0;
        let [slip, _, _] = force(law(mode), overlap, [along, 0.0, 0.0]);
        let dashpot = if mode.rests_in_slip() { 0.0 } else { 200.0 * along };
        close(slip, -(0.5 * spring + dashpot), 1e-9, "slipping");
    }
}

#[test]
fn friction_is_a_share_of_the_spring_or_of_all() {
    let overlap = 1e-5;
    let velocity = [20.0, 0.0, -0.02];
    for (limit, base) in [(FrictionLimit::Spring, 20.0), (FrictionLimit::Total, 20.0 + 300.0 * 0.02)] {
        let law = Linear { limit, ..law(DashpotMode::NoTensionRestInSlip) };
        let [along, _, normal] = force(law, overlap, velocity);
        close(along, -0.5 * base, 1e-9, "friction");
        close(normal, 20.0 + 300.0 * 0.02, 1e-9, "normal force");
    }
    // where the dashpot pulls, its magnitude counts
    let law = Linear { limit: FrictionLimit::Total, ..law(DashpotMode::RestInSlip) };
    let [along, _, normal] = force(law, overlap, [20.0, 0.0, 0.1]);
    close(normal, -10.0, 1e-8, "pull");
    close(along, -5.0, 1e-8, "friction of a pull");
}

/// In the step of first touch only the part of it in contact counts for the shear spring.
#[test]
fn the_first_step_counts_in_part() {
    let (along, down) = (0.1, 0.5);
    for part in [0.25, 0.75] {
        let overlap = part * down * DT;
        let [shear, _, normal] =
            force(Linear { friction: 1e9, ..springs(NORMAL, SHEAR) }, overlap, [along, 0.0, -down]);
        close(normal, NORMAL * overlap, 1e-7, "normal");
        close(shear, -SHEAR * along * DT * part, 1e-7, "shear");
    }
    let [shear, _, _] = force(Linear { friction: 1e9, ..springs(NORMAL, SHEAR) }, 1e-5, [along, 0.0, -down]);
    close(shear, -SHEAR * along * DT, 1e-9, "shear of a contact that was there");
}

#[test]
fn ratio_dashpots_use_the_mass_of_the_pair() {
    let dashpot = Dashpot::Ratio { normal: 0.3, shear: 0.2 };
    let law = Linear { friction: 0.5, dashpot, ..springs(NORMAL, SHEAR) };
    let m = mass(RADIUS, DENSITY);
    let [along, _, up] = force(law, 1e-5, [0.01, 0.0, -0.1]);
    close(up, NORMAL * 1e-5 + 0.1 * 2.0 * 0.3 * (0.5 * m * NORMAL).sqrt(), 1e-9, "pair");
    close(along, -0.01 * (SHEAR * DT + 2.0 * 0.2 * (0.5 * m * SHEAR).sqrt()), 1e-9, "pair, shear");

    let mut bed = open(law);
    bed.set_time_step(DT);
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let id = bed.add_sphere(&sphere([0.0, 0.0, RADIUS - 1e-5]));
    bed.set_velocity(id, [0.0, 0.0, -0.1], [0.0; 3]);
    let snapshot = alone(|| bed.snapshot()).unwrap();
    let up = snapshot.contacts[0].force[2];
    close(up, NORMAL * 1e-5 + 0.1 * 2.0 * 0.3 * (m * NORMAL).sqrt(), 1e-9, "wall");
}

#[test]
fn pairs_inherit_from_their_surfaces() {
    let surface = |k: f64, friction: f64, ratio: f64| Surface {
        normal_stiffness: k,
        shear_stiffness: 0.5 * k,
        friction,
        damping: [ratio, ratio],
        mode: DashpotMode::NoTensionRestInSlip,
    };
    let surfaces = [surface(1.3e7, 0.7, 0.3), surface(5e6, 0.5, 0.1), surface(1e9, 0.2, 0.0)];
    let laws = ContactLaws::from_surfaces(&surfaces);
    close(in_series(1.3e7, 5e6), 1.3e7 * 5e6 / 1.8e7, 1e-15, "in series");
    for (a, first) in surfaces.iter().enumerate() {
        for (b, second) in surfaces.iter().enumerate() {
            let ContactLaw::Linear(law) = laws.get(a as u16, b as u16) else { panic!("not linear") };
            close(
                law.normal_stiffness,
                1.0 / (1.0 / first.normal_stiffness + 1.0 / second.normal_stiffness),
                1e-15,
                "",
            );
            close(law.shear_stiffness, 0.5 * law.normal_stiffness, 1e-15, "");
            assert_eq!(law.friction, first.friction.min(second.friction));
            assert_eq!(laws.get(a as u16, b as u16), laws.get(b as u16, a as u16));
        }
    }
    // the bed uses the law of the pair, whichever is made first, and of sphere and wall
    for order in [[0u16, 1], [1, 0]] {
        let mut bed = Bed::<f64>::new(Domain::open(), laws.clone());
        bed.set_time_step(DT);
        for (k, surface) in order.into_iter().enumerate() {
            let centre = [0.0, 0.0, RADIUS - 1e-5 + (2.0 * RADIUS - 2e-5) * k as f64];
            bed.add_sphere(&trackbed::solvers::granular::Sphere { surface, ..sphere(centre) });
        }
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 2);
        let contacts = alone(|| bed.snapshot()).unwrap().contacts;
        close(contacts[0].force[2].abs(), in_series(1.3e7, 5e6) * 2e-5, 1e-9, "pair");
        let own = [1.3e7, 5e6][usize::from(order[0])];
        close(contacts[1].force[2], in_series(own, 1e9) * 1e-5, 1e-9, "wall");
    }
}
