//! Numbers that cannot be are told before anything moves: no panic, and no state that is no number.

use nalgebra::{UnitQuaternion, Vector3};
use trackbed::solvers::granular::clump::{Pebble, Template};
use trackbed::solvers::granular::shape::Shape;
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, Domain, Failure, Fault, Gravity, HertzMindlin, Limits, Linear,
    Placed, Pose, Sphere, Subject, WallMotion,
};

const BAD: [f64; 5] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0];

fn law() -> Linear {
    Linear {
        normal_stiffness: 1e6,
        shear_stiffness: 1e6,
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.1, shear: 0.1 },
        mode: Default::default(),
        limit: Default::default(),
    }
}

fn ball() -> Sphere {
    Sphere { centre: [0.1, 0.2, 0.3], radius: 0.02, density: 2700.0, surface: 0 }
}

/// A sound bed of two spheres that touch, on a plane.
fn sound() -> Bed<f32> {
    let mut bed = Bed::new(Domain::open().periodic(0, 1.0), ContactLaws::single(ContactLaw::Linear(law())));
    bed.add_sphere(&ball());
    bed.add_sphere(&Sphere { centre: [0.139, 0.2, 0.3], ..ball() });
    bed.add_plane([0.0, 0.0, 0.281], [0.0, 0.0, 1.0], 0);
    bed.set_gravity(Gravity::EARTH);
    bed.set_time_step(1e-5);
    bed.step().unwrap();
    bed
}

/// What a step says once `spoil` was done to a sound bed; nothing may have moved.
fn fault(spoil: impl FnOnce(&mut Bed<f32>)) -> Fault {
    let mut bed = sound();
    spoil(&mut bed);
    let (time, before) = (bed.time(), bed.states().map(|s| s.place.map(f64::to_bits)).collect::<Vec<_>>());
    let told = bed.step();
    assert_eq!((bed.time(), before), (time, bed.states().map(|s| s.place.map(f64::to_bits)).collect()));
    // in words, for NaN is not itself
    assert_eq!(bed.snapshot().unwrap_err().to_string(), told.clone().unwrap_err().to_string());
    let Err(Failure::Fault(fault)) = told else { panic!("{told:?}") };
    assert_eq!(bed.check().unwrap_err().to_string(), fault.to_string());
    assert!(fault.to_string().contains("expected"), "{fault}");
    fault
}

#[test]
fn spheres_that_cannot_be_are_told() {
    for bad in BAD {
        let told = fault(|bed| {
            bed.add_sphere(&Sphere { radius: bad, ..ball() });
        });
        assert!(matches!(told.of, Subject::Body(id) if id.0 == 2) && told.quantity == "radius", "{told}");
        fault(|bed| {
            bed.add_sphere(&Sphere { density: bad, ..ball() });
        });
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for axis in 0..3 {
            let mut centre = ball().centre;
            centre[axis] = bad;
            fault(|bed| {
                bed.add_sphere(&Sphere { centre, ..ball() });
            });
        }
    }
    assert_eq!(
        fault(|bed| {
            bed.add_sphere(&Sphere { surface: 1, ..ball() });
        })
        .quantity,
        "surface"
    );
    fault(|bed| {
        bed.add_sphere(&Sphere { radius: 1e-20, ..ball() });
    });
    let told = fault(|bed| bed.set_velocity(BodyId(0), [0.0, f64::NAN, 0.0], [0.0; 3]));
    assert_eq!(told.to_string(), "body 0: expected velocity to be a number, found NaN");
    fault(|bed| bed.set_velocity(BodyId(0), [0.0; 3], [f64::INFINITY; 3]));
}

#[test]
fn clumps_that_cannot_be_are_told() {
    let pebble = |x: f64| Pebble { centre: Vector3::new(x, 0.0, 0.0), radius: 0.02 };
    let template = Template::from_pebbles(&[pebble(0.0), pebble(0.02)]).unwrap();
    let add = |template: &Template, attitude: UnitQuaternion<f64>, density: f64| {
        fault(|bed| {
            bed.add_clump(&Placed { template, centre: [0.5; 3], attitude, density, surface: 0 });
        })
    };
    for bad in BAD {
        add(&template, UnitQuaternion::identity(), bad);
        let mut spoilt = template.clone();
        spoilt.pebbles[1].radius = bad;
        add(&spoilt, UnitQuaternion::identity(), 2700.0);
    }
    for bad in [f64::NAN, 0.0, -1.0] {
        let mut spoilt = template.clone();
        spoilt.inertia.z = bad;
        add(&spoilt, UnitQuaternion::identity(), 2700.0);
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let mut spoilt = template.clone();
        spoilt.pebbles[0].centre.y = bad;
        add(&spoilt, UnitQuaternion::identity(), 2700.0);
    }
    for pebbles in [vec![], vec![pebble(0.0); 70_000]] {
        add(&Template { pebbles, ..template.clone() }, UnitQuaternion::identity(), 2700.0);
    }
    let turned = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 0.0));
    add(&template, turned, 2700.0);
    let turned = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0, 1.0, 0.0, 0.0));
    add(&template, turned, 2700.0);
}

#[test]
fn laws_that_cannot_be_are_told() {
    let with = |law: ContactLaw| fault(|bed| bed.change_laws(|l| *l = law));
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        with(ContactLaw::Linear(Linear { normal_stiffness: bad, ..law() }));
        with(ContactLaw::Linear(Linear { shear_stiffness: bad, ..law() }));
        with(ContactLaw::Linear(Linear { friction: bad, ..law() }));
        with(ContactLaw::HertzMindlin(HertzMindlin::between((1e9, 0.2), (1e9, 0.2), bad, 0.9)));
        with(ContactLaw::HertzMindlin(HertzMindlin::between((1e9, 0.2), (1e9, 0.2), 0.5, bad)));
    }
    let rigid = (f64::INFINITY, 0.2);
    let told = with(ContactLaw::HertzMindlin(HertzMindlin::between(rigid, rigid, 0.5, 0.9)));
    assert_eq!((told.of, told.quantity), (Subject::ContactLaw(0, 0), "effective modulus"));
    with(ContactLaw::HertzMindlin(HertzMindlin::between((1e9, 0.2), (1e9, 0.2), 0.5, 0.0)));
}

#[test]
fn walls_that_cannot_be_are_told() {
    let add = |shape: Shape, pose: Pose, motion: WallMotion| {
        fault(|bed| {
            bed.add_wall(shape, pose, 0, motion);
        })
    };
    let floor = || Shape::Plane { normal: Vector3::z() };
    for bad in BAD {
        add(Shape::Plane { normal: Vector3::z() * (2.0 * bad) }, Pose::default(), WallMotion::Fixed);
        add(Shape::Block { half: Vector3::new(1.0, bad, 1.0) }, Pose::default(), WallMotion::Fixed);
    }
    for bad in [f64::NAN, f64::INFINITY] {
        add(floor(), Pose { position: Vector3::repeat(bad), ..Pose::default() }, WallMotion::Fixed);
        add(floor(), Pose { orientation: [bad, 0.0, 0.0, 0.0], ..Pose::default() }, WallMotion::Fixed);
        let linear = Vector3::repeat(bad);
        add(floor(), Pose::default(), WallMotion::Velocity { linear, angular: Vector3::zeros() });
        add(floor(), Pose::default(), WallMotion::servo(Vector3::z(), bad, 1.0));
    }
    add(floor(), Pose::default(), WallMotion::Table { times: vec![], velocities: vec![] });
    add(floor(), Pose::default(), WallMotion::Table { times: vec![0.0, 1.0], velocities: vec![Vector3::zeros()] });
    let told = fault(|bed| {
        bed.add_wall(floor(), Pose::default(), 7, WallMotion::Fixed);
    });
    assert!(matches!(told.of, Subject::Wall(id) if id.0 == 1) && told.value == 7.0, "{told}");
}

#[test]
fn settings_that_cannot_be_are_told() {
    for bad in [f64::NAN, f64::INFINITY, -1e-5] {
        assert_eq!(fault(|bed| bed.set_time_step(bad)).quantity, "time step");
        fault(|bed| bed.set_damping(bad));
        fault(|bed| bed.set_gravity(Gravity::Constant([0.0, 0.0, bad / 0.0])));
        fault(|bed| bed.set_limits(Limits { overlap: bad.min(-1.0), ..Limits::default() }));
    }
    fault(|bed| bed.set_damping(1.0));
    fault(|bed| bed.set_gravity(Gravity::Table { times: vec![], values: vec![] }));
    fault(|bed| bed.set_gravity(Gravity::Table { times: vec![0.0, 0.0], values: vec![[0.0; 3]; 2] }));
    fault(|bed| bed.set_gravity(Gravity::Table { times: vec![0.0, 1.0], values: vec![[0.0; 3]] }));
    fault(|bed| bed.set_limits(Limits { every: 0, ..Limits::default() }));
    let mut bed = Bed::<f32>::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law())));
    assert_eq!(bed.step(), Err(Failure::NoTimeStep));
}

#[test]
fn domains_that_cannot_be_are_told() {
    let step = |domain: Domain| {
        let mut bed = Bed::<f64>::new(domain, ContactLaws::single(ContactLaw::Linear(law())));
        bed.add_sphere(&ball());
        bed.set_time_step(1e-5);
        bed.step()
    };
    for bad in BAD {
        for axis in 0..3 {
            assert!(matches!(step(Domain::open().periodic(axis, bad)), Err(Failure::Fault(_))));
        }
        assert!(matches!(step(Domain::open().bays(bad)), Err(Failure::Fault(_))));
    }
    assert!(matches!(step(Domain::open().periodic_bays(1.0, 0)), Err(Failure::Fault(_))));
    // shorter than the body
    assert!(matches!(step(Domain::open().periodic(1, 0.039)), Err(Failure::Fault(_))));
    assert_eq!(step(Domain::open().periodic(1, 0.041)), Ok(()));
}

#[test]
fn a_period_that_is_too_short_for_two_is_told() {
    let step = |period: f64| {
        let mut bed =
            Bed::<f64>::new(Domain::open().periodic(1, period), ContactLaws::single(ContactLaw::Linear(law())));
        bed.add_sphere(&ball());
        bed.add_sphere(&Sphere { centre: [0.1, 0.2 + 0.039, 0.3], ..ball() });
        bed.set_time_step(1e-5);
        bed.step()
    };
    // they would touch on both sides, and a contact knows one
    assert_eq!(step(0.078), Err(Failure::CellTooSmall));
    assert_eq!(step(0.12), Ok(()));
}

#[test]
fn a_bed_mended_goes_on() {
    let mut bed = sound();
    bed.set_time_step(f64::NAN);
    assert!(bed.step().is_err());
    bed.set_time_step(1e-5);
    assert_eq!(bed.step(), Ok(()));
    // no bodies, no walls: nothing moves, and time goes on
    let mut bed = Bed::<f64>::new(Domain::open(), ContactLaws::single(ContactLaw::Linear(law())));
    bed.set_time_step(0.5);
    assert_eq!(bed.run(4), Ok(()));
    assert_eq!(bed.time(), 2.0);
}
