//! The softer side of each boundary: as declared, or as computed for a help if it is not declared.

use super::asked::Asked;
use super::ground::{Carrying, Under};
use super::layers::lay_layers;
use super::seats::lay_seats;
use super::trackform::Built;
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::geometry::{Plan, lay_out};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Foot, Given, Side, point_stiffness, seat_stiffness};
use crate::solvers::foundation::{self, Below, Method};

/// Name and side of every boundary between sections; `None` if they are required but not declared. The sections that
/// are understood are used for the help.
pub fn sides(
    record: &Record,
    sections: usize,
    built: &[Built],
    plans: &[Plan],
    asked: Asked,
    findings: &mut Findings,
) -> Option<Vec<(String, Side)>> {
    let boundaries = sections.saturating_sub(1);
    let Some(slot) = record.get("transitions") else {
        if boundaries < 2 {
            return Some(vec![(String::new(), Side::SoftToStiff); boundaries]);
        }
        if !record.partial {
            let message =
                format!("{sections} sections have {boundaries} transitions: declare the side of each transition");
            findings.report(
                Diagnostic::new(Code::E0504, message).label(record.span, "no `transitions` given").help(offer(
                    &[],
                    boundaries,
                    built,
                    plans,
                    asked,
                )),
            );
        }
        return None;
    };
    let Val::Pairs(pairs) = &slot.value else { return None };
    let names: Vec<(&str, Span)> = pairs
        .iter()
        .filter_map(|(name, _)| if let Val::Text(text) = &name.value { Some((text.as_str(), name.span)) } else { None })
        .collect();
    if pairs.len() != boundaries {
        let message = format!("{sections} sections have {boundaries} transitions, found {}", pairs.len());
        let mut mistake = Diagnostic::new(Code::E0504, message).label(slot.span, "one for each inner boundary");
        if boundaries > 0 {
            mistake = mistake.help(offer(&names, boundaries, built, plans, asked));
        }
        findings.report(mistake);
        return None;
    }
    let twice = names.iter().enumerate().find_map(|(i, name)| {
        let first = names[..i].iter().find(|first| first.0 == name.0)?;
        Some((*first, *name))
    });
    if let Some(((name, first), (_, again))) = twice {
        findings.report(
            Diagnostic::new(Code::E0202, format!("two transitions are called `{name}`"))
                .label(again, "again here")
                .label(first, "first here"),
        );
        return None;
    }
    let declared = pairs.iter().map(|(name, side)| match (&name.value, &side.value) {
        (Val::Text(name), Val::Word { word, .. }) => Some((name.clone(), Side::of_word(word.name)?)),
        _ => None,
    });
    declared.collect()
}

/// The line to write, with sides from the stiffness under the pads; existing names are kept.
fn offer(names: &[(&str, Span)], boundaries: usize, built: &[Built], plans: &[Plan], asked: Asked) -> String {
    let stiffnesses: Option<Vec<f64>> =
        built.iter().zip(plans).map(|(built, plan)| stiffness(built, plan, asked)).collect();
    let called = |boundary: usize| match (names.get(boundary), boundaries) {
        (Some((name, _)), _) => (*name).to_owned(),
        (None, 1) => "edge".to_owned(),
        (None, 2) => ["west", "east"][boundary].to_owned(),
        _ => format!("t{}", boundary + 1),
    };
    let line = |side: &dyn Fn(usize) -> Side| {
        let pairs = (0..boundaries).map(|b| format!("{}: {}", called(b), side(b).word()));
        format!("transitions = [{}]", pairs.collect::<Vec<_>>().join(", "))
    };
    match stiffnesses.filter(|known| known.len() == boundaries + 1) {
        Some(stiffness) => {
            let computed = |b: usize| match stiffness[b + 1] >= stiffness[b] {
                true => Side::SoftToStiff,
                false => Side::StiffToSoft,
            };
            let mut shown: Vec<String> = Vec::new();
            for (built, stiffness) in built.iter().zip(&stiffness) {
                let of_form = format!("{} on `{}`", seat_stiffness(*stiffness), built.name);
                if !shown.contains(&of_form) {
                    shown.push(of_form);
                }
            }
            format!("write `{}`: the stiffness under the pads is about {}", line(&computed), shown.join(", "))
        }
        None => format!(
            "name each and give its side, such as `{}`: `soft_to_stiff` means a softer track before the boundary",
            line(&|b| if b % 2 == 0 { Side::StiffToSoft } else { Side::SoftToStiff })
        ),
    }
}

/// The stiffness, N/m, of the ground or of the structure under one seat of a trackform. The seat lies in its middle,
/// without other sections beside it. Pads are left out, since soft pads lie on structures to hide their stiffness.
/// `None` if the stiffness is not known.
fn stiffness(built: &Built, plan: &Plan, asked: Asked) -> Option<f64> {
    // mistakes of the trackform are reported when it is built
    let mut aside = Findings::default();
    let alone = Plan { name: plan.name.clone(), bays: Default::default(), first: Default::default(), ..*plan };
    let places = lay_out(&[alone], &[], 1, &mut aside)?;
    let layers = lay_layers(built, &places, 0, &mut aside)?;
    let middle = places.seats.len() / 2;
    // the time affects only dampers
    let carrying = Carrying { asked, damping_time: Some(Given::derived(0.0)) };
    let under = Under::Section(Some(&layers));
    let seats = lay_seats(built, &places, 0, middle..middle + 1, under, carrying, &mut aside)?;
    let seat = seats.first()?;
    match (&seat.foot, &built.slab, &seat.stack) {
        (Foot::Rigid, ..) => Some(f64::INFINITY),
        (Foot::Slab, Some(slab), _) => Some(point_stiffness(*slab.foundation_stiffness, *slab.bending_stiffness)),
        (Foot::Sleeper { support: Some(support), .. }, ..) => Some(*support.stiffness),
        (Foot::Sleeper { support: None, .. }, _, Some(stack)) => {
            foundation::support(&stack.bearing, &stack.layers, Below::Rigid, Method::StressCone)
                .ok()
                .map(|s| s.stiffness)
        }
        _ => None,
    }
}
