//! The chart of whole runs: error against time as a picture, and the page with the table of all runs.

mod picture;

pub use picture::runs_chart_svg;

use super::number::plain;
use super::page::{close, opening};
use super::prose::prose;
use super::table::{TABLE_END, row, table_head};
use crate::trials::runs::{Ended, RunChart, RunErrors, RunRow};
use crate::units::{duration, percent};
use std::fmt::Write;

/// The whole page.
pub fn runs_chart_page(chart: &RunChart) -> String {
    let mut html = opening(&format!("{}: error against time", chart.title), &subtitle(chart));
    let svg = runs_chart_svg(chart);
    let mut caption =
        "Each mark is a whole run of its own. The thick line joins the runs that no faster run beats.".to_owned();
    if chart.band().is_some() {
        caption += " Each run packs its own bed. The dotted line is another packing of the same bed: differences below \
                    it are no errors of a method.";
    }
    let _ = write!(
        html,
        "<section id=\"chart\"><h2>Error against time</h2><p class=\"caption\">{caption}</p><div class=\"scroll\">{svg}</div></section>"
    );
    html += &table(chart);
    close(&mut html);
    html
}

fn subtitle(chart: &RunChart) -> String {
    let mut text =
        format!("{} axles. Reference: `{}`, which took {}", chart.axles, chart.reference, duration(chart.took.seconds));
    if chart.took.build_s > 0.0 {
        let _ = write!(text, ", {} of it until the first train", duration(chart.took.build_s));
    }
    text += ". ";
    if chart.span.iter().all(|x| x.is_finite()) {
        let [from, to] = chart.span.map(|x| plain(x, 4));
        let _ = write!(text, "Compared at the sleepers from {from} m to {to} m. ");
    }
    for sentence in &chart.shortened {
        let _ = write!(text, "Shortened: {sentence}. ");
    }
    if let Some(band) = chart.band() {
        let _ = write!(text, "Another packing differs by up to {} of settlement.", percent(band));
    }
    if let Some((row, done)) = chart.fastest_within(chart.tolerance) {
        let _ = write!(
            text,
            " The fastest run with a settlement error of at most {}: `{}`, {}.",
            percent(chart.tolerance),
            row.variant.name,
            duration(done.took.seconds)
        );
    }
    text.trim_end().to_owned()
}

fn table(chart: &RunChart) -> String {
    let heads = ["run", "estimated", "took", "until the first train"];
    let errors = RunErrors::ALL.map(|(_, name, _)| name);
    let heads: Vec<&str> = heads.into_iter().chain(errors).chain(["edits"]).collect();
    let caption = "Errors are shares of the largest settlement, of the largest seat load, of the mean contact force \
                   and of the largest wheel force of the reference.";
    let mut html = table_head("Runs", caption, &heads);
    for run in &chart.rows {
        row(&mut html, &run.variant.name, &cells(run));
    }
    html += TABLE_END;
    for run in &chart.rows {
        if let Ended::Refused { reason } = &run.ended {
            let text = prose(&format!("`{}` is refused: {reason}", run.variant.name));
            let _ = write!(html, "<p class=\"note\">{text}</p>");
        }
    }
    html + "</section>"
}

fn cells(run: &RunRow) -> Vec<String> {
    let edits: Vec<String> = run.variant.edits.iter().map(|e| format!("{} = {}", e.path, e.value)).collect();
    let estimated = run.estimated_s.map_or("-".to_owned(), duration);
    let mut cells = vec![estimated];
    match &run.ended {
        Ended::Done(done) => {
            cells.extend([duration(done.took.seconds), duration(done.took.build_s)]);
            cells.extend(RunErrors::ALL.map(|(_, _, read)| read(&done.errors).map_or("-".to_owned(), percent)));
        }
        Ended::LeftOut => cells.push("left out".to_owned()),
        Ended::Stopped { seconds } => cells.extend([duration(*seconds), "stopped by a solver".to_owned()]),
        Ended::Refused { .. } => cells.push("refused".to_owned()),
    }
    cells.resize(3 + RunErrors::ALL.len(), "-".to_owned());
    cells.push(edits.join(", "));
    cells
}
