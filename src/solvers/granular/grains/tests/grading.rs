//! Samples against their curves, for every kind of curve.

use super::super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

/// A ballast of 32 to 80 mm.
fn ballast() -> Curve {
    Curve::new(&[[0.032, 0.0], [0.04, 0.3], [0.05, 0.65], [0.063, 0.95], [0.08, 1.0]]).unwrap()
}

fn of_count(curve: &Curve, count: usize, seed: u64) -> Sample {
    curve.sample(count as f64 * curve.mean_volume(), seed).unwrap()
}

/// A sample with the same number of grains of the same curve, drawn one by one from a very large number.
fn without_strata(curve: &Curve, count: usize, seed: u64) -> Sample {
    let many = of_count(curve, 20_000, seed).sizes;
    let mut random = Random::new(seed, 77);
    let sizes: Vec<f64> = (0..count).map(|_| many[(random.share() * many.len() as f64) as usize]).collect();
    let volume = sizes.iter().map(|d| PI / 6.0 * d.powi(3)).sum();
    Sample { sizes, curve: curve.clone(), volume }
}

/// Share of the mass in the largest grain: the difference between a sample of whole grains and the curve is at least
/// half of it.
fn largest_share(sample: &Sample) -> f64 {
    PI / 6.0 * sample.sizes.iter().copied().fold(0.0, f64::max).powi(3) / sample.volume
}

#[test]
fn strata_follow_the_curve_as_well_as_whole_grains_can() {
    let curve = ballast();
    // found: at most 0.037, 0.0036, 0.00056 of the mass; without strata up to 0.16, 0.06, 0.029
    for (count, most) in [(100, 0.045), (1000, 0.006), (6000, 0.001)] {
        let (mut worst, mut plain) = (0.0f64, 0.0f64);
        for seed in 0..20 {
            let sample = of_count(&curve, count, seed);
            assert_eq!(sample.sizes.len(), count);
            assert!(sample.error() < largest_share(&sample));
            worst = worst.max(sample.error());
            plain = plain.max(without_strata(&curve, count, seed).error());
        }
        assert!(worst < most && worst < 0.3 * plain, "{count}: {worst} {plain}");
    }
}

#[test]
fn a_sample_is_known_by_its_seed() {
    let (one, same, other) = (of_count(&ballast(), 500, 3), of_count(&ballast(), 500, 3), of_count(&ballast(), 500, 4));
    assert_eq!(one, same);
    assert!(one.sizes != other.sizes && one.sizes.len() == other.sizes.len());
}

#[test]
fn the_first_grains_of_many_follow_the_curve_too() {
    let mut sample = of_count(&ballast(), 6000, 1);
    sample.sizes.truncate(1000);
    sample.volume = sample.sizes.iter().map(|d| PI / 6.0 * d.powi(3)).sum();
    assert!(sample.error() < 0.06, "{}", sample.error());
}

#[test]
fn one_size_and_jumps_are_curves() {
    let sample = Curve::single(0.05).unwrap().sample(100.4 * PI / 6.0 * 0.05f64.powi(3), 1).unwrap();
    assert_eq!(sample.sizes, vec![0.05; 100]);
    assert!(sample.error() < 1e-12);
    // half of the mass in one size, the other half over a class
    let curve = Curve::new(&[[0.03, 0.0], [0.03, 0.5], [0.06, 1.0]]).unwrap();
    let sample = of_count(&curve, 2000, 1);
    let equal = sample.sizes.iter().filter(|d| **d == 0.03).map(|d| PI / 6.0 * d.powi(3)).sum::<f64>();
    assert!((equal / sample.volume - 0.5).abs() < 1e-3 && sample.error() < largest_share(&sample));
}

#[test]
fn level_parts_hold_no_grains_and_ends_are_cut_off() {
    let curve = Curve::new(&[[0.01, 0.1], [0.02, 0.1], [0.03, 0.3], [0.04, 0.3], [0.06, 0.9], [0.08, 0.9]]).unwrap();
    assert!((curve.modelled() - 0.8).abs() < 1e-15);
    assert_eq!(curve.ends(), [0.02, 0.06]);
    let sample = of_count(&curve, 5000, 2);
    assert!(sample.sizes.iter().all(|d| (0.02..=0.03).contains(d) || (0.04..=0.06).contains(d)));
    let classes = sample.classes();
    assert_eq!(classes.iter().map(|c| c.grains).sum::<usize>(), 5000);
    assert_eq!((classes[1].grains, classes[1].asked, classes[1].reached), (0, 0.0, 0.0));
    assert!((classes[0].asked - 0.25).abs() < 1e-12 && (classes[0].reached - 0.25).abs() < 2e-3);
    assert!((curve.below(0.035) - 0.25).abs() < 1e-12);
}

#[test]
fn a_class_that_is_too_narrow_for_the_volume_has_no_grain() {
    let curve = Curve::new(&[[0.02, 0.0], [0.03, 0.99], [0.08, 1.0]]).unwrap();
    let coarse = of_count(&curve, 50, 1).classes()[1];
    assert_eq!(coarse.grains, 0);
    assert!((coarse.asked - 0.01).abs() < 1e-12);
}

#[test]
fn what_is_no_curve_and_no_sample_is_refused() {
    let of = |points: &[[f64; 2]]| Curve::new(points).unwrap_err();
    assert_eq!(of(&[[0.0, 0.0], [0.1, 1.0]]), GradingError::Size { size: 0.0 });
    assert_eq!(of(&[[0.02, 0.0], [0.01, 1.0]]), GradingError::Falls { point: 1 });
    assert_eq!(of(&[[0.01, 0.5], [0.02, 0.4]]), GradingError::Falls { point: 1 });
    assert_eq!(of(&[[0.01, 0.0], [0.02, f64::NAN]]), GradingError::Falls { point: 1 });
    assert_eq!(of(&[[0.01, 0.5], [0.02, 0.5]]), GradingError::Empty);
    assert_eq!(of(&[]), GradingError::Empty);
    let dust = Curve::new(&[[1e-5, 0.0], [0.08, 1.0]]).unwrap();
    assert!(matches!(dust.sample(0.1, 1), Err(GradingError::TooMany { .. })));
    assert!(matches!(ballast().sample(1e-6, 1), Err(GradingError::NoGrain { .. })));
    assert!(matches!(ballast().sample(f64::NAN, 1), Err(GradingError::Volume { .. })));
}

#[test]
fn every_template_has_its_share_of_the_grains() {
    let sample = of_count(&ballast(), 1001, 1);
    let found = grains(&sample, 5, 1);
    let of = |template: usize| found.iter().filter(|grain| grain.template == template).count();
    assert_eq!((0..5).map(of).collect::<Vec<_>>(), [201, 200, 200, 200, 200]);
    assert!(found.iter().zip(&sample.sizes).all(|(grain, size)| grain.size == *size));
    assert_ne!(found, grains(&sample, 5, 2));
}

#[test]
fn what_a_curve_fills_follows_from_its_sizes() {
    // spheres of one size, dense random packing
    assert_eq!(Curve::single(0.05).unwrap().solid_share(), 0.634);
    // the same from the sizes of many grains, and a larger solid share for a wider grading
    let wide = Curve::new(&[[0.025, 0.0], [0.0375, 0.27], [0.05, 0.4], [0.1, 0.8], [0.15, 1.0]]).unwrap();
    let shares = [ballast(), wide].map(|curve| {
        let sizes = of_count(&curve, 20_000, 1).sizes;
        let mean = sizes.iter().sum::<f64>() / 2e4;
        let central = |power: i32| sizes.iter().map(|d| (d - mean).powi(power)).sum::<f64>() / 2e4;
        let (scatter, skewness) = (central(2).sqrt() / mean, central(3) / central(2).powf(1.5));
        let share = 0.634 + 0.0658 * scatter + 0.0857 * skewness * scatter * scatter;
        assert!((curve.solid_share() / share - 1.0).abs() < 1e-3, "{} {share}", curve.solid_share());
        share
    });
    assert!(0.634 < shares[0] && shares[0] + 0.03 < shares[1] && shares[1] < 0.75, "{shares:?}");
}

fn curves() -> impl Strategy<Value = Curve> {
    let class = (0.0..0.8f64, prop_oneof![Just(0.0), 0.01..1.0f64]);
    (0.005..0.05f64, prop::collection::vec(class, 1..7), 0.01..1.0f64).prop_map(|(finest, classes, last)| {
        let total = classes.iter().map(|c| c.1).sum::<f64>() + last;
        let mut points = vec![[finest, 0.0]];
        for (width, mass) in classes {
            let [size, share] = points[points.len() - 1];
            points.push([size * (1.0 + width), (share + mass / total).min(1.0)]);
        }
        let coarsest = points[points.len() - 1][0];
        points.push([1.3 * coarsest, 1.0]);
        Curve::new(&points).unwrap()
    })
}

proptest! {
    #[test]
    fn any_curve_is_followed(curve in curves(), count in 50usize..3000, seed in 0u64..1000) {
        let sample = of_count(&curve, count, seed);
        let [finest, coarsest] = curve.ends();
        prop_assert!(sample.sizes.iter().all(|d| (finest * (1.0 - 1e-12)..=coarsest * (1.0 + 1e-12)).contains(d)));
        // a coarse end with less than one grain gets none
        let asked = count as f64 * curve.mean_volume();
        let grain = PI / 6.0 * coarsest.powi(3) / asked;
        prop_assert!(sample.error() < 1.5 * grain, "{} {grain}", sample.error());
        prop_assert!((sample.volume / asked - 1.0).abs() < grain);
    }
}
