//! Differences of repeated points from the scene as it is, each with its 95 % interval.

use super::plane::{Plane, cut, range, titled};
use crate::report::curves::{Mark, Series};
use crate::report::svg::{Anchor, Frame, Svg};
use crate::scenario::Measured;
use crate::study::{Answer, Difference, Row};

const WIDTH: f64 = 960.0;
const GAP: f64 = 18.0;
/// Width of the names of the points.
const NAMES: f64 = 210.0;
/// Panels beside each other, at most.
const ACROSS: usize = 3;
/// Height of a point, and room above and below the points of a panel.
const ROW: f64 = 22.0;
const ABOVE: f64 = 26.0;
const BELOW: f64 = 48.0;
/// More points are not shown.
const MOST: usize = 40;

/// A difference and half the width of its interval, as the panel shows them: shares in percent, or in the unit.
type Shown = (f64, f64);

/// The picture with its caption; none if nothing is repeated, or there is nothing to compare.
pub(super) fn differences(answer: &Answer) -> Option<(String, String)> {
    let measured = answer.study.measured();
    let rows: Vec<&Row> =
        answer.rows.iter().filter(|row| !row.as_it_is && answer.difference(row, 0).is_some()).collect();
    if !answer.study.repeats.are_several() || rows.is_empty() || rows.len() > MOST {
        return None;
    }
    let beside = measured.len().min(ACROSS);
    let width = (WIDTH - NAMES - GAP * beside as f64) / beside as f64;
    let height = ABOVE + ROW * rows.len() as f64 + BELOW;
    let mut svg = Svg::default();
    for (index, what) in measured.iter().enumerate() {
        let (line, place) = (index / beside, index % beside);
        let top = line as f64 * height;
        if place == 0 {
            names(&mut svg, answer, &rows, top + ABOVE);
        }
        let frame = Frame { x: NAMES + GAP + place as f64 * (width + GAP), y: top, width, height };
        svg.group(r#"class="chart""#, |svg| panel(svg, answer, (index, what), &rows, frame));
    }
    let caption = "Each point against the scene as it is on the same packings. Dots: mean of the differences. Whiskers: \
                   its 95 % interval. A point whose whisker crosses the dashed line may be no different.";
    let height = measured.len().div_ceil(beside) as f64 * height;
    Some((svg.finish(WIDTH, height, "Differences from the scene as it is"), caption.to_owned()))
}

fn names(svg: &mut Svg, answer: &Answer, rows: &[&Row], top: f64) {
    for (place, row) in rows.iter().enumerate() {
        let values: Vec<&str> = row.levels.iter().map(|level| level.text.as_str()).collect();
        let name = format!("{}: {}", row.number, values.join(", "));
        let best = answer.best().iter().any(|index| answer.rows[*index].number == row.number);
        let class = if best { "strong" } else { "small" };
        svg.text(class, (NAMES, top + ROW * (place as f64 + 0.5) + 4.0), Anchor::End, &cut(&name, 32));
    }
}

fn panel(svg: &mut Svg, answer: &Answer, (index, what): (usize, &Measured), rows: &[&Row], frame: Frame) {
    let all: Vec<Option<Difference>> = rows.iter().map(|row| answer.difference(row, index)).collect();
    let in_percent = all.iter().flatten().all(|difference| difference.share.is_some());
    let shown = |difference: &Difference| -> Shown {
        let size = match difference.share {
            Some(share) if in_percent && difference.of != 0.0 => 100.0 * share / difference.of,
            _ if in_percent => 0.0,
            _ => 1.0 / what.unit.1,
        };
        (difference.of * size, difference.half.unwrap_or(0.0) * size.abs())
    };
    let shown: Vec<Option<Shown>> = all.iter().map(|difference| difference.as_ref().map(shown)).collect();
    let ends = shown.iter().flatten().flat_map(|(of, half)| [of - half, of + half]);
    let plane = Plane {
        frame: Frame { x: frame.x, y: frame.y + ABOVE, width: frame.width, height: ROW * rows.len() as f64 },
        x: range(ends.chain([0.0])),
        y: (rows.len() as f64, 0.0),
    };
    let unit = if in_percent { "%" } else { what.unit.0.as_str() };
    svg.text("strong", (frame.x, frame.y + 13.0), Anchor::Start, &cut(&what.text, (frame.width / 7.8) as usize));
    plane.level_scale(svg);
    let Frame { x: left, y: top, width, height } = plane.frame;
    svg.line("axis", (left, top + height), (left + width, top + height));
    svg.text("small", (left + width / 2.0, top + height + 34.0), Anchor::Middle, &titled("difference", unit));
    let zero = plane.point((0.0, 0.0)).0;
    svg.path("mark", &[(zero, top), (zero, top + height)], false, "as it is");
    let at = |place: usize, x: f64| plane.point((x, place as f64 + 0.5));
    let points = shown.iter().enumerate().filter_map(|(place, shown)| Some((place, (*shown)?)));
    let points: Vec<(usize, Shown)> = points.collect();
    let series = Series {
        labels: points.iter().map(|(place, _)| rows[*place].name()).collect(),
        ..Series::new(
            "difference",
            "s0",
            Mark::Dots,
            points.iter().map(|(place, (of, _))| (*of, *place as f64 + 0.5)).collect(),
        )
    };
    plane.readings(svg, [("difference", unit), ("place", "")], vec![series]);
    svg.group(r#"class="series" data-series="0""#, |svg| {
        for (place, (of, half)) in points {
            let text = all[place].map_or(String::new(), |difference| difference.text(what));
            svg.line("line s0", at(place, of - half), at(place, of + half));
            svg.circle("dot s0", at(place, of), 4.0, &format!("{}: {text}", rows[place].name()));
        }
    });
}
