//! Rail level, voids and forces along the track after every recorded count of axles: the picture shows the last one,
//! the page's script has a slider that moves through all.

use super::Figure;
use super::along::{ballasted_names, track_chart};
use super::curves::{Chart, Mark, Series};
use super::number::whole;
use super::panels::{Names, panels};
use crate::results::{Run, SleeperRow};
use crate::scenario::Loading;
use std::collections::{BTreeSet, HashMap};

const HEIGHT: f64 = 230.0;
/// Counts that the page holds at most, spread evenly.
const MOST: usize = 40;
/// Places of the rail that the page holds: a picture has no more pixels.
const PLACES: usize = 420;

pub fn over_axles(run: &Run) -> Option<Figure> {
    let counts = counts(run);
    if counts.len() < 2 {
        return None;
    }
    let chart = |label: &str, unit: &str, down: bool| {
        let mut chart = track_chart(run, label, unit, down);
        chart.steps = counts.iter().map(|count| named(*count)).collect();
        chart
    };
    let mut level = chart("Unloaded rail, and supports below as built", "m", true);
    level.series.extend(rail_level(run, &counts));
    level.series.extend(per_seat(run, &counts, ("supports", "s1"), true, |row| row.settlement_m));
    let mut voids = chart("Void under the sleeper", "m", true);
    voids.series = per_seat(run, &counts, ("void", "s0"), true, |row| row.void_m);
    let mut forces = chart("Largest force of a passage", "N", false);
    forces.y.from_zero = true;
    forces.series = per_seat(run, &counts, ("rail seat load", "s0"), false, |row| row.max_rail_seat_load_N);
    let contact = ("sleeper on its support", "s1");
    forces.series.extend(per_seat(run, &counts, contact, true, |row| row.max_contact_force_N));
    let charts: Vec<(Chart, f64)> =
        [level, voids, forces].into_iter().filter(|chart| !chart.is_empty()).map(|chart| (chart, HEIGHT)).collect();
    let caption = format!(
        "After {} axles. Top: level of the rail without a vehicle, and level of the settled supports. If the rail lies \
         higher, sleepers hang; if the sleepers rest, the weight of the track presses the rail a little lower. Middle: \
         void between sleeper and support. Bottom: largest forces of one passage at that count, per seat. Paler near \
         the ends: not every wheel passes there.",
        whole(counts[counts.len() - 1])
    );
    panels(&Names { id: "over_axles", title: "Level, voids and forces as axles pass", caption: &caption }, &charts, 1)
}

/// The recorded counts, as many as the page holds.
fn counts(run: &Run) -> Vec<u64> {
    let all: Vec<u64> = run.sleepers.iter().map(|row| row.axles).collect::<BTreeSet<_>>().into_iter().collect();
    spread(all.len(), MOST).into_iter().map(|index| all[index]).collect()
}

/// At most so many of the indices below `count`, first and last among them, spread evenly.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most { (0..count).collect() } else { (0..most).map(|k| k * (count - 1) / (most - 1)).collect() }
}

/// `after 100 axles`
pub(super) fn named(axles: u64) -> String {
    if axles == 0 { "as built".to_owned() } else { format!("after {} axles", whole(axles)) }
}

/// Level of the unloaded rail, at places that all counts share.
fn rail_level(run: &Run, counts: &[u64]) -> Option<Series> {
    let of = |count: &u64| -> Vec<(f64, f64)> {
        run.rail.iter().filter(|row| row.axles == *count).map(|row| (row.x_m, row.level_m)).collect()
    };
    let rows: Vec<Vec<(f64, f64)>> = counts.iter().map(of).collect();
    let length = rows.last()?.len();
    let kept = spread(length, PLACES);
    let moving = rows.iter().map(|row| match row.len() == length {
        true => kept.iter().map(|index| row[*index].1).collect(),
        false => vec![f64::NAN; kept.len()], // no passage was computed there
    });
    let places = rows.last()?;
    let places: Vec<f64> = kept.iter().map(|index| places[*index].0).collect();
    moved(("rail", "s0"), &places, moving.collect())
}

/// Values of the seats; only ballasted seats for a quantity of the ballast. Seats that every train passes with every
/// wheel are in one curve, the others in a paler curve that joins it.
fn per_seat(
    run: &Run,
    counts: &[u64],
    names: (&str, &str),
    ballasted: bool,
    value: fn(&SleeperRow) -> f64,
) -> Vec<Series> {
    let known = ballasted_names(&run.scenario);
    let trains = match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) => traffic.trains().count(),
        _ => 0,
    };
    let at = |count: u64| run.sleepers.iter().filter(move |row| row.axles == count);
    let last: Vec<&SleeperRow> = at(counts[counts.len() - 1]).collect();
    let whole: Vec<bool> = last.iter().map(|row| row.trains_passing >= trains).collect();
    let beside = |i: usize| !whole[i] || i > 0 && !whole[i - 1] || whole.get(i + 1) == Some(&false);
    let places: Vec<f64> = last.iter().map(|row| row.x_m).collect();
    let series = |shown: &dyn Fn(usize) -> bool| {
        let values = |count: &u64| {
            let rows = at(*count).filter(|row| !ballasted || known.contains(&row.sleeper));
            let by_name: HashMap<&str, f64> = rows.map(|row| (row.sleeper.as_str(), value(row))).collect();
            let of = |(i, row): (usize, &&SleeperRow)| by_name.get(row.sleeper.as_str()).filter(|_| shown(i)).copied();
            last.iter().enumerate().map(|seat| of(seat).unwrap_or(f64::NAN)).collect()
        };
        moved(names, &places, counts.iter().map(values).collect())
    };
    let pale = series(&beside).map(|series| Series { pale: true, name: String::new(), ..series });
    [series(&|i| whole[i]), pale].into_iter().flatten().collect()
}

/// A curve that moves through the counts and stands at the last one; none if it has no value.
fn moved((name, class): (&str, &str), places: &[f64], moving: Vec<Vec<f64>>) -> Option<Series> {
    if !moving.iter().flatten().any(|value| value.is_finite()) {
        return None;
    }
    let points = places.iter().copied().zip(moving.last()?.iter().copied()).collect();
    Some(Series { moving, ..Series::new(name, class, Mark::Line, points) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    #[test]
    fn every_count_is_kept_over_the_same_places() {
        let run = example::transition();
        let counts = counts(&run);
        for series in per_seat(&run, &counts, ("void", "s0"), true, |row| row.void_m) {
            assert_eq!(series.moving.len(), counts.len());
            assert!(series.moving.iter().all(|values| values.len() == series.points.len()));
        }
        let figure = over_axles(&run).unwrap();
        assert!(figure.svg.contains("\"steps\":[\"as built\""), "{}", figure.svg);
    }

    #[test]
    fn many_counts_are_spread() {
        assert_eq!(spread(3, 40), [0, 1, 2]);
        let kept = spread(1000, 40);
        assert_eq!((kept.len(), kept[0], kept[39]), (40, 0, 999));
    }

    #[test]
    fn a_run_of_one_count_has_no_such_figure() {
        let mut run = example::transition();
        let last = run.sleepers.iter().map(|row| row.axles).max().unwrap();
        run.sleepers.retain(|row| row.axles == last);
        assert_eq!(over_axles(&run), None);
    }
}
