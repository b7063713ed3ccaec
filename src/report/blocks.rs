//! Length and estimated error of the blocks.

use super::Figure;
use super::curves::{Axis, Chart, Mark, Series};
use super::number::significant;
use super::svg::{Frame, Svg};
use super::view::WIDTH;
use crate::results::{BlockRow, Run};

const HEIGHT: f64 = 220.0;

/// Length and estimated error of every block over the axles.
pub fn lengths(run: &Run) -> Option<Figure> {
    let blocks: Vec<&BlockRow> = run.blocks.iter().filter(|b| b.block_axles > 0).collect();
    if blocks.len() < 2 {
        return None;
    }
    let axles = || Axis { from_zero: true, ..Axis::new("Axles before the block", ("", 1.0)) };
    let points = |of: fn(&BlockRow) -> f64| blocks.iter().map(|b| (b.axles as f64, of(b))).collect();
    let mut svg = Svg::default();
    let half = WIDTH / 2.0;
    let length = Axis { from_zero: true, ..Axis::new("Axles of the block", ("", 1.0)) };
    let mut left = Chart::new(axles(), length);
    left.series.push(Series::new("", "k5", Mark::Dots, points(|b| b.block_axles as f64)));
    left.draw(&mut svg, "block_lengths_axles", Frame { x: 0.0, y: 0.0, width: half, height: HEIGHT });
    let error = Axis { from_zero: true, ..Axis::new("Estimated error of the block", ("\u{b5}m", 1e-6)) };
    let mut right = Chart::new(axles(), error);
    right.series.push(Series::new("", "k3", Mark::Dots, points(|b| b.error_m)));
    right.draw(&mut svg, "block_lengths_error", Frame { x: half, y: 0.0, width: half, height: HEIGHT });
    let caption = format!("Forces and settlement are exchanged between two blocks. {}", said(run));
    Some(Figure {
        id: "block_lengths".to_owned(),
        title: "Length of the blocks".to_owned(),
        svg: svg.finish(WIDTH, HEIGHT, &caption),
        caption,
    })
}

/// Accuracy of the exchanges of the run, in a sentence or two.
pub fn said(run: &Run) -> String {
    let errors = run.blocks.iter().map(|b| b.error_m).filter(|error| error.is_finite());
    let sum = format!(
        "The estimated settlement errors of all blocks add up to {} \u{b5}m.",
        significant(errors.sum::<f64>() * 1e6, 2)
    );
    match BlockRow::overshoot(&run.blocks) {
        Some(found) => format!("{sum} Note: {found}."),
        None => sum,
    }
}
