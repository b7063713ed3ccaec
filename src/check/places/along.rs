//! Lays profiles along a track: converts their places to chainages and checks that they give each required place
//! exactly once.

use super::chainage::{Places, TINY};
use super::cover::{Cover, Interval, covers, no_gap};
use super::scatter::{Scatter, random_curve};
use crate::check::evaluate::number::Number;
use crate::check::evaluate::shape::{Reach, Shape, ShapeKind};
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Curve, Given, Origin, Piece, Profile, Varying};
use crate::units::{Dimension, number};
use std::rc::Rc;

/// A field that may vary along the track, as written.
#[derive(Clone)]
pub enum Along {
    Fixed(Given),
    Varies(Rc<Shape>, Origin),
}

/// The same, laid along the track.
pub enum Laid {
    Fixed(Given),
    Varies(Profile),
}

impl Laid {
    /// The value at a chainage, m.
    pub fn value_at(&self, x: f64) -> Given {
        match self {
            Laid::Fixed(given) => *given,
            Laid::Varies(profile) => Given { value: profile.value(x), origin: profile.origin },
        }
    }
}

impl From<Laid> for Varying {
    fn from(laid: Laid) -> Varying {
        match laid {
            Laid::Fixed(given) => Varying::Constant(given),
            Laid::Varies(profile) => Varying::Profile(profile),
        }
    }
}

/// A field that may vary; `None` if it is not given or not understood.
pub fn along(record: &Record, field: &str) -> Option<Along> {
    let slot = record.slot(field)?;
    match &slot.value {
        Val::Number(n) => Some(Along::Fixed(Given { value: n.of_rail(), origin: slot.origin })),
        Val::Profile(shape) => Some(Along::Varies(shape.clone(), slot.origin)),
        _ => None,
    }
}

/// Lays a field along the track; `None` if a diagnostic has been given.
pub fn lay(along: &Along, places: &Places, cover: &Cover, findings: &mut Findings) -> Option<Laid> {
    match along {
        Along::Fixed(given) => Some(Laid::Fixed(*given)),
        Along::Varies(shape, origin) => lay_profile(shape, *origin, places, cover, findings).map(Laid::Varies),
    }
}

/// Lays a profile along the track and checks that it covers the required places; `None` if a diagnostic has been given.
pub fn lay_profile(
    shape: &Shape,
    origin: Origin,
    places: &Places,
    cover: &Cover,
    findings: &mut Findings,
) -> Option<Profile> {
    let whole = Interval { start: cover.start, end: cover.end, ramp: [cover.start, cover.end] };
    let pieces = lay_pieces(shape, places, cover, whole, findings)?;
    Some(Profile { pieces, origin })
}

/// The part of a shape that lies in an interval.
fn lay_pieces(
    shape: &Shape,
    places: &Places,
    cover: &Cover,
    within: Interval,
    findings: &mut Findings,
) -> Option<Vec<Piece>> {
    let within = Interval { ramp: shape.runs.unwrap_or(within.ramp), ..within };
    let curve = match &shape.kind {
        ShapeKind::Constant(n) => Curve::constant(n.of_rail()),
        ShapeKind::Ramp { from, to, smooth, over } => {
            let ramp = match over {
                Some(reach) => interval_of(places, reach, shape.from, findings)?.ramp,
                None => within.ramp,
            };
            ramp_curve(ramp, from.of_rail(), to.of_rail(), *smooth, shape.span, findings)?
        }
        ShapeKind::Random(random) => {
            let seats = cover.seats.as_ref().map(|seats| {
                let inside = |x: &f64| (within.start - TINY..=within.end + TINY).contains(x);
                places.seats[seats.clone()].iter().map(|seat| seat.0).filter(inside).collect()
            });
            let at = Scatter { start: within.start, end: within.end, seats, span: shape.span };
            random_curve(random, places.seed, cover, &at, findings)?
        }
        ShapeKind::Points(points) => {
            let found = chainages_of(points, places, shape.from, findings)?;
            Curve::Linear(lay_points(points, found, places, cover, within, findings)?)
        }
        ShapeKind::Table { rows, ends, .. } => {
            let ends = [(rows.first()?.0, ends[0]), (rows.last()?.0, ends[1])];
            covers(cover, places, within, ends, Some(shape.span), findings)?;
            let points: Vec<[f64; 2]> = rows.iter().map(|(x, n)| [*x, n.of_rail()]).collect();
            if cover.smooth { Curve::natural(&points) } else { Curve::Linear(points) }
        }
        ShapeKind::Spans(spans) => return lay_spans(spans, shape.from, places, cover, within, findings),
    };
    Some(vec![Piece { start: within.start, end: within.end, curve }])
}

fn ramp_curve(
    [first, last]: [f64; 2],
    from: f64,
    to: f64,
    smooth: bool,
    span: Span,
    findings: &mut Findings,
) -> Option<Curve> {
    if (first - last).abs() < TINY {
        if from == to {
            return Some(Curve::constant(from));
        }
        findings.report(
            Diagnostic::new(Code::E0505, "a ramp runs over a distance, not at one place")
                .label(span, format!("begins and ends at {} m", number(first))),
        );
        return None;
    }
    let ends = if first < last { [[first, from], [last, to]] } else { [[last, to], [first, from]] };
    Some(if smooth { Curve::Level(ends) } else { Curve::Linear(ends.to_vec()) })
}

/// Places and values of points, as written.
fn chainages_of(
    points: &[(Number, Span, Number)],
    places: &Places,
    from: Option<usize>,
    findings: &mut Findings,
) -> Option<Vec<([f64; 2], Span)>> {
    let mut found = Vec::with_capacity(points.len());
    for (place, span, value) in points {
        found.push(([profile_place(places, *place, from, *span, findings)?.0, value.of_rail()], *span));
    }
    Some(found)
}

/// Points by ascending chainage; in the text they ascend or descend.
fn lay_points(
    points: &[(Number, Span, Number)],
    mut found: Vec<([f64; 2], Span)>,
    places: &Places,
    cover: &Cover,
    within: Interval,
    findings: &mut Findings,
) -> Option<Vec<[f64; 2]>> {
    if found.len() > 1 && found[0].0[0] > found[1].0[0] {
        found.reverse();
    }
    for pair in found.windows(2) {
        let [(a, first), (b, second)] = [pair[0], pair[1]];
        if b[0] - a[0] < TINY {
            let same = (b[0] - a[0]).abs() < TINY;
            let message = if same {
                "one place has two values"
            } else {
                "the places of a profile must follow each other in order"
            };
            findings.report(
                Diagnostic::new(Code::E0507, message)
                    .label(first.max(second), if same { "again here" } else { "goes back from here" })
                    .label(first.min(second), if same { "first here" } else { "the place before" }),
            );
            return None;
        }
    }
    let by_seats = points.iter().all(|(place, ..)| place.dimension == Dimension::SLEEPERS);
    let every = Cover { what: cover.what.clone(), seats: Some(0..places.seats.len()), ..*cover };
    let asked = if by_seats && cover.seats.is_none() { &every } else { cover };
    let ends = [found.first()?, found.last()?].map(|(point, span)| (point[0], *span));
    covers(asked, places, within, ends, None, findings)?;
    Some(found.into_iter().map(|(point, _)| point).collect())
}

/// Pieces side by side, without gap or overlap at the required places.
fn lay_spans(
    spans: &[(Reach, Shape)],
    from: Option<usize>,
    places: &Places,
    cover: &Cover,
    within: Interval,
    findings: &mut Findings,
) -> Option<Vec<Piece>> {
    let mut laid = Vec::with_capacity(spans.len());
    for (reach, shape) in spans {
        laid.push((interval_of(places, reach, from, findings)?, reach.span, shape));
    }
    laid.sort_by(|a, b| a.0.start.total_cmp(&b.0.start));
    for pair in laid.windows(2) {
        let [(a, first, _), (b, second, _)] = [pair[0], pair[1]];
        if b.start < a.end - TINY {
            let (from, to) = (b.start, a.end.min(b.end));
            let message = format!("{} is given twice from {} m to {} m", cover.what, number(from), number(to));
            findings.report(
                Diagnostic::new(Code::E0507, message)
                    .label(first.max(second), "overlaps")
                    .label(first.min(second), "first given here"),
            );
            return None;
        }
        no_gap(cover, places, [a.end, b.start], within, (second, "begins here"), Some((first, "ends here")), findings)?;
    }
    let ends = [laid.first()?, laid.last()?].map(|(i, span, _)| (*i, *span));
    covers(cover, places, within, [(ends[0].0.start, ends[0].1), (ends[1].0.end, ends[1].1)], None, findings)?;
    let mut pieces = Vec::new();
    let mut sound = true;
    for (interval, _, shape) in laid {
        let start = interval.start.max(within.start);
        let end = interval.end.min(within.end);
        // a place that is only touched belongs to the other side
        if end - start < TINY {
            continue;
        }
        match lay_pieces(shape, places, cover, Interval { start, end, ..interval }, findings) {
            Some(found) => pieces.extend(found),
            None => sound = false,
        }
    }
    Some(pieces).filter(|pieces| sound && !pieces.is_empty())
}

fn interval_of(places: &Places, reach: &Reach, from: Option<usize>, findings: &mut Findings) -> Option<Interval> {
    let (a, first) = profile_place(places, reach.from, from, reach.span, findings)?;
    let (b, last) = profile_place(places, reach.to, from, reach.span, findings)?;
    let (start, end) = match (first, last) {
        (Some(i), Some(j)) => (places.cell(i.min(j)).0, places.cell(i.max(j)).1),
        _ => (a.min(b), a.max(b)),
    };
    Some(Interval { start, end, ramp: [a, b] })
}

/// Chainage of a place in a profile, and its seat if it is a seat. The place counts from the transition of its stretch,
/// or from the only transition; with several transitions it is a chainage in metres.
fn profile_place(
    places: &Places,
    at: Number,
    from: Option<usize>,
    span: Span,
    findings: &mut Findings,
) -> Option<(f64, Option<usize>)> {
    let sleepers = at.dimension == Dimension::SLEEPERS;
    if let Some(transition) = from.or((places.transitions.len() < 2).then_some(0)) {
        let x = places.chainage_from(at, transition, span, findings)?;
        return Some((x, places.seat(transition, at.value).filter(|_| sleepers)));
    }
    if sleepers {
        findings.report(
            Diagnostic::new(Code::E0504, "on a track with several transitions several sleepers have the same number")
                .label(span, "the transition is not named")
                .help("give the places of a profile in metres of chainage: x = 0 is the first transition"),
        );
        return None;
    }
    let (start, end) = (places.sections.first()?.0, places.sections.last()?.1);
    if at.value < start - TINY || at.value > end + TINY {
        let message = format!("the track reaches from {} m to {} m", number(start), number(end));
        let label = format!("x = {} m is off the track", number(at.value));
        findings.report(Diagnostic::new(Code::E0501, message).label(span, label));
        return None;
    }
    Some((at.value, None))
}
