//! The coupled step against closed forms: columns of spheres as springs, a ball on an elastic block, energy under a
//! moving force.

use super::soil::{Plan, SoilBelow};
use super::step::{Coupled, Spent, StandingBed};
use crate::graph::{SoilLayer, SoilNode};
use crate::nodes::NodeError;
use crate::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Pose, Shape, Sphere,
    WallId, WallMotion,
};
use crate::solvers::track::{
    Foot, Irregularity, Leapfrog, Loads, Pitch, RailEnds, RailSection, Seat, Track, TrackLevel, TrackModel, UnderPad,
    WheelLoads, solve_static,
};
use nalgebra::Vector3;
use std::sync::Arc;

const SPACING: f64 = 0.6;
const SLEEPERS: usize = 9;
const RADIUS: f64 = 0.1;
const HALF_HEIGHT: f64 = 0.1;
const GRAVITY: f64 = 9.81;
const WHEEL: f64 = 98.1e3;

fn laws(stiffness: f64, dashpot: f64) -> ContactLaws {
    ContactLaws::single(ContactLaw::Linear(Linear {
        normal_stiffness: stiffness,
        shear_stiffness: stiffness,
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: dashpot, shear: 0.0 },
        mode: DashpotMode::default(),
        limit: FrictionLimit::default(),
    }))
}

fn soil(youngs_modulus: f64, thickness: f64, element: f64) -> SoilNode {
    let layer = SoilLayer {
        name: "clay".into(),
        thickness,
        youngs_modulus,
        poisson_ratio: 0.25,
        density: 2000.0,
        strength: None,
    };
    SoilNode { layers: vec![layer], blocks: Vec::new(), element, quiet_base: false, gravity: GRAVITY }
}

/// A rail over sleepers 0.6 m apart; `foot` says what is under each.
fn rail(foot: impl Fn(usize) -> Foot) -> TrackModel {
    let ends = [0.0, SPACING * SLEEPERS as f64];
    let seat = |i: usize| Seat { x: SPACING * (i as f64 + 0.5), pad_stiffness: 40e6, pad_damping: 5e3, foot: foot(i) };
    TrackModel {
        ends,
        rail: vec![RailSection { start: ends[0], end: ends[1], mass: 60.0, bending_stiffness: 6.4e6, shear: None }],
        seats: (0..SLEEPERS).map(seat).collect(),
        slabs: Vec::new(),
        auxiliary_rails: Vec::new(),
        joints: Vec::new(),
        rail_ends: RailEnds::Free,
        elements_per_bay: 4,
        irregularity: Irregularity::default(),
        gravity: GRAVITY,
    }
}

/// Each sleeper on a column of spheres, `lowered` so far below the level of the others (m), on a rigid floor or on
/// soil.
struct Columns {
    spheres: usize,
    stiffness: f64,
    dashpot: f64,
    soil: Option<SoilNode>,
    lowered: fn(usize) -> f64,
    /// Distance of every column from the middle of its sleeper, along the rail, m.
    shift: f64,
    pitch: Option<Pitch>,
    pad: Option<UnderPad>,
    time_step: f64,
}

impl Columns {
    fn plain(spheres: usize) -> Columns {
        let stiffness = 50e6 * (spheres + 1) as f64;
        Columns {
            spheres,
            stiffness,
            dashpot: 0.0,
            soil: None,
            lowered: |_| 0.0,
            shift: 0.0,
            pitch: None,
            pad: None,
            time_step: 20e-6,
        }
    }

    fn build(&self) -> Result<Coupled, NodeError> {
        let mut bed: Bed<f32> = Bed::new(Domain::open(), laws(self.stiffness, self.dashpot));
        let floor = bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.set_gravity(Gravity::EARTH);
        let top = 2.0 * RADIUS * self.spheres as f64;
        let plan = Plan { start: 0.0, sides: [SPACING * SLEEPERS as f64, SPACING] };
        let mut sleepers: Vec<(WallId, usize)> = Vec::new();
        for number in 0..SLEEPERS {
            let (x, y) = (SPACING * (number as f64 + 0.5), 0.5 * SPACING);
            // a column that is lower lacks the top of its uppermost sphere
            let radius = RADIUS - 0.5 * (self.lowered)(number) / self.spheres as f64;
            for sphere in 0..self.spheres {
                let centre = [x + self.shift, y, radius * (2 * sphere + 1) as f64];
                bed.add_sphere(&Sphere { centre, radius, density: 2700.0, surface: 0 });
            }
            let half = Vector3::new(0.12, 0.25, HALF_HEIGHT);
            let pose = Pose { position: Vector3::new(x, y, top + HALF_HEIGHT), ..Pose::default() };
            sleepers.push((bed.add_wall(Shape::Block { half }, pose, 0, WallMotion::Guided), number));
        }
        bed.set_time_step(self.time_step);
        let soil = match &self.soil {
            Some(node) => Some(SoilBelow::new(&mut bed, floor, plan, node)?),
            None => None,
        };
        let model = rail(|_| Foot::Carried { mass: 150.0, pad: self.pad, pitch: self.pitch });
        let level = TrackLevel::as_built(&model);
        let rail = Leapfrog::new(Arc::new(Track::new(model)?), &level, self.time_step)?;
        let standing = StandingBed { bed, sleepers, soil };
        let pushes = vec![0.0; SLEEPERS];
        Ok(Coupled { rail, beds: vec![standing], pushes, added: 0.0, spent: Spent::default() })
    }
}

fn middle() -> f64 {
    SPACING * (0.5 * SLEEPERS as f64)
}

/// A column of n equal contacts has the stiffness of one contact over n. A wheel stands on the rail: seat loads and
/// levels are those of the track on such springs.
#[test]
fn columns_of_spheres_are_springs() {
    for spheres in [1, 3] {
        let mut coupled = Columns::plain(spheres).build().unwrap();
        coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
        let [before, forces] = [levels(&coupled), coupled.pushes.clone()];
        stand_under(&mut coupled, (middle(), WHEEL));
        let model =
            rail(|_| Foot::Sleeper { mass: 150.0, support_stiffness: 50e6, support_damping: 0.0, seating: None });
        let track = Track::new(model.clone()).unwrap();
        let level = TrackLevel::as_built(&model);
        let rest = solve_static(&track, &level, &Loads::default()).unwrap();
        let loaded = solve_static(&track, &level, &Loads { rail: &[(middle(), WHEEL)], ..Loads::default() }).unwrap();
        for seat in 0..SLEEPERS {
            let force = coupled.pushes[seat] - forces[seat];
            let expected = loaded.contact_forces[seat] - rest.contact_forces[seat];
            assert!((force - expected).abs() < 2e-4 * 40e3, "{spheres} spheres, seat {seat}: {force} and {expected} N");
            let level = levels(&coupled)[seat] - before[seat];
            let expected = loaded.foot_displacements[seat] - rest.foot_displacements[seat];
            assert!(
                (level - expected).abs() < 2e-4 * 0.8e-3,
                "{spheres} spheres, seat {seat}: {level} and {expected} m"
            );
        }
    }
}

/// The underside of a pad weighs 5 g, half of what one contact needs at this step: it gets more, and the seats carry
/// what they carry on a spring and a pad in series. A pad whose underside weighs 2 kg gets nothing.
#[test]
fn a_light_underside_gets_the_mass_that_its_contacts_need() {
    let pad = |mass: f64| UnderPad { mass, stiffness: 70e6, damping: 14e3 };
    let model = rail(|_| Foot::Sleeper {
        mass: 150.0,
        support_stiffness: 50e6 * 70e6 / 120e6,
        support_damping: 0.0,
        seating: None,
    });
    let track = Track::new(model.clone()).unwrap();
    let level = TrackLevel::as_built(&model);
    let on_springs =
        |rail: &[(f64, f64)]| solve_static(&track, &level, &Loads { rail, ..Loads::default() }).unwrap().contact_forces;
    let [unloaded, loaded] = [on_springs(&[]), on_springs(&[(middle(), WHEEL)])];
    for (mass, gets) in [(5e-3, SLEEPERS as f64 * (3.0 * 0.01 - 5e-3)), (2.0, 0.0)] {
        let mut coupled = Columns { pad: Some(pad(mass)), ..Columns::plain(1) }.build().unwrap();
        coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
        let before = coupled.pushes.clone();
        stand_under(&mut coupled, (middle(), WHEEL));
        for seat in 0..SLEEPERS {
            let (force, expected) = (coupled.pushes[seat] - before[seat], loaded[seat] - unloaded[seat]);
            assert!((force - expected).abs() < 1e-3 * 40e3, "{mass} kg, seat {seat}: {force} and {expected} N");
        }
        assert!((coupled.rail.added_mass() - gets).abs() < 1e-9, "{mass} kg: {} kg", coupled.rail.added_mass());
    }
}

/// Half a sleeper on a rail pad ten times stiffer than real ones, so that turns stay small and statics linear.
const PITCH: Pitch = Pitch { inertia: 1.5, stiffness: 750e3 };

/// A column beside the middle of a sleeper turns it. The rail pad bears the moment.
#[test]
fn a_sleeper_that_turns_is_held_by_its_rail_pad() {
    let shift = 0.03;
    let mut coupled = Columns { shift, pitch: Some(PITCH), ..Columns::plain(1) }.build().unwrap();
    coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
    let state = |coupled: &Coupled| -> Vec<[f64; 4]> {
        let view = coupled.rail.view();
        let of = |foot: usize| {
            let turned = coupled.rail.pitch(foot).unwrap().level;
            let slope = view.rail_slope(coupled.rail.track().seat_node(foot));
            [coupled.pushes[foot], coupled.level(foot), turned, slope]
        };
        (0..SLEEPERS).map(of).collect()
    };
    let before = state(&coupled);
    stand_under(&mut coupled, (middle(), WHEEL));
    let mut turned: f64 = 0.0;
    for ([push, level, turn, slope], before) in state(&coupled).into_iter().zip(before) {
        // a sleeper that the rail lifts leaves its column; the place of contact rolls a little
        let column = (before[0] + 50e6 * (level - before[1] + shift * (turn - before[2]))).max(0.0);
        assert!((push - column).abs() < 2e-3 * 40e3, "{push} N on the sleeper, {column} N in the column");
        let [on_sleeper, in_pad] = [shift * push, PITCH.stiffness * (turn - slope)];
        assert!((on_sleeper + in_pad).abs() < 0.01 * 40e3 * shift, "{on_sleeper} and {in_pad} N m");
        turned = turned.max(turn.abs());
    }
    assert!(turned > 1e-3, "{turned}");
}

fn levels(coupled: &Coupled) -> Vec<f64> {
    (0..SLEEPERS).map(|foot| coupled.level(foot)).collect()
}

/// A wheel's force that runs over the middle of the rail at 200 km/h and grows and goes smoothly on the way, N.
fn passing(time: f64, loads: &mut Vec<(f64, f64)>) {
    let (speed, way) = (200.0 / 3.6, [0.9, 4.5]);
    let share = speed * time / (way[1] - way[0]);
    loads.clear();
    if share < 1.0 {
        loads.push((way[0] + share * (way[1] - way[0]), WHEEL * (std::f64::consts::PI * share).sin().powi(2)));
    }
}

/// Lets that force pass and a little time more, with inertia as it is.
fn pass(coupled: &mut Coupled, mut see: impl FnMut(&Coupled)) {
    let (mut loads, dt) = (Vec::new(), coupled.time_step());
    for step in 0..(0.08 / dt) as u64 {
        passing(step as f64 * dt, &mut loads);
        coupled.step(&WheelLoads::Given(&loads)).unwrap();
        see(coupled);
    }
}

/// Everything comes to rest under a wheel that stands, damped.
fn stand_under(coupled: &mut Coupled, (x, force): (f64, f64)) {
    coupled.beds[0].bed.set_damping(0.7);
    coupled.rail.set_drag(200.0).unwrap();
    let steps = (0.6 / coupled.time_step()) as u64;
    for step in 0..steps {
        let grown = (4.0 * step as f64 / steps as f64).min(1.0);
        coupled.step(&WheelLoads::Given(&[(x, grown * force)])).unwrap();
    }
}

/// Rail, spheres and soil keep the work of a wheel that passes. Nothing is lost between them, and the unexplained part
/// falls with the square of the step.
#[test]
fn energy_is_kept_from_the_wheel_to_the_soil() {
    let run = |time_step: f64, youngs_modulus: f64, (shift, pitch): (f64, Option<Pitch>)| {
        let soil = Some(soil(youngs_modulus, 0.4, 0.2));
        let columns = Columns { soil, dashpot: 0.1, shift, pitch, time_step, ..Columns::plain(1) };
        let mut coupled = columns.build().unwrap();
        coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
        coupled.watch_energy();
        pass(&mut coupled, |_| {});
        coupled.energy()
    };
    // the last turns its sleepers
    for (youngs_modulus, turning) in [(50e6, (0.0, None)), (500e6, (0.0, None)), (500e6, (0.03, Some(PITCH)))] {
        let (coarse, fine) = (run(20e-6, youngs_modulus, turning), run(10e-6, youngs_modulus, turning));
        let work = coarse.wheels;
        assert!(work > 5.0, "{work} J");
        assert!(coarse.interfaces.abs() < 1e-4 * work, "{} of {work} J", coarse.interfaces);
        assert!(coarse.unaccounted.abs() < 1e-3 * work, "{} of {work} J", coarse.unaccounted);
        assert!(
            fine.unaccounted.abs() < 0.5 * coarse.unaccounted.abs(),
            "{} J, then {} J",
            coarse.unaccounted,
            fine.unaccounted
        );
    }
}

/// A sphere on an elastic block, a thousand times: nothing is lost or won.
#[test]
fn a_ball_bounces_on_an_elastic_block_a_thousand_times() {
    let mut bed: Bed<f32> = Bed::new(Domain::open(), laws(5e6, 0.0));
    let floor = bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::Constant([0.0, 0.0, -100.0]));
    let ball = Sphere { centre: [0.2, 0.2, 0.05], radius: 0.05, density: 2700.0, surface: 0 };
    let id = bed.add_sphere(&ball);
    bed.set_velocity(id, [0.0, 0.0, 0.3], [0.0; 3]);
    let node = SoilNode { gravity: 0.0, ..soil(50e6, 0.2, 0.2) };
    bed.set_time_step(20e-6);
    let mut below = SoilBelow::new(&mut bed, floor, Plan { start: 0.0, sides: [0.4, 0.4] }, &node).unwrap();
    bed.watch_energy(true);
    below.soil.watch(true);
    let mass = 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3);
    let start = 0.5 * mass * 0.3 * 0.3;
    let (mut bounces, mut touched, mut worst) = (0, false, 0.0_f64);
    while bounces < 1000 {
        bed.guided_step::<NodeError>(|walls| below.step(walls)).unwrap();
        let sheet = bed.wall(floor).sheet().unwrap();
        let touches = sheet.forces().iter().any(|force| force[2] < 0.0);
        bounces += u32::from(touches && !touched);
        touched = touches;
        let (grains, soil) = (bed.energy(), below.soil.energy());
        worst = worst.max((grains.residual() + soil.residual() + grains.walls + soil.external).abs() / start);
    }
    let soil = below.soil.energy();
    assert!(soil.kinetic + soil.strain > 1e-3 * start, "the block takes part: {} J", soil.kinetic + soil.strain);
    assert!(worst < 0.01, "{worst} of the ball's energy");
}

/// A sleeper 20 mm above its column hangs on the rail under every wheel, and its neighbours carry.
#[test]
fn a_sleeper_over_a_void_of_20_mm_hangs() {
    let lowered = |number: usize| if number == SLEEPERS / 2 { 0.02 } else { 0.0 };
    let mut coupled = Columns { lowered, dashpot: 0.1, ..Columns::plain(1) }.build().unwrap();
    coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
    let mut most = [0.0_f64; SLEEPERS];
    pass(&mut coupled, |coupled| {
        for (most, push) in most.iter_mut().zip(&coupled.pushes) {
            assert!(push.is_finite());
            *most = most.max(*push);
        }
    });
    assert_eq!(most[SLEEPERS / 2], 0.0);
    assert!(most[SLEEPERS / 2 - 1] > 40e3 && most[SLEEPERS / 2 - 1] < 80e3, "{most:?}");
}

/// Soil from very soft to almost rigid. The time step adapts, the sleeper sinks less on stiffer soil, and the stiffest
/// soil gives the answer of a rigid floor.
#[test]
fn soft_and_stiff_soil_run() {
    let sink = |youngs_modulus: f64| {
        let soil = Some(soil(youngs_modulus, 0.4, 0.2));
        let mut columns = Columns { soil, dashpot: 0.1, ..Columns::plain(1) };
        let built = columns.build().unwrap();
        let longest = built.beds[0].soil.as_ref().unwrap().longest_step(&built.beds[0].bed);
        columns.time_step = columns.time_step.min(longest);
        let mut coupled = columns.build().unwrap();
        coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
        let before = levels(&coupled)[SLEEPERS / 2];
        let mut most: f64 = 0.0;
        pass(&mut coupled, |coupled| most = most.max(coupled.level(SLEEPERS / 2) - before));
        [1e3 * most, 1e6 * coupled.time_step()]
    };
    let found = [5e6, 50e6, 500e6, 50e9, 5e12].map(sink);
    assert!(found.windows(2).all(|pair| pair[0][0] > pair[1][0]), "stiffer soil sinks less: {found:?}");
    assert!(found[4][1] < 20.0, "what is as good as rigid takes shorter steps: {found:?}");
    // a rigid floor
    let mut coupled = Columns { dashpot: 0.1, ..Columns::plain(1) }.build().unwrap();
    coupled.come_to_rest(2.0, &mut |_| {}).unwrap();
    let before = levels(&coupled)[SLEEPERS / 2];
    let mut most: f64 = 0.0;
    pass(&mut coupled, |coupled| most = most.max(coupled.level(SLEEPERS / 2) - before));
    assert!((found[4][0] / (1e3 * most) - 1.0).abs() < 0.01, "{} and {} mm", found[4][0], 1e3 * most);
}
