//! Every problem that is checked for occurs once.

use super::{Finding, Other};
use crate::solvers::granular::shape::{Mesh, MeshKind, Shape};
use crate::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Linear, Pose, Sphere, WallId,
    WallMotion,
};
use nalgebra::Vector3;

fn law() -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: 1e6,
        shear_stiffness: 1e6,
        friction: 0.5,
        dashpot: Dashpot::Ratio { normal: 0.3, shear: 0.0 },
        mode: DashpotMode::default(),
        limit: FrictionLimit::Spring,
    })
}

fn bed(domain: Domain) -> Bed<f64> {
    let mut bed = Bed::new(domain, ContactLaws::uniform(2, law()));
    bed.set_time_step(1e-6);
    bed
}

fn ball(x: f64, y: f64, z: f64) -> Sphere {
    Sphere { centre: [x, y, z], radius: 0.01, density: 2700.0, surface: 0 }
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { position: Vector3::new(x, y, z), ..Pose::default() }
}

#[track_caller]
fn says(finding: &Finding, parts: &[&str]) {
    let text = finding.to_string();
    parts.iter().for_each(|part| assert!(text.contains(part), "no `{part}` in: {text}"));
}

#[test]
fn a_sound_bed_has_no_findings() {
    let mut bed = bed(Domain::open().periodic(0, 0.2));
    bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 1);
    for k in 0..5 {
        bed.add_sphere(&ball(0.02 * f64::from(k), 0.0, 0.01));
    }
    assert_eq!(bed.inspect(0.01), []);
}

#[test]
fn overlaps_are_counted_and_the_worst_is_named() {
    let mut bed = bed(Domain::open().periodic(0, 0.2));
    for x in [0.0, 0.019, 0.036, 0.1, 0.1199, 0.199] {
        bed.add_sphere(&ball(x, 0.0, 0.0));
    }
    let found = bed.inspect(0.05);
    let [finding @ Finding::Overlaps { count: 3, share, overlap, .. }] = &found[..] else { panic!("{found:?}") };
    assert!((share - 1.9).abs() < 1e-9 && (overlap - 0.019).abs() < 1e-12, "across the period");
    says(finding, &["3 contacts", "body 0", "body 5", "1.900e-2 m", "1.900 of", "move them apart"]);
    // walls are checked, too
    let mut bed = self::bed(Domain::open());
    bed.add_plane([0.0, 0.0, 0.004], [0.0, 0.0, 1.0], 1);
    bed.add_sphere(&ball(0.0, 0.0, 0.01));
    let found = bed.inspect(0.05);
    let [Finding::Overlaps { other, share, .. }] = &found[..] else { panic!("{found:?}") };
    assert_eq!(*other, Other::Wall(WallId(0)));
    assert!((share - 0.4).abs() < 1e-12);
}

#[test]
fn bodies_in_walls_are_found() {
    let container = |bed: &mut Bed<f64>| {
        let v = |k: usize| Vector3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
        let vertices: Vec<_> = (0..8).map(v).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let inward: Vec<[u32; 3]> = quads.iter().flat_map(|q| [[q[0], q[2], q[1]], [q[0], q[3], q[2]]]).collect();
        let mesh = Mesh::new(vertices, inward, MeshKind::Container).unwrap();
        bed.add_wall(Shape::Mesh(mesh), Pose::default(), 1, WallMotion::Fixed)
    };
    type Put<'a> = &'a dyn Fn(&mut Bed<f64>) -> WallId;
    let walls: [Put; 3] = [
        &|bed| bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 1),
        &|bed| bed.add_wall(Shape::block(Vector3::repeat(0.5)).unwrap(), at(0.5, 0.5, -0.5), 1, WallMotion::Fixed),
        &container,
    ];
    for put in walls {
        let mut bed = bed(Domain::open());
        put(&mut bed);
        bed.add_sphere(&ball(0.5, 0.5, 0.3));
        bed.add_sphere(&ball(0.2, 0.2, -0.3));
        bed.add_sphere(&ball(0.7, 0.7, -0.3));
        let found = bed.inspect(1e3);
        let Some(finding @ Finding::Outside { count: 2, body: BodyId(1), .. }) = found.first() else {
            panic!("{found:?}")
        };
        says(finding, &["2 bodies", "wall 0", "body 1 at (0.2000, 0.2000, -0.3000) m", "move them out"]);
    }
}

#[test]
fn walls_and_grains_must_fit_their_periods() {
    let mut bed = bed(Domain::open().periodic(0, 0.2).periodic(1, 0.055));
    bed.add_wall(Shape::block(Vector3::new(0.06, 0.01, 0.01)).unwrap(), at(0.1, 0.02, -0.02), 1, WallMotion::Fixed);
    bed.add_plane([0.0, 0.0, -1.0], [0.1, 0.0, 0.99f64.sqrt()], 1);
    bed.add_sphere(&ball(0.0, 0.0, 0.1));
    let found = bed.inspect(0.05);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(matches!(found[0], Finding::WideWall { wall: WallId(0), axis: 0, .. }), "{found:?}");
    says(&found[0], &["0.1200 m long along x", "period of 0.2000 m", "use a plane"]);
    assert!(matches!(found[1], Finding::LeaningPlane { wall: WallId(1), axis: 0, .. }), "{found:?}");
    says(&found[1], &["plane 1 leans along the periodic x", "1.000e-1"]);
    assert!(matches!(found[2], Finding::LargeGrain { body: BodyId(0), axis: 1, .. }), "{found:?}");
    says(&found[2], &["diameter 0.0200 m", "a third of the cell of 0.0550 m along y"]);
}

#[test]
fn a_step_above_the_limit_is_found() {
    let mut bed = bed(Domain::open());
    bed.add_sphere(&ball(0.0, 0.0, 0.0));
    bed.add_sphere(&ball(0.0199999, 0.0, 0.0));
    let limit = bed.critical_step(0.0).unwrap().network.step;
    bed.set_time_step(1.01 * limit);
    let found = bed.inspect(0.05);
    assert!(matches!(found[..], [Finding::Step { body: Some(_), .. }]), "{found:?}");
    says(&found[0], &["is above the limit of", "take ", "scale masses"]);
    let mut bed = Bed::<f64>::new(Domain::open(), ContactLaws::uniform(1, law()));
    bed.add_sphere(&ball(0.0, 0.0, 0.0));
    assert_eq!(bed.inspect(0.05), [Finding::NoStep]);
}

#[test]
fn numbers_that_cannot_be_are_told_first() {
    assert_eq!(bed(Domain::open()).inspect(0.05), [Finding::Empty]);
    let mut bed = bed(Domain::open());
    bed.add_sphere(&ball(0.0, 0.0, f64::NAN));
    bed.add_sphere(&Sphere { density: -1.0, ..ball(0.0, 0.0, 0.0) });
    bed.add_wall(Shape::Block { half: Vector3::new(0.1, -0.1, 0.1) }, Pose::default(), 1, WallMotion::Fixed);
    bed.change_laws(|law| {
        if let ContactLaw::Linear(law) = law {
            law.normal_stiffness = 0.0;
        }
    });
    let found = bed.inspect(0.05);
    assert!(matches!(found[0], Finding::ContactLaw { surfaces: [0, 0], .. }), "{found:?}");
    assert!(matches!(found[1], Finding::ContactLaw { surfaces: [0, 1], .. }), "{found:?}");
    assert!(matches!(found[2], Finding::Shape { wall: WallId(0), .. }), "{found:?}");
    assert!(matches!(found[3], Finding::Body { body: BodyId(0), quantity: "place", .. }), "{found:?}");
    assert!(matches!(found[4], Finding::Body { body: BodyId(1), quantity: "mass", .. }), "{found:?}");
    assert_eq!(found.len(), 5, "{found:?}");
    says(&found[0], &["law between surfaces 0 and 0: normal stiffness is 0, expected a number above 0"]);
}
