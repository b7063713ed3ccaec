//! Whatever the supports have settled, the track at rest finds its equilibrium: supports push, none pulls, and together
//! they carry the weight.

use crate::scenes::*;
use proptest::prelude::*;
use trackbed::solvers::track::*;

fn check(model: TrackModel, settlements: Vec<f64>, wheel: f64) -> Result<(), TestCaseError> {
    let track = Track::new(model.clone()).unwrap();
    let ends = [settlements[0], settlements[settlements.len() - 1]];
    let level = TrackLevel { settlements, ends };
    let train = Train::single(wagon(), Direction::Forward);
    for loads in [Loads::default(), Loads { train: Some((&train, wheel)), ..Loads::default() }] {
        let state = solve_static(&track, &level, &loads).unwrap();
        let (found, weight) = (state.balance.supports(), state.balance.loads);
        prop_assert!((found / weight - 1.0).abs() < 1e-9, "supports carry {found} N of {weight} N");
        for seat in 0..model.seats.len() {
            let gap = state.foot_displacements[seat] - level.settlements[seat];
            let force = state.contact_forces[seat];
            prop_assert!(force >= 0.0 && (force == 0.0 || gap > 0.0), "seat {seat} pulls");
            prop_assert!(force > 0.0 || gap < 1e-9, "seat {seat} sinks into its support by {gap} m");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Random settlements of up to 20 mm from seat to seat: most sleepers hang.
    #[test]
    fn random_settlements(
        settlements in prop::collection::vec(0.0..20e-3f64, 40),
        wheel in 9.0..23.0f64,
        ends in prop::sample::select(vec![RailEnds::Clamped, RailEnds::Pinned, RailEnds::Free]),
    ) {
        check(TrackModel { rail_ends: ends, ..ballast(40) }, settlements, wheel)?;
    }

    /// Settlements in a grid of hundredths of a millimetre, so that many contacts are about to change.
    #[test]
    fn settlements_on_a_grid(
        settlements in prop::collection::vec(0u32..6, 40),
        unit in prop::sample::select(vec![1e-5f64, 1e-4, 1e-3]),
        wheel in 9.0..23.0f64,
    ) {
        check(ballast(40), settlements.into_iter().map(|n| n as f64 * unit).collect(), wheel)?;
    }
}
