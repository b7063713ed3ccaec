//! Whether a profile covers every required place, without a gap.

use super::chainage::{Places, TINY};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::units::number;
use std::ops::Range;

/// The places that a profile must cover.
pub struct Cover {
    /// `the settlement of trackform `open``
    pub what: String,
    pub start: f64,
    pub end: f64,
    /// Seats at which the value is required; every chainage if absent.
    pub seats: Option<Range<usize>>,
    /// Data files are read as smooth curves.
    pub smooth: bool,
}

/// A span in chainage. A span of sleepers reaches half a bay beyond them, and from the last sleeper to the end of the
/// track.
#[derive(Clone, Copy)]
pub struct Interval {
    pub start: f64,
    pub end: f64,
    /// The ends of a ramp over the span: from end sleeper to end sleeper, in the order of the text.
    pub ramp: [f64; 2],
}

/// Whether a profile reaches from one end of the required places to the other.
pub fn covers(
    cover: &Cover,
    places: &Places,
    within: Interval,
    ends: [(f64, Span); 2],
    used: Option<Span>,
    findings: &mut Findings,
) -> Option<()> {
    let [(first, at_first), (last, at_last)] = ends;
    let used = used.map(|span| (span, "read here"));
    let before = no_gap(cover, places, [f64::NEG_INFINITY, first], within, (at_first, "begins here"), used, findings);
    let after = no_gap(cover, places, [last, f64::INFINITY], within, (at_last, "ends here"), used, findings);
    before.and(after)
}

/// Reports required places strictly between two chainages.
pub fn no_gap(
    cover: &Cover,
    places: &Places,
    [from, to]: [f64; 2],
    within: Interval,
    at: (Span, &str),
    second: Option<(Span, &str)>,
    findings: &mut Findings,
) -> Option<()> {
    let (start, end) = (from.max(within.start), to.min(within.end));
    let (left, right) = ((from + TINY).max(within.start - TINY), (to - TINY).min(within.end + TINY));
    let seats: Vec<i32> = match &cover.seats {
        Some(seats) => {
            let seats = &places.seats[seats.clone()];
            let first = seats.partition_point(|seat| seat.0 <= left);
            seats[first..].iter().take_while(|seat| seat.0 < right).map(|seat| seat.3).collect()
        }
        None => Vec::new(),
    };
    let missing = if cover.seats.is_some() { !seats.is_empty() } else { end - start > TINY };
    if !missing {
        return Some(());
    }
    let mut message = format!("{} is not given from {} m to {} m", cover.what, number(start), number(end));
    match (seats.first(), seats.last()) {
        (Some(first), Some(last)) if first == last => message += &format!(" (sleeper {first:+})"),
        (Some(first), Some(last)) => message += &format!(" (sleepers {first:+} .. {last:+})"),
        _ => {}
    }
    let mut mistake = Diagnostic::new(Code::E0506, message)
        .label(at.0, at.1)
        .help("give it there too, or write `ramp(a .. b, over = span)`: its end values hold before and after the span");
    if let Some((span, text)) = second {
        mistake = mistake.label(span, text);
    }
    findings.report(mistake);
    None
}
