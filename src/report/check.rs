//! Settlement by the law of a run beside cells of grains under the same forces.

use super::Figure;
use super::along::figure;
use super::curves::{Axis, Chart, Mark, Series};
use super::number::shown_unit;
use super::prose::prose;
use crate::results::{CheckRow, Parting, Run};
use std::fmt::Write;

/// Sleepers that a reader can tell apart by colour, and the colours.
const CLASSES: [&str; 8] = ["s0", "s1", "s2", "s3", "k5", "k2", "k4", "k1"];

/// The settlement of each sleeper that cells check, against the axles; `None` without a check.
pub fn checked(run: &Run) -> Option<Figure> {
    let parting = Parting::of_rows(&run.scenario, &run.check)?;
    let mut settlement = Axis::new("Settlement by trains", shown_unit("m"));
    (settlement.downwards, settlement.from_zero) = (true, true);
    let mut chart = Chart::new(Axis::new("Axles", ("", 1.0)), settlement);
    for (index, name) in sleepers(run).into_iter().enumerate() {
        let rows = || run.check.iter().filter(|row| row.sleeper == name);
        let points = |of: fn(&CheckRow) -> f64| {
            std::iter::once((0.0, 0.0)).chain(rows().map(|row| (row.axles as f64, of(row)))).collect()
        };
        let (class, shown) = (CLASSES[index % CLASSES.len()], name.replace('-', "\u{2212}"));
        chart.series.push(Series::new(&format!("{shown}, law"), class, Mark::Line, points(|row| row.law_m)));
        chart.series.push(Series::new(&format!("{shown}, grains"), class, Mark::Dots, points(|row| row.cell_m)));
    }
    let caption = format!(
        "Settlement by the law (lines) and of a cell of grains under the same forces (lines with dots), at the sleepers that the \
         scene checks. {}.",
        opened(&parting)
    );
    figure(&chart, "check", "Law and grains", &caption)
}

/// Writes a note where law and grains differ by more than the law states.
pub fn remarks(html: &mut String, run: &Run) {
    if let Some(parting) = Parting::of_rows(&run.scenario, &run.check).filter(Parting::exceeds) {
        let text = prose(&format!("{}: {}", opened(&parting), parting.help()));
        let _ = writeln!(html, "<p class=\"caption\" role=\"note\">Note: {text}.</p>");
    }
}

/// The sentence of a parting with a capital letter.
fn opened(parting: &Parting<'_>) -> String {
    let sentence = parting.sentence();
    sentence[..1].to_uppercase() + &sentence[1..]
}

fn sleepers(run: &Run) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in &run.check {
        if !names.contains(&row.sleeper.as_str()) {
            names.push(&row.sleeper);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    /// The example run with cells that settle by so much / the law.
    fn with_cells(factor: f64, error: f64) -> Run {
        let mut run = example::transition();
        run.scenario.solve.law.error = Some(error);
        run.check = [(4, 1e-4), (8, 1.6e-4)]
            .map(|(axles, law)| CheckRow {
                axles,
                sleeper: "-3".to_owned(),
                x_m: -1.8,
                law_m: law,
                cell_m: factor * law,
                cell_error_m: 0.0,
            })
            .to_vec();
        run
    }

    #[test]
    fn a_law_that_parts_from_its_grains_is_told() {
        let run = with_cells(1.25, 0.1);
        let figure = checked(&run).unwrap();
        assert!(roxmltree::Document::parse(&figure.svg).is_ok());
        assert!(figure.caption.contains("differ by at most 20 % of the largest settlement"), "{}", figure.caption);
        assert!(figure.caption.contains("more than the 10 % that the law states"), "{}", figure.caption);
        let mut html = String::new();
        remarks(&mut html, &run);
        assert!(html.contains("sleeper -3 has settled 0.16 mm by the law and 0.2 mm in its cell"), "{html}");
    }

    #[test]
    fn a_law_within_its_error_needs_no_note() {
        let run = with_cells(1.05, 0.1);
        assert!(checked(&run).unwrap().caption.contains("within the 10 % that the law states"));
        let mut html = String::new();
        remarks(&mut html, &run);
        assert_eq!(html, "");
        assert!(checked(&example::transition()).is_none());
    }
}
