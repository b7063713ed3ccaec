//! Mass properties of clumps against closed forms, voxel sums and invariances.

use super::*;
use nalgebra::{Matrix3, Rotation3};
use proptest::prelude::*;

fn pebble(x: f64, y: f64, z: f64, radius: f64) -> Pebble {
    Pebble { centre: Vector3::new(x, y, z), radius }
}

/// `∫ π s²(x) dx` and similar integrals of the cap of a ball from x = `from` to its pole at `radius`: volume, first
/// moment along x, second moments along and across x, all about the centre of the ball.
fn cap(radius: f64, from: f64) -> [f64; 4] {
    let r2 = radius * radius;
    let primitive = |x: f64| {
        let (x2, x3) = (x * x, x * x * x);
        [
            PI * (r2 * x - x3 / 3.0),
            PI * (0.5 * r2 * x2 - 0.25 * x2 * x2),
            PI * (r2 * x3 / 3.0 - x2 * x3 / 5.0),
            0.25 * PI * (r2 * r2 * x - 2.0 / 3.0 * r2 * x3 + x2 * x3 / 5.0),
        ]
    };
    let (end, start) = (primitive(radius), primitive(from));
    std::array::from_fn(|k| end[k] - start[k])
}

/// Two balls on the x axis, the first about the origin: volume, centroid, second moments along and across about the
/// centroid.
fn two_balls(r1: f64, r2: f64, distance: f64) -> [f64; 4] {
    let plane = (r1 * r1 - r2 * r2 + distance * distance) / (2.0 * distance);
    // Each ball up to the plane through the common circle; the first is seen from its far side.
    let left = cap(r1, -plane);
    let right = cap(r2, plane - distance);
    let volume = left[0] + right[0];
    let first = -left[1] + right[1] + distance * right[0];
    let along = left[2] + right[2] + 2.0 * distance * right[1] + distance * distance * right[0];
    let centroid = first / volume;
    [volume, centroid, along - volume * centroid * centroid, left[3] + right[3]]
}

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn two_spheres_have_their_closed_form() {
    for (r1, r2, distance) in
        [(1.0, 1.0, 1.147), (1.0, 0.8, 1.2), (0.02, 0.011, 0.0291), (1.0, 0.5, 0.501), (1.0, 1.0, 1e-3)]
    {
        let [volume, centroid, along, across] = two_balls(r1, r2, distance);
        for direction in [Vector3::x(), Vector3::z(), Vector3::new(1.0, -2.0, 0.5).normalize()] {
            let template = Template::from_pebbles(&[
                Pebble { centre: Vector3::zeros(), radius: r1 },
                Pebble { centre: direction * distance, radius: r2 },
            ])
            .unwrap();
            let axis = (0..3).min_by(|a, b| template.inertia[*a].total_cmp(&template.inertia[*b])).unwrap();
            let mut found =
                [template.inertia[axis], template.inertia[(axis + 1) % 3], template.inertia[(axis + 2) % 3]];
            found[1..].sort_by(f64::total_cmp);
            let worst = relative(template.volume, volume)
                .max((template.centroid - direction * centroid).norm() / r1)
                .max(relative(found[0], 2.0 * across))
                .max(relative(found[1], along + across))
                .max(relative(found[2], along + across));
            assert!(worst < 1e-12, "{r1} {r2} {distance}: {worst}");
        }
    }
}

/// Volume of the part of a unit ball on this side of two planes n·u = h that intersect in it. By Gauss's theorem from
/// the area of its round face, with the corners and the curvature of its rims by Gauss and Bonnet, and from its two
/// flat faces.
fn wedge(cosine: f64, heights: [f64; 2]) -> f64 {
    let sine = (1.0 - cosine * cosine).sqrt();
    let mut solid_angle = 4.0 * PI;
    let mut flat = 0.0;
    let mut lens = 2.0 * PI;
    let rims = heights.map(|h| (1.0 - h * h).sqrt());
    for (k, other) in [(0, 1), (1, 0)] {
        let (h, rim) = (heights[k], rims[k]);
        let chord = (heights[other] - h * cosine) / sine;
        let half = (chord / rim).acos();
        solid_angle -= 2.0 * PI * (1.0 - h);
        lens -= 2.0 * h * half;
        flat += h * (PI * rim * rim - (rim * rim * half - chord * (rim * rim - chord * chord).sqrt()));
    }
    lens -= 2.0 * ((cosine - heights[0] * heights[1]) / (rims[0] * rims[1])).acos();
    (solid_angle + lens + flat) / 3.0
}

/// Volume of the union of three balls with two points in common: each is cut by the planes through its common circles.
fn three_balls(pebbles: &[Pebble; 3]) -> f64 {
    let cell = |i: usize| {
        let own = &pebbles[i];
        let others = [&pebbles[(i + 1) % 3], &pebbles[(i + 2) % 3]];
        let apart = others.map(|o| o.centre - own.centre);
        let heights = [0, 1].map(|k| {
            let d = apart[k].norm();
            (own.radius.powi(2) - others[k].radius.powi(2) + d * d) / (2.0 * d * own.radius)
        });
        own.radius.powi(3) * wedge(apart[0].normalize().dot(&apart[1].normalize()), heights)
    };
    cell(0) + cell(1) + cell(2)
}

#[test]
fn three_spheres_have_their_closed_form() {
    let height = 0.75_f64.sqrt();
    for pebbles in [
        [pebble(0.0, 0.0, 0.0, 1.0), pebble(1.0, 0.0, 0.0, 1.0), pebble(0.5, height, 0.0, 1.0)],
        [pebble(0.1, 0.2, 0.3, 1.0), pebble(0.9, 0.1, 0.2, 0.8), pebble(0.4, 0.3, 0.9, 0.7)],
        [pebble(0.0, 0.0, 0.0, 0.02), pebble(0.0, 0.02, 0.005, 0.018), pebble(0.015, 0.004, 0.0, 0.016)],
    ] {
        let error = relative(Template::from_pebbles(&pebbles).unwrap().volume, three_balls(&pebbles));
        assert!(error < 1e-12, "{error}");
    }
}

#[test]
fn a_row_of_spheres_is_the_sum_of_its_parts() {
    // Each touches the next in a point; parallel axis theorem.
    let row: Vec<_> = (0..5).map(|k| pebble(2.0 * f64::from(k), 0.0, 0.0, 1.0)).collect();
    let template = Template::from_pebbles(&row).unwrap();
    let ball = 4.0 / 3.0 * PI;
    assert!(relative(template.volume, 5.0 * ball) < 1e-12);
    assert!(relative(template.inertia.x, 5.0 * 0.4 * ball) < 1e-12);
    assert!(relative(template.inertia.y, 5.0 * 0.4 * ball + 40.0 * ball) < 1e-12);
    assert!((template.centroid - Vector3::new(4.0, 0.0, 0.0)).norm() < 1e-12);
    assert_eq!(template.axes, UnitQuaternion::identity());
}

#[test]
fn a_long_row_loses_a_lens_at_every_neck() {
    let row: Vec<_> = (0..64).map(|k| pebble(1.147 * f64::from(k), 0.3 * f64::from(k), 0.0, 1.0)).collect();
    let overlap = 2.0 - 1.147_f64.hypot(0.3);
    let lens = PI / 12.0 * (6.0 - overlap) * overlap * overlap;
    let error = relative(Template::from_pebbles(&row).unwrap().volume, 64.0 * 4.0 / 3.0 * PI - 63.0 * lens);
    assert!(error < 1e-12, "{error}");
}

#[test]
fn one_pebble_is_a_sphere() {
    let template = Template::from_pebbles(&[pebble(1.0, 2.0, 3.0, 0.02)]).unwrap();
    let volume = 4.0 / 3.0 * PI * 0.02 * 0.02 * 0.02;
    assert_eq!(template.volume, volume);
    assert_eq!(template.inertia, Vector3::repeat(0.4 * volume * 0.02 * 0.02));
    assert_eq!(template.centroid, Vector3::new(1.0, 2.0, 3.0));
    assert_eq!(template.pebbles, Template::sphere(0.02).unwrap().pebbles);
    assert!(relative(template.equivalent_diameter(), 0.04) < 1e-15);
    assert_eq!(template.bounding_radius(), 0.02);
}

#[test]
fn a_ball_of_many_pebbles_is_nearly_the_ball() {
    // Pebbles that hardly stick out of a ball: many corners, thin slivers.
    let mut pebbles = vec![pebble(0.0, 0.0, 0.0, 1.0)];
    for k in 0..63 {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 63.0;
        let (s, c) = (2.4 * f64::from(k)).sin_cos();
        let across = (1.0 - z * z).sqrt();
        pebbles.push(pebble(0.5001 * across * c, 0.5001 * across * s, 0.5001 * z, 0.5));
    }
    let template = Template::from_pebbles(&pebbles).unwrap();
    let ball = 4.0 / 3.0 * PI;
    assert!(template.volume > ball && template.volume < ball * (1.0 + 3e-4));
    for k in 0..3 {
        assert!(template.inertia[k] > 0.4 * ball && template.inertia[k] < 0.4 * ball * (1.0 + 5e-4));
    }
}

/// Moments by rods along x, each the exact union of its chords, on a square grid across: volume, centroid, inertia
/// matrix.
fn rods(pebbles: &[Pebble], count: usize) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let reach = pebbles.iter().map(|p| p.centre.amax() + p.radius).fold(0.0, f64::max);
    let width = 2.0 * reach / count as f64;
    let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for row in 0..count * count {
        let place = |k: usize| (k as f64 + 0.5) * width - reach;
        let (y, z) = (place(row % count), place(row / count));
        let chord = |p: &Pebble| {
            let half = p.radius * p.radius - (p.centre.y - y).powi(2) - (p.centre.z - z).powi(2);
            (half > 0.0).then(|| (p.centre.x - half.sqrt(), p.centre.x + half.sqrt()))
        };
        let mut chords: Vec<_> = pebbles.iter().filter_map(chord).collect();
        chords.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut reached = f64::NEG_INFINITY;
        for (from, to) in chords {
            let from = from.max(reached);
            if to <= from {
                continue;
            }
            reached = to;
            let length = (to - from) * width * width;
            let middle = Vector3::new(0.5 * (from + to), y, z);
            volume += length;
            first += middle * length;
            second += middle * middle.transpose() * length;
            second[(0, 0)] += length * (to - from).powi(2) / 12.0;
        }
    }
    let centroid = first / volume;
    let central = second - first * centroid.transpose();
    (volume, centroid, Matrix3::identity() * central.trace() - central)
}

/// Inertia matrix in the given frame.
fn inertia_as_given(template: &Template) -> Matrix3<f64> {
    let axes = template.axes.to_rotation_matrix();
    axes.matrix() * Matrix3::from_diagonal(&template.inertia) * axes.matrix().transpose()
}

/// Clumps of 2 to 8 pebbles in no order: each is connected to an earlier one.
fn clumps() -> impl Strategy<Value = Vec<Pebble>> {
    let one = (0.5..1.0f64, 0usize..8, 0.0..6.2f64, -1.0..1.0f64, 0.55..0.98f64);
    prop::collection::vec(one, 1..8).prop_map(|rest| {
        let mut pebbles = vec![pebble(0.0, 0.0, 0.0, 0.8)];
        for (radius, on, angle, z, overlap) in rest {
            let base = pebbles[on % pebbles.len()];
            let across = (1.0 - z * z).sqrt();
            let direction = Vector3::new(across * angle.cos(), across * angle.sin(), z);
            let centre = base.centre + direction * (overlap * (base.radius + radius));
            let hidden = |p: &Pebble| (p.centre - centre).norm() <= (p.radius - radius).abs();
            if !pebbles.iter().any(hidden) {
                pebbles.push(Pebble { centre, radius });
            }
        }
        pebbles
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn any_clump_agrees_with_a_sum_of_rods(pebbles in clumps()) {
        let template = Template::from_pebbles(&pebbles).unwrap();
        // The errors of the rods, which fall with the square of their number across: at most 7e-5, 1.4e-4 and 6e-5 in
        // 50 clumps.
        let (volume, centroid, inertia) = rods(&pebbles, 400);
        prop_assert!(relative(template.volume, volume) < 3e-4);
        prop_assert!((template.centroid - centroid).norm() < 6e-4);
        prop_assert!((inertia_as_given(&template) - inertia).norm() < 3e-4 * inertia.norm());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn moving_and_turning_a_clump_changes_nothing(
        pebbles in clumps(), shift in [-3.0..3.0f64, -3.0..3.0, -3.0..3.0], turn in [-2.0..2.0f64, -2.0..2.0, -2.0..2.0],
    ) {
        let rotation = Rotation3::new(Vector3::from(turn));
        let place = |c: Vector3<f64>| rotation * c + Vector3::from(shift);
        let moved: Vec<_> = pebbles.iter().map(|p| Pebble { centre: place(p.centre), ..*p }).collect();
        let (before, after) = (Template::from_pebbles(&pebbles).unwrap(), Template::from_pebbles(&moved).unwrap());
        prop_assert!(relative(after.volume, before.volume) < 1e-11);
        prop_assert!((place(before.centroid) - after.centroid).norm() < 1e-11);
        let turned = rotation.matrix() * inertia_as_given(&before) * rotation.matrix().transpose();
        prop_assert!((turned - inertia_as_given(&after)).norm() < 1e-11 * turned.norm());
        // Distances within the clump equal the distances of the given pebbles.
        for (k, p) in after.pebbles.iter().enumerate() {
            prop_assert!(((p.centre - after.pebbles[0].centre).norm() - (pebbles[k].centre - pebbles[0].centre).norm()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_template_is_in_its_own_principal_frame(pebbles in clumps()) {
        let template = Template::from_pebbles(&pebbles).unwrap();
        let again = Template::from_pebbles(&template.pebbles).unwrap();
        prop_assert!(again.axes.angle() < 1e-8 && again.centroid.norm() < 1e-12);
        prop_assert!((again.inertia - template.inertia).norm() < 1e-11 * template.inertia.norm());
    }

    #[test]
    fn a_larger_clump_scales_by_its_powers(pebbles in clumps(), factor in 1e-3..1e3f64) {
        let larger: Vec<_> = pebbles.iter().map(|p| Pebble { centre: p.centre * factor, radius: p.radius * factor }).collect();
        let (scaled, direct) = (Template::from_pebbles(&pebbles).unwrap().scaled(factor), Template::from_pebbles(&larger).unwrap());
        prop_assert!(relative(scaled.volume, direct.volume) < 1e-12);
        prop_assert!(relative(scaled.equivalent_diameter(), direct.equivalent_diameter()) < 1e-12);
        prop_assert!(relative(scaled.bounding_radius(), direct.bounding_radius()) < 1e-12);
        prop_assert!((scaled.inertia - direct.inertia).norm() < 1e-11 * direct.inertia.norm());
        prop_assert!((scaled.centroid - direct.centroid).norm() < 1e-11 * factor);
    }
}

#[test]
fn axes_that_are_principal_are_kept() {
    // Two equal moments across the row and, in the cross, in its plane; three in the cube.
    let row = [pebble(0.0, 0.0, 0.0, 1.0), pebble(0.0, 1.2, 0.0, 1.0)];
    let cross = [
        pebble(1.0, 0.0, 0.0, 1.0),
        pebble(-1.0, 0.0, 0.0, 1.0),
        pebble(0.0, 1.0, 0.0, 1.0),
        pebble(0.0, -1.0, 0.0, 1.0),
    ];
    let cube: Vec<_> =
        (0..8).map(|k| pebble(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2), 0.8)).collect();
    for pebbles in [row.to_vec(), cross.to_vec(), cube] {
        assert_eq!(Template::from_pebbles(&pebbles).unwrap().axes, UnitQuaternion::identity());
    }
}

#[test]
fn free_axes_do_not_hang_on_rounding() {
    // For an inclined row, any axes across would do; a change of the last digits must not rotate them.
    let row = |nudge: f64| {
        let template =
            Template::from_pebbles(&[pebble(0.0, 0.0, 0.0, 1.0), pebble(0.7 + nudge, 0.5, 0.6, 1.0)]).unwrap();
        template.axes
    };
    assert!(row(0.0).angle_to(&row(1e-14)) < 1e-7);
}

#[test]
fn what_is_no_clump_is_refused() {
    let base = pebble(0.0, 0.0, 0.0, 1.0);
    let refused = |pebbles: &[Pebble]| Template::from_pebbles(pebbles).unwrap_err();
    assert_eq!(refused(&[]), TemplateError::NoPebbles);
    assert_eq!(refused(&[base, pebble(0.5, 0.0, 0.0, 0.0)]), TemplateError::Radius { pebble: 1, radius: 0.0 });
    assert!(matches!(Template::sphere(f64::NAN), Err(TemplateError::Radius { pebble: 0, .. })));
    assert_eq!(refused(&[pebble(f64::INFINITY, 0.0, 0.0, 1.0)]), TemplateError::Centre { pebble: 0 });
    assert_eq!(refused(&[base, pebble(0.2, 0.0, 0.0, 0.5)]), TemplateError::Swallowed { pebble: 1, inside: 0 });
    assert_eq!(refused(&[base, base]), TemplateError::Swallowed { pebble: 0, inside: 1 });
    let apart = [base, pebble(1.5, 0.0, 0.0, 1.0), pebble(9.0, 0.0, 0.0, 1.0), pebble(7.5, 0.0, 0.0, 1.0)];
    assert_eq!(refused(&apart), TemplateError::Apart { pebble: 2 });
}

#[test]
fn a_template_survives_a_checkpoint() {
    let template = Template::from_pebbles(&[pebble(0.1, 0.2, 0.3, 1.0), pebble(1.0, 0.1, -0.2, 0.8)]).unwrap();
    let text = serde_json::to_string(&template).unwrap();
    assert_eq!(serde_json::from_str::<Template>(&text).unwrap(), template);
}
