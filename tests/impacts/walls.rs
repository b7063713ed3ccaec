//! Walls through a bed: floors, edges, corners, containers, plates that move and plates that are told a force.

use crate::scene::{bed, damped, mass, near, norm, put, sphere, springs};
use nalgebra::Vector3;
use trackbed::solvers::granular::shape::{Mesh, MeshKind, Shape};
use trackbed::solvers::granular::{Bed, ContactLaw, ContactLaws, Domain, Gravity, Pose, Sphere, WallId, WallMotion};

type V = Vector3<f64>;

const RADIUS: f64 = 0.02;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { position: V::new(x, y, z), ..Pose::default() }
}

fn ball(x: f64, y: f64, z: f64) -> Sphere {
    sphere([x, y, z], RADIUS, 2700.0)
}

/// A flat sheet of crooked triangles from -0.1 to 0.3 m.
fn sheet() -> Shape {
    const SIDE: u32 = 14;
    let vertex = |k: u32| {
        let (i, j) = (k % (SIDE + 1), k / (SIDE + 1));
        let inside = |c: u32| c > 0 && c < SIDE;
        let shift = if inside(i) && inside(j) { 0.006 * f64::from(k * 7 % 11) / 11.0 } else { 0.0 };
        V::new(
            -0.1 + 0.4 * f64::from(i) / f64::from(SIDE) + shift,
            -0.1 + 0.4 * f64::from(j) / f64::from(SIDE) - shift,
            0.0,
        )
    };
    let cell = |c: u32| {
        let (i, j) = (c % SIDE, c / SIDE);
        let k = i + j * (SIDE + 1);
        let [a, b, c, d] = [k, k + 1, k + SIDE + 2, k + SIDE + 1];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let vertices = (0..(SIDE + 1) * (SIDE + 1)).map(vertex).collect();
    let triangles = (0..SIDE * SIDE).flat_map(cell).collect();
    Shape::Mesh(Mesh::new(vertices, triangles, MeshKind::OneSided).unwrap())
}

#[test]
fn a_sphere_slides_over_triangles_as_over_a_plane() {
    let run = |floor: Shape| {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(damped(1e6, 0.4, 0.1)), 1e-5);
        bed.add_wall(floor, Pose::default(), 0, WallMotion::Fixed);
        bed.set_gravity(Gravity::EARTH);
        let id = put(&mut bed, ball(0.0, 0.0, RADIUS), [0.8, 0.5, 0.0], [0.0, 0.0, 3.0]);
        bed.run(30_000).unwrap();
        bed.body_state(id)
    };
    let (plane, mesh) = (run(Shape::Plane { normal: V::z() }), run(sheet()));
    let apart = norm(crate::scene::sub(plane.place, mesh.place));
    println!("triangles: {apart:.1e} m after {:.3} m", plane.place[0]);
    assert!(plane.place[0] > 0.15 && apart < 1e-11, "{apart}");
    let turned = norm(crate::scene::sub(plane.spin, mesh.spin));
    assert!(turned < 1e-8, "{turned}");
}

#[test]
fn a_sphere_rolls_off_an_edge_and_keeps_its_energy() {
    let (g, speed) = (9.81, 0.1);
    let run = |mesh: bool, dt: f64| {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 5.0)), dt);
        let half = V::new(0.1, 0.1, 0.1);
        let shape = if mesh { Shape::Mesh(Mesh::block(half).unwrap()) } else { Shape::block(half).unwrap() };
        bed.add_wall(shape, at(-0.1, 0.0, -0.1), 0, WallMotion::Fixed);
        bed.set_gravity(Gravity::EARTH);
        let sunk = mass(RADIUS, 2700.0) * g / 1e6;
        let start = ball(-0.002, 0.003, RADIUS - sunk);
        let id = put(&mut bed, start, [speed, 0.0, 0.0], [0.0, speed / RADIUS, 0.0]);
        bed.watch_energy(true);
        let (mut worst, mut angle): (f64, f64) = (0.0, 0.0);
        while bed.body_state(id).place[2] > -0.5 * RADIUS {
            bed.step().unwrap();
            if bed.walls()[0].felt().contacts > 0 {
                let [x, _, z] = bed.body_state(id).place;
                angle = x.atan2(z);
            }
            worst = worst.max(bed.energy().residual().abs() / bed.energy().start);
        }
        let turned = bed.body_state(id).spin;
        assert!(turned[0].abs() < 1e-9 && turned[2].abs() < 1e-9, "{turned:?}");
        (worst, angle, bed.body_state(id).place, bed.energy().slip / bed.energy().start)
    };
    let (worst, angle, place, slip) = run(false, 4e-6);
    // rolling about the edge until the push is gone: 10/17 + 7/17 v²/(g r)
    let leaves = ((10.0 + 7.0 * speed * speed / (g * RADIUS)) / 17.0).acos();
    println!("edge: energy {worst:.1e}, leaves at {angle:.4} for {leaves:.4} rad, slip {slip:.1e}");
    assert!(worst < 1e-4, "{worst}");
    near(angle, leaves, 2e-2);
    let other = run(true, 4e-6).2;
    let apart = norm(crate::scene::sub(place, other));
    println!("edge: block and mesh differ by {apart:.1e} m");
    assert!(apart < 1e-9);
}

#[test]
fn a_corner_throws_back_what_falls_straight_onto_it() {
    let law = damped(1e6, 0.5, 0.3);
    let half = V::new(0.1, 0.07, 0.05);
    for shape in [Shape::block(half).unwrap(), Shape::Mesh(Mesh::block(half).unwrap())] {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(law), 1e-7);
        bed.add_wall(shape, at(0.3, 0.2, 0.1), 0, WallMotion::Fixed);
        let out = V::new(0.6, 0.48, 0.64);
        let start = V::new(0.4, 0.27, 0.15) + RADIUS * out;
        let id = put(&mut bed, ball(start.x, start.y, start.z), (-out).into(), [0.0; 3]);
        bed.run(10_000).unwrap();
        let state = bed.body_state(id);
        let back = V::from(state.velocity);
        // a dashpot of ratio 0.3 that does not pull
        near(back.norm(), 0.450975, 1e-3);
        println!("corner: restitution {:.6}, aside {:.1e}", back.norm(), (back.normalize() - out).norm());
        assert!((back.normalize() - out).norm() < 1e-6 && norm(state.spin) < 1e-4);
    }
}

#[test]
fn a_container_keeps_a_bouncing_sphere_and_its_energy() {
    let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.0)), 2e-6);
    let half = V::new(0.05, 0.06, 0.07);
    let shape = Shape::Mesh(Mesh::block(half).unwrap().flipped());
    bed.add_wall(shape, Pose::default(), 0, WallMotion::Fixed);
    let id = put(&mut bed, ball(0.01, 0.0, 0.0), [3.0, 2.1, -1.7], [0.0; 3]);
    bed.watch_energy(true);
    let (mut bounces, mut before, mut worst): (_, _, f64) = (0, 0, 0.0);
    for _ in 0..200_000 {
        bed.step().unwrap();
        let now = bed.walls()[0].felt().contacts;
        bounces += usize::from(now > before);
        before = now;
        worst = worst.max(bed.energy().residual().abs() / bed.energy().start);
    }
    let place = V::from(bed.body_state(id).place);
    println!("container: {bounces} bounces, energy {worst:.1e}");
    assert!(bounces > 30 && place.abs().iter().zip(half.iter()).all(|(x, h)| *x < h - 0.9 * RADIUS));
    assert!(worst < 1e-4, "{worst}");
}

#[test]
fn a_moving_plate_gives_twice_its_speed_and_accounts_for_it() {
    let (speed, m) = (0.7, mass(RADIUS, 2700.0));
    let run = |dt: f64| {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(springs(1e6, 0.3)), dt);
        let motion = WallMotion::Velocity { linear: V::z() * speed, angular: V::zeros() };
        bed.add_wall(Shape::Plane { normal: V::z() }, Pose::default(), 0, motion);
        let id = bed.add_sphere(&ball(0.0, 0.0, RADIUS + 1e-4));
        bed.watch_energy(true);
        let mut impulse = 0.0;
        for _ in 0..(5e-3 / dt) as usize {
            bed.step().unwrap();
            impulse -= bed.walls()[0].felt().force.z * dt;
        }
        assert_eq!(bed.walls()[0].felt().contacts, 0);
        let energy = bed.energy();
        let thrown = bed.body_state(id).velocity[2];
        (
            thrown / (2.0 * speed) - 1.0,
            impulse / (2.0 * m * speed) - 1.0,
            energy.walls / (2.0 * m * speed * speed) - 1.0,
            energy.residual() / energy.walls,
        )
    };
    let (coarse, fine) = (run(4e-6), run(2e-6));
    println!("plate: {coarse:?} {fine:?}");
    for error in [fine.0, fine.1, fine.2, fine.3] {
        assert!(error.abs() < 1e-5, "{fine:?}");
    }
}

#[test]
fn a_floor_of_triangles_goes_on_round_a_period() {
    // the origin of its frame at a corner, at the middle, and somewhere
    let run = |shift: Option<V>| {
        let mut bed = Bed::<f64>::new(
            Domain::open().periodic(0, 0.4).periodic(1, 0.3),
            ContactLaws::single(ContactLaw::Linear(damped(1e6, 0.4, 0.1))),
        );
        let corners = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]];
        let shape = match shift {
            None => Shape::Plane { normal: V::z() },
            Some(shift) => {
                let vertices = corners.iter().map(|[x, y]| V::new(*x, *y, 0.0) - shift).collect();
                Shape::Mesh(Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]], MeshKind::OneSided).unwrap())
            }
        };
        let place = shift.unwrap_or_default();
        bed.add_wall(shape, at(place.x, place.y, place.z), 0, WallMotion::Fixed);
        bed.set_gravity(Gravity::EARTH);
        bed.set_time_step(1e-5);
        let id = put(&mut bed, ball(0.05, 0.02, RADIUS), [3.0, 2.0, 0.0], [0.0; 3]);
        bed.run(40_000).unwrap();
        bed.body_state(id).place
    };
    let plane = run(None);
    for shift in [V::zeros(), V::new(0.2, 0.15, 0.0), V::new(0.33, -0.07, 0.0)] {
        let apart = norm(crate::scene::sub(plane, run(Some(shift))));
        println!("round a period: {apart:.1e} m after {:.3} m", plane[0]);
        assert!(plane[0] > 0.8 && apart < 1e-9, "{apart} {shift:?}");
    }
}

/// 500 spheres in a periodic box, on a floor, under a plate above them.
fn heap() -> (Bed<f32>, WallId) {
    let domain = Domain::open().periodic(0, 0.3).periodic(1, 0.3);
    let mut bed = Bed::new(domain, ContactLaws::single(ContactLaw::Linear(damped(1e6, 0.0, 0.2))));
    let mut random = 1u64;
    let mut share = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1u64 << 53) as f64
    };
    for k in 0..500u32 {
        let (i, j, l) = (k % 7, k / 7 % 7, k / 49);
        let place = |n: u32, share: f64| (f64::from(n) + 0.5) * 0.3 / 7.0 + 1e-3 * (share - 0.5);
        let radius = 0.016 + 0.005 * share();
        let centre = [place(i, share()), place(j, share()), 0.0215 + 0.0425 * f64::from(l)];
        bed.add_sphere(&sphere(centre, radius, 2700.0));
    }
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
    let down = WallMotion::Velocity { linear: -V::z(), angular: V::zeros() };
    let plate = bed.add_wall(Shape::Plane { normal: -V::z() }, at(0.0, 0.0, 0.47), 0, down);
    bed.set_gravity(Gravity::EARTH);
    bed.set_damping(0.5);
    bed.set_time_step(4e-5);
    // 0.2 m down, pushing what has not fallen yet
    bed.run(5000).unwrap();
    (bed, plate)
}

#[test]
fn a_servo_presses_a_bed_holds_it_and_lets_it_go() {
    let (mut bed, plate) = heap();
    bed.change_laws(|law| {
        if let ContactLaw::Linear(law) = law {
            law.friction = 0.5;
        }
    });
    let area = 0.3 * 0.3;
    let mut heights = Vec::new();
    for pressure in [20e3, 40e3, 2e3] {
        let force = pressure * area;
        bed.set_motion(plate, WallMotion::servo(V::z(), force, 0.3));
        bed.run(6000).unwrap();
        let mut worst: f64 = 0.0;
        for _ in 0..500 {
            bed.step().unwrap();
            worst = worst.max((bed.wall(plate).felt().force.z / force - 1.0).abs());
        }
        println!("servo: {pressure} Pa held within {worst:.1e} at step {}", bed.steps());
        assert!(worst < 2e-3, "{worst} at {pressure} Pa");
        heights.push(bed.wall(plate).pose(bed.domain()).position.z);
    }
    println!("heights: {heights:?}");
    // pressed down by more, and back up by a part of it
    assert!(heights[1] < heights[0] && heights[1] < heights[2], "{heights:?}");
}

#[test]
fn a_shaken_floor_is_shaken_gravity() {
    let (frequency, share, g) = (20.0, 0.4, 9.81);
    let rate = std::f64::consts::TAU * frequency;
    let amplitude = share * g / (rate * rate);
    let run = |shaken_floor: bool, dt: f64| {
        let mut bed: Bed<f64> = bed(ContactLaw::Linear(damped(1e6, 0.5, 0.1)), dt);
        let (motion, gravity, start) = if shaken_floor {
            let motion = WallMotion::Harmonic { axis: V::z(), amplitude, frequency, phase: 0.0 };
            (motion, Gravity::EARTH, amplitude * rate)
        } else {
            // the floor's acceleration, - A w² sin, is taken off
            (WallMotion::Fixed, Gravity::Shaken { mean: [0.0, 0.0, -g], share: -share, frequency }, 0.0)
        };
        let floor = bed.add_wall(Shape::Plane { normal: V::z() }, Pose::default(), 0, motion);
        bed.set_gravity(gravity);
        for (x, z) in [(0.0, 0.02), (0.039, 0.02), (0.0195, 0.0548)] {
            put(&mut bed, ball(x, 0.0, z), [0.0, 0.0, start], [0.0; 3]);
        }
        bed.run((0.1 / dt).round() as u64).unwrap();
        let height = bed.wall(floor).pose(bed.domain()).position.z;
        bed.states().map(|s| V::from(s.place) - V::z() * height).collect::<Vec<_>>()
    };
    let errors = [2e-5, 1e-5].map(|dt| {
        let (floor, gravity) = (run(true, dt), run(false, dt));
        floor.iter().zip(&gravity).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    });
    println!("shaken floor against shaken gravity: {errors:?} m of an amplitude of {amplitude:.2e} m");
    assert!(errors[1] < 1e-4 * amplitude, "{errors:?}");
}
