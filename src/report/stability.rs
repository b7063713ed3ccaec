//! The picture of a stability map: a panel for each integrator and void, time steps across and contacts upwards, and
//! the list of hard scenes below. The shade is the error, a sign is the result; both can be read in grey.

use super::number::significant;
use super::svg::{Anchor, Frame, Svg};
use crate::trials::{Cell, Stability, Stress, Verdict, Void};
use crate::units::number;

const CELL: f64 = 28.0;
const GAP: f64 = 16.0;
const LEFT: f64 = 136.0;
const TOP: f64 = 112.0;
const ROW: f64 = 19.0;

/// The whole picture.
pub fn stability_svg(stability: &Stability) -> String {
    let mut svg = Svg::default();
    let map = &stability.map;
    let (across, up) = (map.time_steps.len() as f64 * CELL, map.contacts.len() as f64 * CELL);
    svg.text("strong", (16.0, 24.0), Anchor::Start, &format!("{}: limits of stability", stability.title));
    let under = "Each cell: the first bogie over the transition. Horizontal: time step. Vertical: Hertz constant of \
        wheel on rail.";
    svg.text("small muted", (16.0, 42.0), Anchor::Start, under);
    legend(&mut svg);
    for (column, void) in map.voids.iter().enumerate() {
        let x = LEFT + column as f64 * (across + GAP);
        let (first, second) = void_name(void);
        svg.text("small strong", (x + across / 2.0, TOP - 18.0), Anchor::Middle, &first);
        svg.text("small muted", (x + across / 2.0, TOP - 5.0), Anchor::Middle, &second);
        for (row, method) in map.methods.iter().enumerate() {
            let y = TOP + row as f64 * (up + GAP);
            if column == 0 {
                svg.text(
                    "small",
                    (12.0, y + up / 2.0 + 4.0),
                    Anchor::Start,
                    &method.to_string().replace("generalised_alpha", "gen. alpha"),
                );
            }
            for cell in map.cells.iter().filter(|c| (c.method, c.void) == (*method, *void)) {
                let i = map.time_steps.iter().position(|s| *s == cell.time_step).unwrap_or(0) as f64;
                let j = map.contacts.iter().position(|c| *c == cell.contact).unwrap_or(0) as f64;
                let frame =
                    Frame { x: x + i * CELL, y: y + up - (j + 1.0) * CELL, width: CELL - 1.0, height: CELL - 1.0 };
                sign(&mut svg, frame, &cell.verdict, &cell_title(cell));
            }
            if column == 0 {
                for (j, contact) in map.contacts.iter().enumerate() {
                    let y = y + up - (j as f64 + 0.5) * CELL + 4.0;
                    svg.text("small muted", (x - 5.0, y), Anchor::End, &format!("\u{d7}{}", number(*contact)));
                }
            }
        }
        let y = TOP + map.methods.len() as f64 * (up + GAP) - GAP + 13.0;
        for (i, step) in map.time_steps.iter().enumerate() {
            let x = x + (i as f64 + 0.5) * CELL;
            svg.text("small muted", (x, y), Anchor::Middle, &number(step * 1e3));
        }
        if column == 0 {
            svg.text("small muted", (x - 5.0, y), Anchor::End, "step [ms]");
        }
    }
    let top = TOP + map.methods.len() as f64 * (up + GAP) + 36.0;
    let bottom = stresses(&mut svg, &stability.stresses, top);
    let width = LEFT + map.voids.len().max(7) as f64 * (across + GAP) + 44.0;
    svg.finish(width, bottom + 12.0, &format!("Stability of {}", stability.title))
}

fn legend(svg: &mut Svg) {
    let entries = [
        (Verdict::Stable { error: 0.0 }, "below 0.1 %", 92.0),
        (Verdict::Stable { error: 5e-3 }, "below 1 %", 84.0),
        (Verdict::Stable { error: 5e-2 }, "below 10 %", 92.0),
        (Verdict::Coarse { error: 1.0, code: "" }, "above 10 %, with a warning", 164.0),
        (Verdict::Unstable { why: String::new(), code: "" }, "unstable, reported", 160.0),
        (Verdict::Refused { code: "", message: String::new() }, "refused with a diagnostic", 160.0),
        (Verdict::Wrong { why: String::new() }, "silently wrong", 100.0),
    ];
    let mut x = 16.0;
    for (verdict, text, width) in entries {
        sign(svg, Frame { x, y: 54.0, width: 16.0, height: 16.0 }, &verdict, "");
        svg.text("small", (x + 21.0, 66.0), Anchor::Start, text);
        x += width + 16.0;
    }
}

fn void_name(void: &Void) -> (String, String) {
    if void.depth == 0.0 {
        return ("as built".into(), String::new());
    }
    let depth = format!("{} mm", number(void.depth * 1e3));
    let under = match void.sleepers {
        None => "step at the transition".into(),
        Some(1) => "under one sleeper".into(),
        Some(n) => format!("under {n} sleepers"),
    };
    (depth, under)
}

fn sign(svg: &mut Svg, frame: Frame, verdict: &Verdict, title: &str) {
    let (class, glyph) = match verdict {
        Verdict::Stable { error } if *error < 1e-3 => ("e0", ""),
        Verdict::Stable { error } if *error < 1e-2 => ("e1", ""),
        Verdict::Stable { .. } => ("e2", ""),
        Verdict::Coarse { .. } => ("e3", "\u{25cb}"),
        Verdict::Unstable { .. } => ("e3", "\u{25b2}"),
        Verdict::Refused { .. } => ("e3", "\u{d7}"),
        Verdict::Wrong { .. } => ("e4", "!"),
    };
    svg.titled_rect(class, frame, title);
    if !glyph.is_empty() {
        let text = if class == "e4" { "onblack" } else { "" };
        svg.text(text, (frame.x + frame.width / 2.0, frame.y + frame.height / 2.0 + 4.5), Anchor::Middle, glyph);
    }
}

fn cell_title(cell: &Cell) -> String {
    let (depth, under) = void_name(&cell.void);
    let head = format!(
        "{}, {} ms, contact \u{d7}{}, {depth} {under}",
        cell.method,
        number(cell.time_step * 1e3),
        number(cell.contact)
    );
    format!("{head}: {}", cell.verdict.told())
}

/// The list of hard scenes from `top` down; gives its lower end.
fn stresses(svg: &mut Svg, rows: &[Stress], top: f64) -> f64 {
    svg.text("strong", (16.0, top), Anchor::Start, "Hard scenes");
    svg.text("small muted", (400.0, top), Anchor::Start, "largest wheel force over static");
    svg.text("small muted", (590.0, top), Anchor::Start, "how it ends");
    for (index, row) in rows.iter().enumerate() {
        let y = top + (index as f64 + 1.0) * ROW;
        sign(svg, Frame { x: 16.0, y: y - 12.0, width: 15.0, height: 15.0 }, &row.verdict, &row.told());
        svg.text("small", (40.0, y), Anchor::Start, &row.name);
        if let Some(force) = row.wheel_force {
            svg.text("small", (440.0, y), Anchor::End, &significant(force, 3));
        }
        let mut text: String = row.told().chars().take(64).collect();
        if let Some(seats) = row.losing_contact.filter(|n| *n > 0) {
            text += &format!("; {seats} seats lose contact");
        }
        if !row.warnings.is_empty() {
            text += &format!("; {}", row.warnings.join(" "));
        }
        svg.text("small muted", (590.0, y), Anchor::Start, &text);
    }
    top + (rows.len() as f64 + 1.0) * ROW
}
