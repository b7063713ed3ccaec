//! Porosity of lattices, parts that add up to the whole, coordination and stress in closed form.

use super::*;
use crate::solvers::granular::clump::{Pebble, Template};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Porosity of a lattice of spheres (m) in one cell for any start of the cell: spheres at `sites` and their images.
fn lattice(cell: [f64; 3], sites: &[[f64; 3]], radius: f64, start: [f64; 3]) -> f64 {
    let region = Region::block(start, std::array::from_fn(|k| start[k] + cell[k])).unwrap();
    let images = (0..125).map(|n| [n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2]);
    let spheres = images.flat_map(|image| {
        sites.iter().map(move |site| (std::array::from_fn(|k| site[k] + f64::from(image[k]) * cell[k]), radius))
    });
    region.porosity(spheres.map(|s| region.share_of_sphere(s)))
}

#[test]
fn lattices_have_the_porosity_of_the_books() {
    let root = f64::sqrt;
    let cubic = [[0.0; 3]];
    let body = [[0.0; 3], [0.5; 3]];
    let face = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    let (wide, high) = (root(3.0), root(8.0 / 3.0));
    let hexagonal =
        [[0.0; 3], [0.5, 0.5 * wide, 0.0], [0.5, wide / 6.0, 0.5 * high], [0.0, wide * 2.0 / 3.0, 0.5 * high]];
    let densest = 1.0 - PI / root(18.0);
    for start in [[0.0; 3], [0.31, -0.17, 0.44], [-0.5, -0.5, -0.25]] {
        let simple = lattice([1.0; 3], &cubic, 0.5, start);
        assert!((simple - (1.0 - PI / 6.0)).abs() < 1e-14 && (simple - 0.4764).abs() < 5e-5);
        let error = lattice([1.0; 3], &body, 0.25 * wide, start) - (1.0 - PI * wide / 8.0);
        assert!(error.abs() < 1e-14, "{error}");
        let error = lattice([1.0; 3], &face, root(0.125), start) - densest;
        assert!(error.abs() < 1e-14, "{error}");
        let close = lattice([1.0, wide, high], &hexagonal, 0.5, start);
        assert!((close - densest).abs() < 1e-14 && (close - 0.2595).abs() < 5e-5);
    }
}

#[test]
fn a_large_measurement_sphere_sees_the_lattice() {
    // The remaining error is the count of spheres at the border: it decreases with the radius to the power of about -2.
    let region = Region::sphere([0.1, 0.2, 0.3], 12.0).unwrap();
    let places = (0..27 * 27 * 27).map(|n| [n % 27 - 13, n / 27 % 27 - 13, n / 729 - 13]);
    let shares = places.map(|p| region.share_of_sphere((p.map(f64::from), 0.5)));
    assert!((region.porosity(shares) - (1.0 - PI / 6.0)).abs() < 1e-3);
}

#[test]
fn a_lens_is_its_two_caps() {
    let region = Region::sphere([0.0; 3], 1.3).unwrap();
    for (distance, radius) in [(1.0_f64, 0.8_f64), (1.9, 0.7), (0.61, 0.7), (1.0, 1.2)] {
        let plane = (1.3 * 1.3 - radius * radius + distance * distance) / (2.0 * distance);
        let cap = |r: f64, height: f64| PI * height * height * (r - height / 3.0);
        let lens = cap(1.3, 1.3 - plane) + cap(radius, radius - (distance - plane));
        let found = region.share_of_sphere(([0.6 * distance, 0.0, -0.8 * distance], radius));
        assert!((found - lens).abs() < 1e-14, "{found} {lens}");
    }
    let whole = 4.0 / 3.0 * PI;
    assert_eq!(region.share_of_sphere(([0.0, 0.3, 0.0], 1.0)), whole);
    assert_eq!(region.share_of_sphere(([0.0, 2.3, 0.0], 1.0)), 0.0);
    assert_eq!(region.share_of_sphere(([0.0, 0.1, 0.0], 9.0)), region.volume());
}

/// The boxes between cuts along every axis, the outermost far away.
fn boxes(cuts: &[[f64; 2]; 3]) -> Vec<Region> {
    let edges = cuts.map(|[a, b]| [-50.0, a.min(b), a.max(b) + 1e-3, 50.0]);
    let corner = |cell: [usize; 3]| std::array::from_fn(|k| edges[k][cell[k]]);
    let cells = (0..27).map(|n| [n % 3, n / 3 % 3, n / 9]);
    cells.map(|cell| Region::block(corner(cell), corner(cell.map(|c| c + 1))).unwrap()).collect()
}

fn cuts() -> impl Strategy<Value = [[f64; 2]; 3]> {
    prop::array::uniform3(prop::array::uniform2(-1.5..1.5f64))
}

/// A clump of three pebbles with a common part, and its volume.
fn clump(shift: [f64; 3]) -> (Vec<Ball>, f64) {
    let balls = [([0.0, 0.0, 0.0], 1.0), ([0.8, 0.3, -0.1], 0.8), ([0.2, 0.7, 0.4], 0.9)];
    let pebbles = balls.map(|(c, radius)| Pebble { centre: Vector3::from(c), radius });
    let moved = balls.map(|(c, r)| (std::array::from_fn(|k| c[k] + shift[k]), r));
    (moved.to_vec(), Template::from_pebbles(&pebbles).unwrap().volume)
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.2..1.2f64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn pieces_of_a_sphere_add_up(cuts in cuts(), centre in place(), radius in 0.2..2.0f64) {
        let total: f64 = boxes(&cuts).iter().map(|b| b.share_of_sphere((centre, radius))).sum();
        let whole = 4.0 / 3.0 * PI * radius.powi(3);
        prop_assert!((total - whole).abs() < 1e-13 * whole, "{}", total / whole - 1.0);
    }

    #[test]
    fn the_closed_form_of_a_sphere_is_its_integral(cuts in cuts(), centre in place(), radius in 0.2..2.0f64) {
        for region in boxes(&cuts) {
            let integral = clump::union_in(&region.0, &[(centre, radius)]);
            let error = (region.share_of_sphere((centre, radius)) - integral).abs() / radius.powi(3);
            prop_assert!(error < 1e-10, "{error}");
        }
        let region = Region::sphere([0.3, 0.2, 0.1], 1.0).unwrap();
        let integral = clump::union_in(&region.0, &[(centre, radius)]);
        let error = (region.share_of_sphere((centre, radius)) - integral).abs() / radius.powi(3);
        prop_assert!(error < 1e-10, "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn pieces_of_a_clump_add_up(cuts in cuts(), shift in place()) {
        let (pebbles, volume) = clump(shift);
        let total: f64 = boxes(&cuts).iter().map(|b| b.share_of_clump(&pebbles, volume)).sum();
        // a cut that nearly touches a pebble causes an error of 1e-9 in its quadrature
        prop_assert!((total - volume).abs() < 1e-8 * volume, "{}", total - volume);
    }

    /// The volume of clump and region together follows from the template of all balls.
    #[test]
    fn a_clump_in_a_measurement_sphere_is_what_the_union_lacks(shift in place(), radius in 0.9..3.0f64) {
        let (pebbles, volume) = clump(shift);
        let region = Region::sphere([0.0; 3], radius).unwrap();
        let mut all: Vec<_> = pebbles.iter().map(|(c, r)| Pebble { centre: Vector3::from(*c), radius: *r }).collect();
        all.push(Pebble { centre: Vector3::zeros(), radius });
        if let Ok(together) = Template::from_pebbles(&all) {
            let expected = volume + region.volume() - together.volume;
            prop_assert!((region.share_of_clump(&pebbles, volume) - expected).abs() < 1e-9);
        }
    }
}

#[test]
fn a_clump_inside_is_whole_and_one_outside_is_nothing() {
    let (pebbles, volume) = clump([0.0; 3]);
    for region in [Region::sphere([0.0; 3], 3.0), Region::block([-3.0; 3], [3.0; 3])] {
        let region = region.unwrap();
        assert_eq!(region.share_of_clump(&pebbles, volume), volume);
        assert!((clump::union_in(&region.0, &pebbles) - volume).abs() < 1e-9);
        let (away, volume) = clump([9.0, 0.0, 0.0]);
        assert_eq!(region.share_of_clump(&away, volume), 0.0);
        assert!(clump::union_in(&region.0, &away).abs() < 1e-9);
    }
    // A region inside a clump is full.
    for region in [Region::sphere([0.3, 0.3, 0.0], 0.2), Region::block([0.1; 3], [0.4; 3])] {
        let region = region.unwrap();
        assert!(region.porosity([region.share_of_clump(&pebbles, volume)]).abs() < 1e-8);
    }
}

#[test]
fn symmetry_planes_cut_a_clump_in_equal_parts() {
    let pebbles = [([-0.4, 0.0, 0.0], 0.5), ([0.4, 0.0, 0.0], 0.5), ([0.0, 0.0, 0.0], 0.6)];
    let whole = pebbles.map(|(c, radius)| Pebble { centre: Vector3::from(c), radius });
    let volume = Template::from_pebbles(&whole).unwrap().volume;
    for octant in boxes(&[[0.0, 9.0]; 3]).into_iter().filter(|b| b.share_of_sphere(pebbles[2]) > 0.0) {
        let error = octant.share_of_clump(&pebbles, volume) - volume / 8.0;
        assert!(error.abs() < 1e-11, "{error}");
    }
    // Borders that touch a pebble, or have the same centre.
    let region = Region::sphere([0.4, 0.0, 0.0], 0.5).unwrap();
    assert!((region.share_of_clump(&pebbles, volume) - region.volume()).abs() < 1e-11);
    let region = Region::block([-0.9, -2.0, -2.0], [0.9, 2.0, 2.0]).unwrap();
    assert!((clump::union_in(&region.0, &pebbles) - volume).abs() < 1e-11);
}

#[test]
fn a_body_that_is_nowhere_gives_no_number() {
    let region = Region::block([-1.0; 3], [1.0; 3]).unwrap();
    let lost = ([f64::NAN, 0.0, 0.0], 1.0);
    assert!(region.share_of_sphere(lost).is_nan());
    assert!(region.share_of_clump(&[lost, ([0.5, 0.0, 0.0], 1.0)], 5.0).is_nan());
}

#[test]
fn regions_without_volume_are_refused() {
    assert_eq!(Region::block([0.0; 3], [1.0, 0.0, 1.0]), Err(NoRegion));
    assert_eq!(Region::block([0.0; 3], [1.0, f64::NAN, 1.0]), Err(NoRegion));
    assert_eq!(Region::block([0.0; 3], [1.0, f64::INFINITY, 1.0]), Err(NoRegion));
    assert_eq!(Region::sphere([0.0; 3], 0.0), Err(NoRegion));
    assert_eq!(Region::sphere([f64::NAN, 0.0, 0.0], 1.0), Err(NoRegion));
}

#[test]
fn a_cubic_lattice_has_six_neighbours_a_sphere() {
    let index = |p: [u32; 3]| p[0] % 4 + 4 * (p[1] % 4) + 16 * (p[2] % 4);
    let sites = (0..64).map(|n| [n % 4, n / 4 % 4, n / 16]);
    let pairs = sites.flat_map(|p| (0..3).map(move |k| (p, k))).map(|(p, k)| {
        let mut next = p;
        next[k] += 1;
        (index(p), index(next))
    });
    let found = coordination(64, &pairs.collect::<Vec<_>>());
    assert_eq!(found, Coordination { mean: 6.0, without_rattlers: 6.0, rattlers: 0, pairs: 192 });
}

#[test]
fn pebbles_that_touch_twice_are_one_pair_and_loose_bodies_are_rattlers() {
    // A triangle, one body that leans on it, one without contacts; 9 is a wall.
    let pairs = [(0, 1), (1, 2), (2, 0), (0, 2), (2, 0), (3, 1), (3, 3), (4, 9)];
    let found = coordination(5, &pairs);
    assert_eq!(found, Coordination { mean: 8.0 / 5.0, without_rattlers: 7.0 / 3.0, rattlers: 2, pairs: 4 });
    assert_eq!(coordination(0, &[]).mean, 0.0);
}

#[test]
fn a_column_carries_the_mean_of_its_weight() {
    let (count, radius, weight, area) = (7, 0.5, 3.0, 4.0);
    let contact = |k: usize| {
        let arm = if k == 0 { radius } else { 2.0 * radius };
        let force = [0.0, 0.0, weight * (count - k) as f64];
        Contact { force, branch: [0.0, 0.0, arm], point: [0.0, 0.0, 2.0 * radius * k as f64] }
    };
    let height = 2.0 * radius * count as f64;
    let region = Region::block([-1.0, -1.0, 0.0], [1.0, 1.0, height]).unwrap();
    let expected = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, -0.5 * count as f64 * weight / area));
    assert!((stress(&region, (0..count).map(contact)) - expected).norm() < 1e-14);
    // Over the column and an equal empty volume it is half of this.
    let region = Region::block([-1.0, -1.0, 0.0], [1.0, 1.0, 2.0 * height]).unwrap();
    assert!((stress(&region, (0..count).map(contact)) - expected * 0.5).norm() < 1e-14);
}

/// Contacts of a lattice in which all spheres press on their neighbours with the force (N); one half of every pair, as
/// seen from i.
fn pressed(sites: &[[f64; 3]], neighbours: &[[f64; 3]], force: f64) -> Vec<Contact> {
    let images = (0..125).map(|n| [n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2].map(f64::from));
    let centres = images.flat_map(|i| sites.iter().map(move |s| Vector3::from(*s) + Vector3::from(i)));
    let contacts = centres.flat_map(|centre| {
        neighbours.iter().map(move |n| {
            let branch = -Vector3::from(*n);
            let point = centre - 0.5 * branch;
            Contact { force: (branch.normalize() * force).into(), branch: branch.into(), point: point.into() }
        })
    });
    contacts.collect()
}

#[test]
fn a_pressed_lattice_has_the_pressure_of_the_closed_form() {
    let region = Region::block([0.01; 3], [1.01; 3]).unwrap();
    // Simple cubic, r = 1/2: one contact across every face of the cell, p = F/(4 r²).
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let found = stress(&region, pressed(&[[0.0; 3]], &axes, 5.0));
    assert!((found + Matrix3::identity() * 5.0).norm() < 1e-14);
    // Face-centred, r = 1/√8: p = F/(√2 r²) = 8 F/√2.
    let sites = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    let half =
        [[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5], [0.0, 0.5, 0.5], [0.0, 0.5, -0.5]];
    let found = stress(&region, pressed(&sites, &half, 5.0));
    assert!((found + Matrix3::identity() * (8.0 * 5.0 / 2.0_f64.sqrt())).norm() < 1e-13);
}

/// Directions distributed evenly over the sphere, by the golden angle.
fn even(count: u32) -> impl Iterator<Item = [f64; 3]> + Clone {
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (angle, across) = (PI * (3.0 - 5.0_f64.sqrt()) * f64::from(k), (1.0 - z * z).sqrt());
        [across * angle.cos(), across * angle.sin(), z]
    })
}

#[test]
fn even_directions_have_no_fabric_and_lattices_have_theirs() {
    let found = Fabric::from_normals(even(20_000));
    assert!(found.deviator() < 1e-4 && found.contacts == 20_000, "{}", found.deviator());
    let rose = Rose::from_normals(even(20_000));
    for density in rose.inclination.iter().chain(&rose.along).chain(&rose.across) {
        assert!((density - 1.0).abs() < 0.02, "{rose:?}");
    }
    // simple cubic and face-centred lattices are isotropic to second order, a column is all in one direction
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert!(Fabric::from_normals(axes).deviator() < 1e-15);
    let h = 0.5_f64.sqrt();
    let close = [[h, h, 0.0], [h, -h, 0.0], [h, 0.0, h], [h, 0.0, -h], [0.0, h, h], [0.0, h, -h]];
    assert!(Fabric::from_normals(close).deviator() < 1e-15);
    let column = Fabric::from_normals([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
    assert!((column.deviator() - 1.0).abs() < 1e-15 && (column.anisotropy() - 7.5).abs() < 1e-14);
    assert_eq!(Rose::from_normals([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]).inclination[1..], [0.0; 8]);
    assert_eq!((Fabric::from_normals([]).contacts, Fabric::from_normals([]).deviator()), (0, 0.0));
}

#[test]
fn a_known_anisotropy_is_found_again() {
    // density (1 + a (3 cos² θ - 1)/2)/(4π): the fabric's deviator is a/5
    let amplitude = 0.6;
    let weight = |z: f64| 1.0 + amplitude * 0.5 * (3.0 * z * z - 1.0);
    // a direction as often as its weight
    let normals = even(4000).flat_map(|n| std::iter::repeat_n(n, (50.0 * weight(n[2])).round() as usize));
    let found = Fabric::from_normals(normals);
    assert!((found.deviator() / (amplitude / 5.0) - 1.0).abs() < 5e-3, "{}", found.deviator());
    assert!((found.anisotropy() / (1.5 * amplitude) - 1.0).abs() < 5e-3, "{}", found.anisotropy());
}

#[test]
fn exponential_forces_are_known_as_such() {
    // quantiles of an exponential distribution of mean 7 N, each with half of its friction used
    let count = 100_000;
    let force = |k: i32| -7.0 * (1.0 - (f64::from(k) + 0.5) / f64::from(count)).ln();
    let pushes = (0..count).map(|k| ContactPush { normal: force(k), shear: 0.25 * force(k), friction: 0.5 });
    let found = ForceSpread::from_pushes(pushes);
    assert!((found.mean / 7.0 - 1.0).abs() < 1e-4, "{}", found.mean);
    assert!((found.decay.unwrap() - 1.0).abs() < 1e-3, "{:?}", found.decay);
    let e = 1.0_f64.exp();
    assert!((found.above - 1.0 / e).abs() < 1e-4 && (found.carried - 2.0 / e).abs() < 1e-3, "{found:?}");
    assert!((found.mobilised.unwrap() - 0.5).abs() < 1e-12 && found.sliding == Some(0.0));
    for [force, density] in found.density.iter().filter(|[force, _]| *force < 5.0) {
        // a bin holds the mean of exp(-f): sinh(w/2)/(w/2) times its middle
        let mean = (-force).exp() * (0.125_f64.sinh() / 0.125);
        assert!((density / mean - 1.0).abs() < 0.01, "{force}: {density} and {mean}");
    }
    let area: f64 = found.density.iter().map(|[_, density]| 0.25 * density).sum();
    assert!((area - 1.0).abs() < 1e-12, "{area}");
}

#[test]
fn contacts_at_their_friction_slide_and_equal_forces_have_no_tail() {
    let at = |shear: f64, friction: f64| ContactPush { normal: 2.0, shear, friction };
    let found = ForceSpread::from_pushes([at(1.0, 0.5), at(0.5, 0.5), at(0.0, 0.5), at(0.0, 0.0)]);
    assert_eq!((found.sliding, found.mobilised), (Some(1.0 / 3.0), Some(0.5)));
    assert_eq!((found.decay, found.above, found.largest), (None, 0.0, 1.0));
    let smooth = ForceSpread::from_pushes([at(0.0, 0.0)]);
    assert_eq!((smooth.sliding, smooth.mobilised), (None, None));
    assert_eq!(ForceSpread::from_pushes([]), ForceSpread::default());
}

proptest! {
    #[test]
    fn pieces_of_a_line_add_up(cuts in cuts(), from in place(), to in place()) {
        let total: f64 = boxes(&cuts).iter().map(|b| b.share_of_line(&from, &to)).sum();
        prop_assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
}

#[test]
fn a_line_through_a_sphere_is_its_chord() {
    let region = Region::sphere([1.0, 0.0, 0.0], 0.5).unwrap();
    let chord = region.share_of_line(&[1.0, 0.3, -2.0], &[1.0, 0.3, 2.0]);
    assert!((chord - 0.8 / 4.0).abs() < 1e-15, "{chord}");
    assert_eq!(region.share_of_line(&[1.0, 0.6, -2.0], &[1.0, 0.6, 2.0]), 0.0);
    assert!((region.share_of_line(&[1.0, 0.0, 0.0], &[2.0, 0.0, 0.0]) - 0.5).abs() < 1e-15);
}
