//! Scatter from packing to packing: a table of the page.

use super::number::plain;
use crate::results::{Mean, Run};
use crate::units::number;
use std::fmt::Write;

/// Scalars of the table: name, label, unit, and the size of the unit in SI.
const ROWS: [(&str, &str, &str, f64); 9] = [
    ("settlement_step", "Step at the structure", "mm", 1e-3),
    ("max_settlement", "Largest settlement", "mm", 1e-3),
    ("far_field_settlement", "Far-field settlement", "mm", 1e-3),
    ("max_void", "Largest void", "mm", 1e-3),
    ("voided_sleepers", "Voided sleepers", "", 1.0),
    ("max_rail_seat_load", "Largest rail seat load", "kN", 1e3),
    ("max_contact_force", "Largest contact force", "kN", 1e3),
    ("max_wheel_force", "Largest wheel force", "kN", 1e3),
    ("max_rail_displacement", "Largest rail displacement", "mm", 1e-3),
];

/// The table over packings; nothing if there is one.
pub fn packings(html: &mut String, run: &Run) {
    if run.packings.is_empty() {
        return;
    }
    let seeds: Vec<String> = run.packings.iter().map(|packing| packing.seed.to_string()).collect();
    let _ = write!(
        html,
        "<section id=\"packings\"><h2>Over packings</h2><p class=\"caption\">The same scene with {} packings of its \
         grains. This page shows seed {}; thin curves show seed {}. The standard deviation is for one packing, the 95 % \
         interval for the mean.{}</p><div class=\"scroll\"><table><tr><th class=\"text\"></th><th></th><th>this \
         packing</th><th>mean</th><th>\u{b1} 95 %</th><th>standard \
         deviation</th><th>least</th><th>largest</th></tr>",
        run.packings.len() + 1,
        run.scenario.solve.seed,
        seeds.join(", "),
        enough(run)
    );
    for (name, label, unit, size) in ROWS {
        let (Some(scatter), Some(own)) = (run.scatter(name), run.scalar(name)) else { continue };
        let _ = write!(html, "<tr><td class=\"text\">{label}</td><td class=\"text\">{unit}</td>");
        for value in [own, scatter.mean, scatter.confidence, scatter.deviation, scatter.least, scatter.largest] {
            let _ = write!(html, "<td>{}</td>", plain(value / size, 3));
        }
        *html += "</tr>";
    }
    *html += "</table></div></section>\n";
}

/// Whether an open range of packings was enough; nothing for a number.
fn enough(run: &Run) -> String {
    let grains = &run.scenario.solve.grains;
    if !grains.repeats.are_open() {
        return String::new();
    }
    let tolerance = number(*grains.tolerance * 100.0);
    let goal = format!(
        "the mean of the largest settlement and of the step at the structure to within {tolerance} % of the largest \
         settlement"
    );
    match Mean::over(&run.summary.scalars, &run.packings).is_enough(grains) {
        true => format!(" Of {} packings these give {goal}.", grains.repeats),
        false => format!(" Even these {} packings do not give {goal}.", run.packings.len() + 1),
    }
}

/// A caption with a note on the thin curves, if there are any.
pub fn with_thin_curves(run: &Run, caption: &str) -> String {
    match run.packings.len() {
        0 => caption.to_owned(),
        1 => format!("{caption} Thin curves: another packing of the same grains."),
        count => format!("{caption} Thin curves: {count} other packings of the same grains."),
    }
}
