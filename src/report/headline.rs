//! The table at the head of the page: the most important results, their places and their limits.

use super::limits;
use super::number::{plain, shown_unit, significant, whole};
use super::svg::escape;
use crate::results::{RailRow, Run, SleeperRow, TrainRow, mean_wheel_load, worst_train};
use crate::scenario::Loading;
use std::fmt::Write;

/// One line of the table.
struct Line {
    name: &'static str,
    value: String,
    /// Its place, or its reference.
    place: String,
    limit: String,
    /// Whether the limit is kept, where there is one.
    kept: Option<bool>,
}

/// Writes the table; nothing if the run has no numbers.
pub fn headline(html: &mut String, run: &Run) {
    let lines = match run.scenario.loading {
        Some(Loading::Static(_)) => static_lines(run),
        _ => settlement_lines(run).into_iter().chain(force_lines(run)).chain(rail_lines(run)).collect(),
    };
    if lines.is_empty() {
        return;
    }
    let after = run.summary.scalars.get("axles").map_or(0.0, |s| s.value) as u64;
    let caption = match run.scenario.loading {
        Some(Loading::Static(_)) => "Under the test loads, per rail.".to_owned(),
        _ => format!("After {} axles. Forces and moments are the extremes of one passage, for one rail.", whole(after)),
    };
    let limited = lines.iter().any(|line| !line.limit.is_empty());
    let against = if limited { "limit" } else { "" };
    let _ = write!(
        html,
        "<section id=\"headline\"><h2>At a glance</h2><p class=\"caption\">{caption}</p><div class=\"scroll\"><table \
         class=\"wide\"><thead><tr><th class=\"text\">quantity</th><th>value</th><th class=\"text\">where</th><th \
         class=\"text\">{against}</th><th class=\"text\"></th></tr></thead><tbody>"
    );
    for line in &lines {
        let (class, word) = match line.kept {
            Some(true) => ("good", "\u{2713} within"),
            Some(false) => ("bad", "\u{2717} beyond"),
            None => ("", ""),
        };
        let _ = write!(
            html,
            "<tr><td class=\"text\">{}</td><td><b>{}</b></td><td class=\"text\">{}</td><td class=\"text\">{}</td>\
             <td class=\"text {class}\">{word}</td></tr>",
            line.name,
            escape(&line.value),
            escape(&line.place),
            escape(&line.limit)
        );
    }
    *html += "</tbody></table></div>";
    if limited {
        *html += "<p class=\"note\">The limits are commonly quoted values and were not checked against the standards. \
                  The owner of the line decides which limits apply.</p>";
    }
    *html += "</section>\n";
}

fn scalar(run: &Run, name: &str) -> Option<f64> {
    run.summary.scalars.get(name).map(|s| s.value).filter(|value| value.is_finite())
}

/// A scalar as text with its shown unit.
fn amount(value: f64, unit: &str) -> String {
    let (shown, size) = shown_unit(unit);
    format!("{} {shown}", significant(value / size, 3)).trim_end().to_owned()
}

fn line(name: &'static str, value: Option<f64>, unit: &str, place: String) -> Option<Line> {
    Some(Line { name, value: amount(value?, unit), place, limit: String::new(), kept: None })
}

/// The row of the last count with the largest value, as `sleeper -3, -1.8 m`.
fn at_largest(run: &Run, value: fn(&SleeperRow) -> f64) -> String {
    let last = run.sleepers.iter().map(|row| row.axles).max();
    let rows = run.sleepers.iter().filter(|row| Some(row.axles) == last && value(row).is_finite());
    let row = SleeperRow::that_count(rows).into_iter().max_by(|a, b| value(a).total_cmp(&value(b)));
    row.map_or(String::new(), |row| format!("seat {}, {} m", row.sleeper.replace('-', "\u{2212}"), plain(row.x_m, 4)))
}

fn last_profile(run: &Run) -> Vec<&RailRow> {
    let last = run.rail.iter().map(|row| row.axles).max();
    run.rail.iter().filter(|row| Some(row.axles) == last).collect()
}

fn settlement_lines(run: &Run) -> Vec<Line> {
    let far = scalar(run, "far_field_settlement").map(|far| format!("far field {}", amount(far, "m")));
    let voids = scalar(run, "voided_sleepers").map(|count| Line {
        name: "Hanging sleepers",
        value: whole(count as u64),
        place: match scalar(run, "max_void") {
            Some(void) if count > 0.0 => {
                format!("largest void {} under {}", amount(void, "m"), at_largest(run, |row| row.void_m))
            }
            _ => String::new(),
        },
        limit: String::new(),
        kept: None,
    });
    let lines = [
        line("Step at the structure", scalar(run, "settlement_step"), "m", step_place(run)),
        line("Change of level, wheelbase", scalar(run, "level_change_wheelbase"), "m", "unloaded rail".to_owned()),
        line("Change of level over 3 m", scalar(run, "level_change_3m"), "m", "unloaded rail".to_owned()),
        line("Largest settlement", scalar(run, "max_settlement"), "m", at_largest(run, |row| row.settlement_m)),
        line("Settlement below the far field", scalar(run, "differential_settlement"), "m", far.unwrap_or_default()),
        voids,
        broken_bonds(run),
    ];
    lines.into_iter().flatten().collect()
}

/// Number of broken bonds of glued grains, if there are any bonds.
fn broken_bonds(run: &Run) -> Option<Line> {
    let bonds = run.blocks.last()?.bonds();
    let share = scalar(run, "broken_bonds_share")?;
    Some(Line {
        name: "Broken bonds",
        value: whole(bonds.broken),
        place: format!("{} % of {} bonds between glued grains", significant(100.0 * share, 2), whole(bonds.made())),
        limit: String::new(),
        kept: None,
    })
}

/// The lower side of the step, and its transition if there are several.
fn step_place(run: &Run) -> String {
    let Some(step) = scalar(run, "settlement_step") else { return String::new() };
    let lower = if step >= 0.0 { "the softer side lies lower" } else { "the stiffer side lies lower" };
    let named = run.scenario.track.transitions.iter().map(|transition| &transition.name);
    let of_name = |name: &&String| scalar(run, &format!("settlement_step_{name}")) == Some(step);
    let at = named.filter(|name| !name.is_empty()).find(of_name).map_or(String::new(), |name| format!(", at {name}"));
    let laws = run.scenario.driving_laws();
    let why = match laws.first().filter(|law| step < 0.0 && law.law.knows_forces_alone()) {
        Some(law) => format!(
            ": law {} uses only the forces on the ballast, which are larger there; it does not model the \
            subgrade",
            law.name
        ),
        None => String::new(),
    };
    format!("{lower}{at}{why}")
}

fn force_lines(run: &Run) -> Vec<Line> {
    let mut lines = Vec::new();
    if let Some(force) = scalar(run, "max_wheel_force") {
        let row = worst_train(&run.trains, |row| row.max_wheel_force_N);
        lines.push(Line {
            name: "Largest wheel force",
            value: amount(force, "N"),
            place: row.map_or(String::new(), |row| times_static(run, row)),
            limit: format!("{} kN (EN 14363)", plain(limits::WHEEL_FORCE / 1e3, 3)),
            kept: Some(force <= limits::WHEEL_FORCE),
        });
        // if another train has the largest force relative to its own static load
        let amplified = worst_train(&run.trains, |row| row.dynamic_amplification);
        if let Some(amplified) = amplified.filter(|amplified| row.is_some_and(|row| row.train != amplified.train)) {
            let place = times_static(run, amplified);
            lines.extend(line("Largest amplification", Some(amplified.max_wheel_force_N), "N", place));
        }
    }
    if let Some(row) = worst_train(&run.trains, |row| row.wheel_unloading) {
        let missing = significant(100.0 * row.wheel_unloading.max(0.0), 2);
        lines.push(Line {
            name: "Least wheel force",
            value: amount(row.min_wheel_force_N, "N"),
            place: format!("{missing} % below {}", static_load(run, row)),
            limit: format!("{} %", plain(100.0 * limits::UNLOADING, 2)),
            kept: Some(row.wheel_unloading <= limits::UNLOADING),
        });
    }
    let load = scalar(run, "max_rail_seat_load");
    lines.extend(line("Largest rail seat load", load, "N", at_largest(run, |row| row.max_rail_seat_load_N)));
    if let Some(pressure) = scalar(run, "max_contact_pressure") {
        lines.push(Line {
            name: "Sleeper pressure",
            value: amount(pressure, "Pa"),
            place: at_largest(run, |row| row.max_contact_force_N),
            limit: format!("{} kPa (UIC, concrete)", plain(limits::CONTACT_PRESSURE / 1e3, 3)),
            kept: Some(pressure <= limits::CONTACT_PRESSURE),
        });
    }
    lines
}

/// The largest force of a train relative to its static load, and the name of the train.
fn times_static(run: &Run, row: &TrainRow) -> String {
    format!("{} \u{d7} {}", significant(row.dynamic_amplification, 3), static_load(run, row))
}

/// The static wheel load of a train, with its name if several trains run.
fn static_load(run: &Run, row: &TrainRow) -> String {
    let load = amount(row.static_wheel_load_N, "N");
    match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) if traffic.is_mixed() => {
            format!("the static wheel load of {}, {load}", row.train)
        }
        _ => format!("the static wheel load, {load}"),
    }
}

fn rail_lines(run: &Run) -> Vec<Line> {
    let mut lines = Vec::new();
    let rows = last_profile(run);
    let at = rows.iter().max_by(|a, b| a.max_moment_N_m.total_cmp(&b.max_moment_N_m));
    let place = at.map_or(String::new(), |row| format!("sagging, {} m", plain(row.x_m, 4)));
    lines.extend(line("Largest rail moment", scalar(run, "max_rail_moment"), "N m", place));
    let estimate = "tension; neutral axis at half the height".to_owned();
    lines.extend(line("Stress at the rail's foot", scalar(run, "max_rail_foot_stress"), "Pa stress", estimate));
    let stiffness = || rows.iter().map(|row| row.stiffness_N_per_m);
    let (low, high) = (stiffness().fold(f64::INFINITY, f64::min), stiffness().fold(0.0, f64::max));
    if let Some(load) = mean_wheel_load(&run.scenario).filter(|_| high > 0.0) {
        lines.push(Line {
            name: "Stiffness at rail level",
            value: format!("{} to {}", significant(low / 1e6, 3), amount(high, "N/m")),
            place: format!("under a standing wheel of {}", amount(load, "N")),
            limit: String::new(),
            kept: None,
        });
    }
    let limits = match &run.scenario.loading {
        Some(Loading::Traffic(traffic)) => limits::longitudinal_level(traffic.line_speed()),
        _ => None,
    };
    let levels = [
        ("Level D1, unloaded rail", "longitudinal_level_d1"),
        ("Level D1, under a wheel", "loaded_longitudinal_level_d1"),
    ];
    for (name, key) in levels {
        let Some(peak) = scalar(run, key) else { continue };
        let deviation = scalar(run, &format!("{key}_deviation"));
        lines.push(Line {
            name,
            value: amount(peak, "m"),
            place: deviation.map_or(String::new(), |d| format!("standard deviation {}", amount(d, "m"))),
            limit: limits
                .map_or(String::new(), |l| format!("alert from {} mm (EN 13848-5)", plain(l.alert.0 * 1e3, 2))),
            kept: limits.map(|l| peak <= l.alert.0),
        });
    }
    lines
}

fn static_lines(run: &Run) -> Vec<Line> {
    let at = |quantity: &str| {
        let rows = run.histories.iter().filter(|h| h.quantity == quantity && h.id == "rail" && h.value.is_finite());
        let row = rows.max_by(|a, b| a.value.total_cmp(&b.value));
        row.map_or(String::new(), |row| format!("{} m", plain(row.x_m, 4)))
    };
    let lines = [
        line("Largest rail deflection", scalar(run, "max_rail_displacement"), "m", at("rail_displacement")),
        line("Largest rail moment, sagging", scalar(run, "max_rail_moment"), "N m", at("rail_moment")),
        line(
            "Largest rail seat load",
            scalar(run, "max_rail_seat_load"),
            "N",
            at_largest(run, |row| row.max_rail_seat_load_N),
        ),
    ];
    lines.into_iter().flatten().collect()
}
