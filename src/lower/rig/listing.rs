//! A rig as a person reads it before it runs.

use super::rig_cost;
use crate::scenario::{Loading, RigLoad, Scenario, Target};
use crate::units::number;

/// What the plan says of a rig.
pub fn rig_listing(scenario: &Scenario) -> String {
    let Some(cost) = rig_cost(scenario) else { return String::new() };
    let rounded = |value: f64| number(format!("{value:.2e}").parse().unwrap_or(value));
    let time = match cost.seconds {
        seconds if seconds < 120.0 => format!("{} s", seconds.ceil()),
        seconds if seconds < 7200.0 => format!("{} min", (seconds / 60.0).ceil()),
        seconds => format!("{} h", (seconds / 3600.0).ceil()),
    };
    format!(
        "test rig: {} on a packed bed\n\
         grains: about {} of {} pebbles in all, step {} us\n\
         steps: about {} to pack the bed, {} to test it{}\n\
         time: about {time} on two cores, within a factor of two\n",
        what_stands(scenario),
        rounded(cost.grains),
        rounded(cost.pebbles),
        number((cost.time_step * 1e7).round() / 10.0),
        rounded(cost.packing_steps),
        rounded(cost.test_steps),
        if cost.repeats > 1 { format!(", {} times", cost.repeats) } else { String::new() }
    )
}

fn what_stands(scenario: &Scenario) -> String {
    let count = scenario.track.seats.len();
    let plate = |load: &RigLoad| load.on == Target::Bed;
    if matches!(&scenario.loading, Some(Loading::Rig(loads)) if loads.iter().any(|load| load.confinement.is_some())) {
        "a plate on a specimen whose sides give way,".to_owned()
    } else if matches!(&scenario.loading, Some(Loading::Rig(loads)) if loads.iter().any(plate)) {
        "a plate".to_owned()
    } else if count == 1 {
        "1 sleeper".to_owned()
    } else {
        format!("{count} sleepers")
    }
}
