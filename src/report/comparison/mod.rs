//! The page of a comparison: differences between the scenes, the numbers side by side, and figures with all results.

mod along;
mod cycles;
mod lists;
mod points;

use super::Figure;
use super::page::{close, opening, picture};
use crate::compare::{Comparison, Kind, Subject};
use lists::{edits, made, numbers, point_table, seats};

/// Results that a reader can tell apart in one figure; tables hold all.
const MOST: usize = 6;

/// Makes the whole page, in one file without external parts.
pub fn comparison_page(comparison: &Comparison) -> String {
    let names: Vec<&str> = comparison.subjects.iter().map(|subject| subject.name.as_str()).collect();
    let mut html = opening(&names.join(" / "), &subtitle(comparison));
    edits(&mut html, comparison);
    numbers(&mut html, comparison);
    seats(&mut html, comparison);
    figures(comparison).iter().for_each(|figure| picture(&mut html, figure));
    point_table(&mut html, comparison);
    made(&mut html, comparison);
    close(&mut html);
    html
}

/// Every figure of the comparison, in reading order.
fn figures(comparison: &Comparison) -> Vec<Figure> {
    match comparison.kind {
        Kind::Run => along::figures(comparison),
        Kind::Tests => cycles::figures(comparison),
        Kind::Study => points::figures(comparison),
    }
}

fn subtitle(comparison: &Comparison) -> String {
    let what = match comparison.kind {
        Kind::Run => "runs",
        Kind::Tests => "tests of rigs",
        Kind::Study => "studies",
    };
    let mut text = format!(
        "{} {what} side by side; differences are those from `{}`.",
        comparison.subjects.len(),
        comparison.subjects[0].name
    );
    if comparison.subjects.len() > MOST {
        text += &format!(" Figures show the first {MOST}.");
    }
    text
}

/// The results of a figure, each with its colour.
fn coloured(comparison: &Comparison) -> impl Iterator<Item = (&Subject, String)> {
    let few = comparison.subjects.len() <= 4;
    let class = move |index: usize| if few { format!("s{index}") } else { format!("k{index}") };
    comparison.subjects.iter().take(MOST).enumerate().map(move |(index, subject)| (subject, class(index)))
}

#[cfg(test)]
mod tests;
