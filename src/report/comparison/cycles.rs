//! Tests of rigs in one figure: settlement and stiffness with the cycles, stress and volume with the strain.

use super::coloured;
use crate::compare::{Comparison, Subject};
use crate::report::Figure;
use crate::report::along::figure;
use crate::report::curves::{Axis, Chart, Mark, Series};
use crate::results::BedTest;
use crate::solvers::granular::rig::{Cycle, SpecimenState};

pub(super) fn figures(comparison: &Comparison) -> Vec<Figure> {
    let cycles = || Axis { whole: true, ..Axis::new("Cycles", ("", 1.0)) };
    let strain = || Axis { from_zero: true, ..Axis::new("Axial strain", ("%", 0.01)) };
    let settlement = Axis { downwards: true, from_zero: true, ..Axis::new("Settlement", ("mm", 1e-3)) };
    let stiffness = Axis { from_zero: true, ..Axis::new("Resilient stiffness", ("MN/m", 1e6)) };
    let deviator = Axis { from_zero: true, ..Axis::new("Deviator", ("kPa", 1e3)) };
    let volume = Axis { from_zero: true, ..Axis::new("Volume strain", ("%", 0.01)) };
    let thin = "One curve for each packing; curves of one result have the same colour.";
    let figures = [
        drawn(comparison, (cycles(), settlement), &|test| of_cycles(test, |cycle| cycle.settlement))
            .and_then(|chart| figure(&chart, "settlement", "Settlement against cycles", thin)),
        drawn(comparison, (cycles(), stiffness), &|test| of_cycles(test, |cycle| cycle.stiffness))
            .and_then(|chart| figure(&chart, "stiffness", "Stiffness against cycles", thin)),
        drawn(comparison, (strain(), deviator), &|test| of_specimen(test, SpecimenState::deviator))
            .and_then(|chart| figure(&chart, "deviator", "Deviator against strain", thin)),
        drawn(comparison, (strain(), volume), &|test| of_specimen(test, |state| state.volume_strain))
            .and_then(|chart| figure(&chart, "volume", "Volume strain against axial strain", thin)),
    ];
    figures.into_iter().flatten().collect()
}

/// Points of a test, and whether there are several of them.
type Points = Vec<(f64, f64)>;

/// A chart with a curve for each packing of each result; `None` if none has two points.
fn drawn(comparison: &Comparison, (x, y): (Axis, Axis), of: &dyn Fn(&BedTest) -> Points) -> Option<Chart> {
    let mut chart = Chart::new(x, y);
    for (subject, class) in coloured(comparison) {
        for (index, points) in tests(subject).map(of).enumerate().filter(|(_, points)| points.len() > 1) {
            let name = if index == 0 { subject.name.as_str() } else { "" };
            let mark = if index > 0 || points.len() > 40 { Mark::Line } else { Mark::Dots };
            chart.series.push(Series { pale: index > 0, ..Series::new(name, &class, mark, points) });
        }
    }
    (!chart.is_empty()).then_some(chart)
}

fn tests(subject: &Subject) -> impl Iterator<Item = &BedTest> {
    subject.tests().into_iter().flat_map(|view| &view.tests.tests)
}

/// A value of the sleeper that settles most in each cycle.
fn of_cycles(test: &BedTest, value: fn(&Cycle) -> f64) -> Points {
    let cycles = &test.answer.cycles;
    let worst = cycles.iter().max_by(|a, b| a.settlement.total_cmp(&b.settlement)).map_or(0, |cycle| cycle.sleeper);
    cycles.iter().filter(|cycle| cycle.sleeper == worst).map(|cycle| (cycle.number as f64, value(cycle))).collect()
}

fn of_specimen(test: &BedTest, value: fn(&SpecimenState) -> f64) -> Points {
    test.answer.specimen.iter().map(|state| (state.axial_strain, value(state))).collect()
}
