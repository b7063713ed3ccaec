//! The Pareto front of the first two objectives.

use super::plane::{Plane, range, titled};
use crate::report::curves::{Mark, Series};
use crate::report::svg::{Anchor, Frame, Svg};
use crate::scenario::{Goal, Objective};
use crate::study::{Answer, Row};

const SIZE: (f64, f64) = (960.0, 430.0);

/// The picture with its caption; none if there is one objective.
pub(super) fn pareto(answer: &Answer) -> Option<(String, String)> {
    let [first, second, ..] = answer.study.objectives.as_slice() else { return None };
    let measured = answer.study.measured();
    let index = |o: &Objective| measured.iter().position(|m| m.text == o.of.text);
    let (a, b) = (index(first)?, index(second)?);
    let at = |row: &Row| row.values().map(|v| (v[a] / first.of.unit.1, v[b] / second.of.unit.1));
    let places: Vec<(f64, f64)> = answer.rows.iter().filter_map(at).collect();
    if places.is_empty() {
        return None;
    }
    let mut svg = Svg::default();
    let plane = Plane {
        frame: Frame { x: 70.0, y: 34.0, width: SIZE.0 - 90.0, height: SIZE.1 - 86.0 },
        x: range(places.iter().map(|p| p.0)),
        y: range(places.iter().map(|p| p.1)),
    };
    svg.group(r#"class="chart""#, |svg| {
        svg.text("strong", (6.0, 16.0), Anchor::Start, &aimed(second));
        plane.upright_scale(svg);
        plane.level_scale(svg);
        let below = (plane.frame.x + plane.frame.width / 2.0, SIZE.1 - 12.0);
        svg.text("strong", below, Anchor::Middle, &aimed(first));
        points(svg, answer, &plane, [first, second], at);
    });
    let ring = if answer.as_it_is().is_some() { " The ring is the scene as it is." } else { "" };
    let caption = "Every point by its first two objectives. Large dots with their number: no other point is better in \
                   every objective. Hollow dots miss a constraint."
        .to_owned()
        + ring;
    Some((svg.finish(SIZE.0, SIZE.1, "Pareto front"), caption))
}

/// Every point, and the line through the best.
fn points(
    svg: &mut Svg,
    answer: &Answer,
    plane: &Plane,
    [first, second]: [&Objective; 2],
    at: impl Fn(&Row) -> Option<(f64, f64)>,
) {
    let done = || answer.rows.iter().filter_map(|row| Some((row, at(row)?)));
    let series = Series {
        labels: done().map(|(row, _)| row.name()).collect(),
        ..Series::new("point", "s0", Mark::Dots, done().map(|(_, place)| place).collect())
    };
    let names = [first, second].map(|objective| (objective.of.text.as_str(), &*objective.of.unit.0));
    plane.readings(svg, names, vec![series]);
    let best = answer.best();
    let front: Vec<(f64, f64)> = best.iter().filter_map(|i| at(&answer.rows[*i])).map(|p| plane.point(p)).collect();
    svg.path("frontier", &front, false, "");
    svg.group(r#"class="series" data-series="0""#, |svg| {
        for (index, row) in answer.rows.iter().enumerate() {
            let Some(place) = at(row) else { continue };
            let (x, y) = plane.point(place);
            if row.as_it_is {
                svg.circle("ring", (x, y), 8.0, "the scene as it is");
                svg.text("small halo", (x, y + 21.0), Anchor::Middle, "as it is");
            }
            if !row.designed() {
                continue;
            }
            let text = format!("point {}: {}", row.number, answer.lines(row).join(", "));
            match (best.contains(&index), row.feasible()) {
                (true, _) => {
                    svg.circle("dot s1", (x, y), 5.5, &text);
                    svg.text("small halo", (x + 9.0, y - 7.0), Anchor::Start, &row.number.to_string());
                }
                (false, true) => svg.circle("dot s0", (x, y), 3.5, &text),
                (false, false) => svg.circle("hollow s0", (x, y), 3.5, &text),
            }
        }
    });
}

/// `max(settlement) [mm], the smaller the better`
fn aimed(objective: &Objective) -> String {
    let better = if objective.goal == Goal::Minimise { "smaller" } else { "larger" };
    format!("{}, the {better} the better", titled(&objective.of.text, &objective.of.unit.0))
}
