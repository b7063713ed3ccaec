//! Test loads: their places and forces.

use super::force::force_history;
use super::given::given;
use crate::check::evaluate::number::Number;
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::check::places::chosen::chainages_at;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Force, Given, RigLoad, Target, Wave};

/// A load at each of its places.
pub fn loads(
    record: &Record,
    places: Option<&Places>,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Vec<RigLoad>> {
    let on = match record.word("on")? {
        "rail" => Target::Rail,
        "bed" => Target::Bed,
        _ => Target::Sleepers,
    };
    let force = match given(record, "strain") {
        Some(strain) => Force::Strain(strain),
        None => acting_force(record, on, files, findings)?,
    };
    let chainages = chainages_at(record, "at", places?, findings)?;
    let confinement = given(record, "confinement");
    let speed = given(record, "speed")?;
    let cycles = record.number("total")?.value as u64;
    let changes = changes(record);
    let places = places?;
    let load = |x: f64| {
        let x = if on == Target::Sleepers { places.seats[places.nearest_seat(x)?].0 } else { x };
        let (name, span, force) = (record.name.clone(), record.span, force.clone());
        Some(RigLoad { name, span, on, x, force, confinement, speed, cycles, changes })
    };
    chainages.into_iter().map(|(x, _)| load(x)).collect()
}

/// The place in the text that makes a load more than a constant force at one place.
fn changes(record: &Record) -> Option<Span> {
    let cyclic = record.get("force").filter(|force| matches!(force.value, Val::Word { .. }));
    let moves = record.get("speed").filter(|speed| matches!(speed.value, Val::Number(n) if n.value > 0.0));
    cyclic.or(moves).map(|slot| slot.span)
}

/// The force of a load, over one rail.
fn acting_force(record: &Record, on: Target, files: &mut Files<'_>, findings: &mut Findings) -> Option<Force> {
    let force = record.get("force")?;
    let mut history = None;
    let of = match &force.value {
        Val::Number(n) => n.basis,
        Val::Word { word, arguments } if word.name == "file" => {
            let forces = force_history(arguments, force.span, files, findings);
            let Some(Val::Text(of)) = arguments.get("per").map(|slot| &slot.value) else {
                if arguments.get("per").is_none() && forces.is_some() {
                    let message = "the forces of a file need a basis";
                    let help = "write `per rail` or `per track`, or on sleepers `per seat` or `per sleeper`, behind it";
                    findings.report(Diagnostic::new(Code::E0304, message).label(force.span, "").help(help));
                }
                return None;
            };
            history = Some(forces?);
            Some(of.as_str())
        }
        Val::Word { arguments, .. } => match arguments.get("range").map(|slot| &slot.value) {
            Some(Val::Range(smallest, _)) => smallest.basis,
            _ => return None,
        },
        _ => return None,
    };
    let (of, on_what) = (of.unwrap_or_default(), record.word("on")?);
    let allowed = if on == Target::Sleepers { ["seat", "sleeper"] } else { ["rail", "track"] };
    if !allowed.contains(&of) {
        let message = format!("a load on the {on_what} is `per {}` or `per {}`", allowed[0], allowed[1]);
        findings.report(Diagnostic::new(Code::E0304, message).label(force.span, format!("per {of}")));
        return None;
    }
    match history {
        // half of a load on the track or on a whole sleeper acts over one rail
        Some(history) => {
            let share = if ["track", "sleeper"].contains(&of) { 0.5 } else { 1.0 };
            Some(Force::History(history.into_iter().map(|[time, force]| [time, share * force]).collect()))
        }
        None => acting(record),
    }
}

/// The force of a load over one rail.
fn acting(record: &Record) -> Option<Force> {
    let Val::Word { arguments, .. } = &record.get("force")?.value else {
        return given(record, "force").map(Force::Constant);
    };
    let range = arguments.get("range")?;
    let (Val::Range(least, most), Val::Number(frequency)) = (&range.value, &arguments.get("frequency")?.value) else {
        return None;
    };
    let of_rail = |n: Number| Given { value: n.of_rail(), origin: range.origin };
    let frequency = Given { value: frequency.value, origin: arguments.get("frequency")?.origin };
    Some(Force::Cyclic { range: [of_rail(*least), of_rail(*most)], frequency, wave: Wave::Sine })
}

/// The largest number of cycles of all cyclic loads.
pub fn cycles(loads: &[Record]) -> Option<u64> {
    let cyclic = loads.iter().filter(|load| matches!(load.get("force").map(|f| &f.value), Some(Val::Word { .. })));
    cyclic.filter_map(|load| load.number("total").map(|n| n.value as u64)).max()
}
