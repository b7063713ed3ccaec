//! A killed run resumes with the same answer.

use crate::bed::{bed, bits};
use trackbed::solvers::granular::{Bed, Checkpoint, Pose, Real, Shape, WallId, WallMotion};

fn resumes<R: Real>() {
    let mut whole = bed::<R>(7);
    whole.add_wall(
        Shape::block([0.1, 0.1, 0.02].into()).unwrap(),
        Pose { position: [0.2, 0.2, 0.46].into(), ..Pose::default() },
        0,
        WallMotion::Velocity { linear: [0.0, 0.0, -0.05].into(), angular: [0.0; 3].into() },
    );
    whole.watch_energy(true);
    whole.run(16_000).unwrap();
    let text = serde_json::to_string(&whole.checkpoint()).unwrap();
    whole.run(3000).unwrap();

    let read: Checkpoint<R> = serde_json::from_str(&text).unwrap();
    let mut resumed = Bed::restore(read).unwrap();
    resumed.run(3000).unwrap();
    assert_eq!(bits(&whole), bits(&resumed), "{}", R::NAME);
    // sums over contacts go in the order of the lists, which are made anew
    let (a, b) = (whole.energy(), resumed.energy());
    for (a, b) in [(a.strain, b.strain), (a.slip, b.slip), (a.dashpot, b.dashpot), (a.damping, b.damping)] {
        assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
    assert_eq!(whole.wall(WallId(1)).felt(), resumed.wall(WallId(1)).felt());
    assert!(whole.touching().unwrap().0 > 40, "{:?}", whole.touching());
}

#[test]
fn a_restored_bed_goes_on_bit_by_bit() {
    resumes::<f32>();
    resumes::<f64>();
}

#[test]
fn a_damaged_checkpoint_is_refused() {
    let mut bed = bed::<f32>(3);
    bed.run(10).unwrap();
    let text = serde_json::to_string(&bed.checkpoint()).unwrap();
    let refused = |from: &str, to: &str, expected: &str| {
        let damaged = text.replacen(from, to, 1);
        assert_ne!(damaged, text, "{from}");
        let read: Checkpoint<f32> = serde_json::from_str(&damaged).unwrap();
        let message = Bed::restore(read).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("run from the start"), "{message}");
    };
    refused("\"version\":2", "\"version\":9", "has layout 9");
    refused("\"id\":0,", "\"id\":1,", "not numbered");
    refused("\"surface\":0", "\"surface\":5", "without laws");
    refused("\"pebbles\":3", "\"pebbles\":2", "pebbles");
}
