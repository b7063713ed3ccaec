//! Sleepers over voids that open and close under every bogie: the time step decides nothing.

use crate::scenes::*;
use trackbed::solvers::track::*;

struct Found {
    /// Per seat, N.
    peaks: Vec<f64>,
    /// Times that a support began or ceased to carry.
    changes: usize,
    lowest: f64,
    /// Per seat, s.
    hanging: Vec<f64>,
}

fn run(time_step: f64) -> Found {
    let model = ballast(45);
    let mut level = TrackLevel::as_built(&model);
    for (i, void) in [0.5e-3, 1.5e-3, 2.5e-3, 2.5e-3, 1.5e-3, 0.5e-3].into_iter().enumerate() {
        level.settlements[24 + i] = void;
    }
    let seats = model.seats.len();
    let stepper = stepper(model, scheme(time_step));
    let mut found = Found { peaks: vec![0.0; seats], changes: 0, lowest: f64::INFINITY, hanging: vec![0.0; seats] };
    let mut carried: Vec<bool> = Vec::new();
    pass(&stepper, &level, 11.0, 23.0, |view| {
        let forces: Vec<f64> = (0..seats).filter_map(|seat| view.contact_force(seat)).collect();
        let carries: Vec<bool> = forces.iter().map(|f| *f > 0.0).collect();
        found.changes += carried.iter().zip(&carries).filter(|(a, b)| a != b).count();
        carried = carries;
        for (seat, force) in forces.into_iter().enumerate() {
            found.peaks[seat] = found.peaks[seat].max(force);
            found.hanging[seat] += if force == 0.0 { view.time_step() } else { 0.0 };
            found.lowest = found.lowest.min(force);
        }
    });
    found
}

#[test]
fn contacts_converge() {
    let runs = [1e-4, 5e-5, 2.5e-5, 1.25e-5].map(run);
    let finest = &runs[3];
    for pair in runs.windows(2) {
        let (coarse, fine) = (&pair[0], &pair[1]);
        let most = largest(fine.peaks.iter().copied());
        let peaks = largest(coarse.peaks.iter().zip(&fine.peaks).map(|(a, b)| (a - b) / most));
        let hanging = largest(coarse.hanging.iter().zip(&finest.hanging).map(|(a, b)| a - b));
        println!(
            "peaks change by {peaks:.1e}, {} and {} changes, hanging by {hanging:.1e} s",
            coarse.changes, fine.changes
        );
        assert!(peaks < 2e-3, "found 1.8e-4 and less");
        assert_eq!(coarse.changes, fine.changes, "found 57 each");
        assert!(hanging < 3e-4, "found 1.6e-4 and less");
        assert!(coarse.lowest >= 0.0);
    }
}
