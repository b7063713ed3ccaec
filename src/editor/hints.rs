//! Inlay hints: values that follow from a declaration but are not written in it, such as the axle load from the masses.

use super::view::View;
use crate::check::{Content, ItemId, Object};
use crate::syntax::tree::Declaration;
use crate::units::{Dimension, number, parse_unit};
use lsp_types::{InlayHint, InlayHintKind, InlayHintLabel, InlayHintTooltip, Range};

/// The hints in a part of the text, each after the header of its declaration.
pub fn hints(view: &View, range: Range) -> Vec<InlayHint> {
    let mut out = Vec::new();
    for (id, declaration) in view.declarations() {
        let name = declaration.name.as_ref().unwrap_or(&declaration.kind);
        let end = declaration.base.as_ref().map_or(name.span.end, |base| base.span.end);
        let position = view.lines.position(&view.text, end as usize);
        if position < range.start || range.end < position {
            continue;
        }
        if let Some((text, tip)) = derived(view, id, declaration) {
            out.push(InlayHint {
                position,
                label: InlayHintLabel::String(text),
                kind: Some(InlayHintKind::TYPE),
                tooltip: Some(InlayHintTooltip::String(tip.to_owned())),
                padding_left: Some(true),
                padding_right: Some(true),
                text_edits: None,
                data: None,
            });
        }
    }
    out
}

/// The derived value of a declaration as text, and its formula.
fn derived(view: &View, id: ItemId, declaration: &Declaration) -> Option<(String, &'static str)> {
    let object = view.survey.objects.get(&id)?;
    let says = |path: &str| declaration.fields.iter().any(|field| field.path.text() == path);
    match object.kind.name {
        "vehicle" => vehicle(object),
        "rail" => rail(object),
        "pad" | "support" => damping(object),
        "sleeper" if !says("base_area") => base_area(object),
        "soil" => youngs_modulus(object),
        _ => None,
    }
}

/// The load of an axle from the masses of the vehicle, or the mass of the car body from the load.
fn vehicle(object: &Object) -> Option<(String, &'static str)> {
    let (bogie, wheelset) = (object.number(&["bogie", "mass"])?, object.number(&["wheelset", "mass"])?);
    let unsprung = 2.0 * bogie + 4.0 * wheelset;
    let tonnes = |kg: f64| format!("{} t", number((kg / 10.0).round() / 100.0));
    if let Some(load) = object.held(&["axle_load"]) {
        let Content::Number { of_rail: load, dimension, .. } = load.content else { return None };
        let axle = if dimension == Dimension::FORCE { load / 9.81 } else { load };
        let body = 2.0 * (2.0 * axle - unsprung);
        return (body > 0.0).then(|| {
            (
                format!("car body {}", tonnes(body)),
                "mass of the car body of the whole vehicle that follows from the axle load",
            )
        });
    }
    let body = object.number(&["car_body", "mass"])?;
    let axle = (body + unsprung) / 2.0;
    Some((format!("axle load {}", tonnes(axle)), "mass of car body, bogies and wheelsets / four axles"))
}

fn rail(object: &Object) -> Option<(String, &'static str)> {
    let bending = object.number(&["youngs_modulus"]).zip(object.number(&["second_moment"]));
    let mass = object.number(&["density"]).zip(object.number(&["area"]));
    let bending = bending.map(|(e, i)| format!("EI {}", rounded(e * i, "MN m^2")));
    let mass = mass.map(|(density, area)| rounded(density * area, "kg/m"));
    let said: Vec<String> = bending.into_iter().chain(mass).collect();
    (!said.is_empty()).then(|| (said.join(", "), "Young's modulus x second moment, density x area"))
}

fn damping(object: &Object) -> Option<(String, &'static str)> {
    if object.held(&["damping"]).is_some() {
        return None;
    }
    let (stiffness, time) = (object.number(&["stiffness"])?, object.number(&["damping_time"])?);
    let per = if object.kind.name == "support" { " per seat" } else { "" };
    Some((format!("damping {}{per}", rounded(stiffness * time, "kN s/m")), "stiffness x damping time"))
}

fn base_area(object: &Object) -> Option<(String, &'static str)> {
    if object.held(&["base_area"]).is_some() {
        return None;
    }
    let (length, width) = (object.number(&["length"])?, object.number(&["base_width"])?);
    Some((format!("base {}", rounded(length * width, "m^2")), "length x base width"))
}

fn youngs_modulus(object: &Object) -> Option<(String, &'static str)> {
    let (bulk, shear) = (object.number(&["bulk_modulus"])?, object.number(&["shear_modulus"])?);
    let modulus = 9.0 * bulk * shear / (3.0 * bulk + shear);
    Some((format!("E {}", rounded(modulus, "MPa")), "9 K G / (3 K + G)"))
}

/// A value in SI with three digits, in a unit.
fn rounded(value: f64, unit: &str) -> String {
    let factor = parse_unit(unit).map_or(1.0, |unit| unit.factor);
    let digits: f64 = format!("{:.2e}", value / factor).parse().unwrap_or(value / factor);
    format!("{} {unit}", number(digits))
}
