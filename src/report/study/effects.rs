//! Main effects: the mean of a measured quantity over the points with the same value, for every varied value.

use super::plane::{Plane, cut, range, titled};
use crate::report::curves::{Mark, Series};
use crate::report::number::significant;
use crate::report::svg::{Anchor, Frame, Svg};
use crate::scenario::Measured;
use crate::study::Answer;

const WIDTH: f64 = 960.0;
const GAP: f64 = 14.0;
const HEIGHT: f64 = 246.0;
/// Panels beside each other, at most.
const ACROSS: usize = 3;
/// Pieces into which a value without a list is cut.
const BINS: usize = 6;
/// Width of a character below a panel.
const CHARACTER: f64 = 6.8;
/// Left and right of the plane of a panel, for the marks of its scale.
const LEFT: f64 = 58.0;
const RIGHT: f64 = 8.0;

/// Points that share a value.
struct Group {
    label: String,
    /// On the level scale.
    x: f64,
    rows: Vec<usize>,
}

/// The picture with its caption; none if fewer than two points ran.
pub(super) fn main_effects(answer: &Answer) -> Option<(String, String)> {
    let measured = answer.study.measured();
    let done = answer.designs().filter(|(_, row)| row.values().is_some()).count();
    if done < 2 || measured.is_empty() {
        return None;
    }
    // a value that is the same in every point has no effect to show
    let axes: Vec<usize> = (0..answer.study.axes.len()).filter(|axis| groups(answer, *axis).len() > 1).collect();
    if axes.is_empty() {
        return None;
    }
    // with one varied value its measured quantities lie side by side, otherwise the varied values do
    let panels: Vec<(usize, usize)> = (0..measured.len()).flat_map(|m| axes.iter().map(move |a| (m, *a))).collect();
    let each = if axes.len() == 1 { panels.len() } else { axes.len() };
    let beside = each.min(ACROSS);
    let rows_each = each.div_ceil(beside);
    let width = (WIDTH - GAP * (beside - 1) as f64) / beside as f64;
    let mut svg = Svg::default();
    for (index, (m, axis)) in panels.iter().enumerate() {
        let (block, within) = (index / each, index % each);
        let frame = Frame {
            x: (within % beside) as f64 * (width + GAP),
            y: (block * rows_each + within / beside) as f64 * (HEIGHT + GAP),
            width,
            height: HEIGHT,
        };
        svg.group(r#"class="chart""#, |svg| panel(svg, answer, *m, measured[*m], *axis, frame));
    }
    let height = (panels.len() / each * rows_each) as f64 * (HEIGHT + GAP);
    let mut caption = "Dots: mean over all points with the same value (or in the same sixth of its range). Bars: from \
                       the smallest to the largest of these points. Rings: the points. A level line means that the \
                       value has almost no effect."
        .to_owned();
    if answer.as_it_is().is_some_and(|row| row.values().is_some()) {
        caption += " Dashed: the scene as it is.";
    }
    for axis in axes {
        let groups = groups(answer, axis);
        if lettered(&groups, width) {
            caption += &key(&answer.study.axes[axis].path, &groups);
        }
    }
    if answer.study.repeats.are_several() {
        caption += " Whiskers: plus and minus one standard deviation of one packing.";
    }
    Some((svg.finish(WIDTH, height, "Main effects of the varied values"), caption))
}

fn panel(svg: &mut Svg, answer: &Answer, m: usize, what: &Measured, axis: usize, frame: Frame) {
    let value = |row: usize| answer.rows[row].values().map(|v| v[m] / what.unit.1);
    let scatter = |row: usize| answer.rows[row].deviations().map_or(0.0, |d| d[m] / what.unit.1);
    let ends = |row: usize| Some([value(row)? - scatter(row), value(row)? + scatter(row)]);
    let groups = groups(answer, axis);
    let own = &answer.study.axes[axis];
    let numbers = place(answer, axis);
    svg.text("strong", (frame.x + 4.0, frame.y + 13.0), Anchor::Start, &cut(&titled(&what.text, &what.unit.0), 42));
    let xs = groups.iter().flat_map(|g| g.rows.iter().map(|row| numbers(*row)));
    let worded = groups.iter().any(|g| !g.label.is_empty());
    let as_it_is = answer.as_it_is().and_then(|row| Some(row.values()?[m] / what.unit.1));
    let plane = Plane {
        frame: Frame {
            x: frame.x + LEFT,
            y: frame.y + 26.0,
            width: frame.width - LEFT - RIGHT,
            height: frame.height - 86.0,
        },
        x: if worded { (-0.5, groups.last().map_or(0.5, |g| g.x + 0.5)) } else { range(xs) },
        y: range((0..answer.rows.len()).filter_map(ends).flatten()),
    };
    plane.upright_scale(svg);
    if let Some(level) = as_it_is {
        plane.as_it_is(svg, level, &format!("as it is: {} {}", significant(level, 4), what.unit.0));
    }
    if worded {
        let letters = lettered(&groups, frame.width);
        for (index, group) in groups.iter().enumerate() {
            let name = if letters { letter(index) } else { bare(&group.label).to_owned() };
            plane.mark(svg, group.x, index % rows_of(&groups), &name);
        }
    } else {
        plane.level_scale(svg);
    }
    let middle = plane.frame.x + plane.frame.width / 2.0;
    let title = cut(&titled(&own.path, &own.unit), 44);
    svg.text("", (middle, frame.y + frame.height - 8.0), Anchor::Middle, &title);
    let means: Vec<(f64, f64)> = groups.iter().map(|group| (group.x, mean(group, &value))).collect();
    let rows = || groups.iter().flat_map(|group| &group.rows).copied();
    let points = || rows().filter_map(|row| Some((row, (numbers(row), value(row)?))));
    let named = |row: usize| format!("point {}", answer.rows[row].number);
    let series = vec![
        Series::new("mean", "s0", Mark::Dots, means.clone()),
        Series {
            labels: points().map(|(row, _)| named(row)).collect(),
            ..Series::new("point", "s0", Mark::Dots, points().map(|(_, at)| at).collect())
        },
    ];
    plane.readings(svg, [(&own.path, &own.unit), (&what.text, &what.unit.0)], series);
    for group in &groups {
        let values = || group.rows.iter().filter_map(|row| value(*row));
        let (low, high) = values().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        svg.line("line s0", plane.point((group.x, low)), plane.point((group.x, high)));
    }
    svg.group(r#"class="series" data-series="1""#, |svg| {
        for (row, (x, y)) in points() {
            svg.circle("faint", plane.point((x, y)), 2.5, &named(row));
            if scatter(row) > 0.0 {
                whisker(svg, plane.point((x, y - scatter(row))), plane.point((x, y + scatter(row))));
            }
        }
    });
    svg.group(r#"class="series" data-series="0""#, |svg| {
        let places: Vec<(f64, f64)> = means.iter().map(|at| plane.point(*at)).collect();
        // no line between words
        if !worded {
            svg.path("line s0", &places, false, "");
        }
        for (group, (place, (_, mean))) in groups.iter().zip(places.into_iter().zip(&means)) {
            let (count, value) = (group.rows.len(), significant(*mean, 4));
            svg.circle("dot s0", place, 4.0, &format!("mean of {count}: {value} {}", what.unit.0));
        }
    });
}

/// The names of the levels stand in two rows where they are many, so that neighbours leave each other room.
fn rows_of(groups: &[Group]) -> usize {
    if groups.len() > 3 { 2 } else { 1 }
}

/// Whether letters stand for the names of the levels, because these would touch each other below a panel.
fn lettered(groups: &[Group], width: f64) -> bool {
    let room = (width - LEFT - RIGHT) * rows_of(groups) as f64 / groups.len() as f64;
    let wide = |label: &str| (bare(label).chars().count() + 1) as f64 * CHARACTER > room;
    groups.iter().any(|group| !group.label.is_empty() && wide(&group.label))
}

/// `A`, `B` and so on; numbers where there are more levels than letters.
fn letter(index: usize) -> String {
    ('A'..='Z').nth(index).map_or((index + 1).to_string(), String::from)
}

/// ` gang.after: A = [100_000] axles, B = ...`
fn key(path: &str, groups: &[Group]) -> String {
    let named = |(index, group): (usize, &Group)| format!("{} = `{}`", letter(index), group.label);
    format!(" {path}: {}.", groups.iter().enumerate().map(named).collect::<Vec<_>>().join(", "))
}

/// A list without its brackets.
fn bare(label: &str) -> &str {
    label.strip_prefix('[').and_then(|inner| inner.strip_suffix(']')).unwrap_or(label)
}

/// The mean of a measured quantity over the points of a group.
fn mean(group: &Group, value: &impl Fn(usize) -> Option<f64>) -> f64 {
    let values: Vec<f64> = group.rows.iter().filter_map(|row| value(*row)).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// An upright line with its ends.
fn whisker(svg: &mut Svg, low: (f64, f64), high: (f64, f64)) {
    const HALF: f64 = 4.0;
    svg.line("faint s0", low, high);
    for (x, y) in [low, high] {
        svg.line("faint s0", (x - HALF, y), (x + HALF, y));
    }
}

/// Place of a row on the x axis: its number, or the place of its value in the list.
fn place(answer: &Answer, axis: usize) -> impl Fn(usize) -> f64 + '_ {
    let numeric = answer.designs().all(|(_, row)| row.levels[axis].number.is_some());
    move |row: usize| {
        let level = &answer.rows[row].levels[axis];
        let listed = level.choice.unwrap_or(0) as f64;
        if numeric { level.number.unwrap_or(listed) } else { listed }
    }
}

fn groups(answer: &Answer, axis: usize) -> Vec<Group> {
    let place = place(answer, axis);
    let numeric = answer.designs().all(|(_, row)| row.levels[axis].number.is_some());
    // the scene as it is has its own line, unless it is a point of the design
    let done: Vec<usize> = answer.designs().filter(|(_, row)| row.values().is_some()).map(|(index, _)| index).collect();
    let listed = answer.designs().all(|(_, row)| row.levels[axis].choice.is_some());
    let mut groups: Vec<Group> = Vec::new();
    if listed {
        for row in done {
            let x = place(row);
            match groups.iter_mut().find(|g| g.x == x) {
                Some(group) => group.rows.push(row),
                None => {
                    let text = &answer.rows[row].levels[axis].text;
                    let label = if numeric { String::new() } else { text.clone() };
                    groups.push(Group { label, x, rows: vec![row] });
                }
            }
        }
    } else {
        let (low, high) = done.iter().map(|r| place(*r)).fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        let width = ((high - low) / BINS as f64).max(f64::MIN_POSITIVE);
        let bin = |x: f64| (((x - low) / width) as usize).min(BINS - 1);
        let middle = |bin: usize| low + (bin as f64 + 0.5) * width;
        groups = (0..BINS).map(|b| Group { label: String::new(), x: middle(b), rows: Vec::new() }).collect();
        done.iter().for_each(|row| groups[bin(place(*row))].rows.push(*row));
        groups.retain(|g| !g.rows.is_empty());
    }
    groups.sort_by(|a, b| a.x.total_cmp(&b.x));
    groups
}
