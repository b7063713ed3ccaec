//! From the objects of vehicles and trains to the objects of the scenario. Whole vehicles are halved, because the
//! scenario models one rail.

use super::given::{agree, given};
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::along::{Along, along, lay_profile};
use crate::check::places::chainage::Places;
use crate::check::places::cover::Cover;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Direction, Given, Origin, Profile, Train, Vehicle};
use crate::units::{Dimension, number};

/// Turns an axle load stated as a force into a mass, m/s^2.
const STANDARD_GRAVITY: f64 = 9.81;

fn vehicle(record: &Record, findings: &mut Findings) -> Option<Vehicle> {
    let bogie_mass = given(record, "bogie.mass")?;
    let wheel_mass = given(record, "wheelset.mass")?;
    let unsprung = 2.0 * *bogie_mass + 4.0 * *wheel_mass;
    let car_body_mass = car_body_mass(record, unsprung, findings);
    let body = record.record("car_body")?.clone();
    let by_radius = given(&body, "radius_of_gyration")
        .zip(car_body_mass)
        .map(|(r, m)| Given { value: *r * *r * *m, origin: r.origin });
    let inertia = agree(
        &body,
        "pitch inertia",
        &[("pitch_inertia", given(&body, "pitch_inertia")), ("mass * radius_of_gyration^2", by_radius)],
        "kg m^2",
        findings,
    );
    let (car_body_mass, inertia) = (car_body_mass?, inertia?);
    let hertz = match &record.get("contact")?.value {
        Val::Word { arguments, .. } => match arguments.get("constant").map(|s| (&s.value, s.origin)) {
            Some((Val::Number(n), origin)) => Given { value: n.value, origin },
            _ => return None,
        },
        _ => return None,
    };
    Some(Vehicle {
        name: record.name.clone(),
        car_body_mass,
        car_body_pitch_inertia: inertia,
        bogie_mass,
        bogie_pitch_inertia: given(record, "bogie.pitch_inertia")?,
        bogie_spacing: given(record, "bogie.spacing")?,
        wheel_mass,
        wheelset_spacing: given(record, "wheelset.spacing")?,
        wheel_radius: record.number("wheelset.radius")?.value,
        primary_stiffness: given(record, "primary.stiffness")?,
        primary_damping: given(record, "primary.damping")?,
        secondary_stiffness: given(record, "secondary.stiffness")?,
        secondary_damping: given(record, "secondary.damping")?,
        hertz,
        length: given(record, "length"),
    })
    .filter(|v| axles_apart(record, v, findings))
}

/// Checks that bogies do not overlap.
fn axles_apart(record: &Record, vehicle: &Vehicle, findings: &mut Findings) -> bool {
    if *vehicle.bogie_spacing > *vehicle.wheelset_spacing {
        return true;
    }
    let span = vehicle.bogie_spacing.origin.span().unwrap_or(record.span);
    let mut mistake = Diagnostic::new(Code::E0407, "the bogies overlap")
        .label(span, format!("bogie centres {} m apart", number(*vehicle.bogie_spacing)));
    if let Some(other) = vehicle.wheelset_spacing.origin.span() {
        mistake = mistake.label(other, format!("axles of a bogie {} m apart", number(*vehicle.wheelset_spacing)));
    }
    findings.report(mistake);
    false
}

/// The mass of the car body over one rail: given, or computed from the axle load. `unsprung` is the mass of bogies and
/// wheelsets over one rail, kg.
fn car_body_mass(record: &Record, unsprung: f64, findings: &mut Findings) -> Option<Given> {
    let body = given(record, "car_body.mass");
    let Some(load) = record.number("axle_load") else { return body };
    let axle = if load.dimension == Dimension::FORCE { load.value / STANDARD_GRAVITY } else { load.value };
    let span = record.get("axle_load").map_or(record.span, |s| s.span);
    let derived = 2.0 * axle - unsprung;
    let tonnes = |kg: f64| format!("{} t", number((kg / 10.0).round() / 100.0));
    let axle_load = |kg: f64| format!("{} t", number((kg / 100.0).round() / 10.0));
    if let Some(body) = body {
        let by_masses = (*body + unsprung) / 2.0;
        if (by_masses - axle).abs() > 0.02 * axle {
            findings.report(
                Diagnostic::new(
                    Code::E0407,
                    format!(
                        "the masses of `{}` give an axle load of {}, but {} is stated",
                        record.name,
                        axle_load(by_masses),
                        axle_load(axle)
                    ),
                )
                .label(span, format!("{} stated", axle_load(axle)))
                .label(
                    body.origin.span().unwrap_or(record.span),
                    format!(
                        "{} with bogies and wheelsets of {} make {}",
                        tonnes(2.0 * *body),
                        tonnes(2.0 * unsprung),
                        axle_load(by_masses)
                    ),
                )
                .help(format!(
                    "leave out the car body's mass (an axle load of {} needs {}), or leave out `axle_load`",
                    axle_load(axle),
                    tonnes(2.0 * derived)
                )),
            );
            return None;
        }
        return Some(body);
    }
    if derived <= 0.0 {
        findings.report(
            Diagnostic::new(
                Code::E0407,
                format!("an axle load of {} leaves nothing for the car body of `{}`", axle_load(axle), record.name),
            )
            .label(span, format!("bogies and wheelsets alone make {} an axle", tonnes(unsprung / 2.0))),
        );
        return None;
    }
    Some(Given { value: derived, origin: Origin::Derived })
}

/// The largest speed, and the profile along the whole track if the speed varies.
fn speed(record: &Record, places: Option<&Places>, findings: &mut Findings) -> Option<(Given, Option<Profile>)> {
    match along(record, "speed")? {
        Along::Fixed(speed) => Some((speed, None)),
        Along::Varies(shape, origin) => {
            let places = places?;
            let (start, end) = (places.sections.first()?.0, places.sections.last()?.1);
            let what = format!("the speed of train `{}`", record.name);
            let cover = Cover { what, start, end, seats: None, smooth: false };
            let profile = lay_profile(&shape, origin, places, &cover, findings)?;
            // straight or level between knots, so that no larger speed lies between them
            let knots = profile.pieces.iter().flat_map(|piece| piece.knots().into_iter().map(|x| piece.curve.value(x)));
            let value = knots.fold(0.0, f64::max);
            Some((Given { value, origin }, Some(profile)))
        }
    }
}

/// A train, from a complete record; `None` if a diagnostic has been given.
pub(super) fn train(record: &Record, places: Option<&Places>, findings: &mut Findings) -> Option<Train> {
    let speed = speed(record, places, findings);
    let Val::Pairs(pairs) = &record.get("vehicles")?.value else { return None };
    let mut vehicles = Vec::new();
    let mut sound = true;
    for (key, count) in pairs {
        let (Val::Record(record), Val::Number(count)) = (&key.value, &count.value) else { return None };
        match vehicle(record, findings) {
            Some(vehicle) => vehicles.extend(std::iter::repeat_n(vehicle, count.value as usize)),
            None => sound = false,
        }
    }
    if !sound {
        return None;
    }
    if vehicles.is_empty() {
        findings.report(
            Diagnostic::new(Code::E0403, format!("train `{}` has no vehicle", record.name)).label(record.span, "empty"),
        );
        return None;
    }
    if vehicles.len() > 1
        && let Some(short) = vehicles.iter().find(|v| v.length.is_none_or(|l| *l < v.wheel_offsets()[3]))
    {
        let message = match short.length {
            None => format!("vehicle `{}` runs in a train of several and needs its `length`", short.name),
            Some(l) => format!("vehicle `{}` is {} m long, shorter than its wheel base", short.name, number(*l)),
        };
        findings.report(
            Diagnostic::new(Code::E0403, message)
                .label(short.length.and_then(|l| l.origin.span()).unwrap_or(record.span), "length over couplers")
                .help(format!("add a `length` of more than {} m to the vehicle", number(short.wheel_offsets()[3]))),
        );
        return None;
    }
    let direction = match record.word("direction")? {
        "backward" => Direction::Backward,
        "both" => Direction::Both,
        _ => Direction::Forward,
    };
    let (speed, speed_profile) = speed?;
    Some(Train { name: record.name.clone(), vehicles, speed, speed_profile, direction })
}
