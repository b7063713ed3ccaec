//! Values that vary along the track, as written. `places` finds their chainages when the track is laid out.

use super::number::Number;
use crate::diag::Span;
use crate::schema::Measure;

/// A profile with its place in the text.
#[derive(Debug, Clone)]
pub struct Shape {
    pub kind: ShapeKind,
    pub span: Span,
    /// The transition from which its places count, if a stretch gives it.
    pub from: Option<usize>,
    /// Start and end, m, if a stretch gives them.
    pub runs: Option<[f64; 2]>,
}

impl Shape {
    /// Sets the transition and the span of the stretch that uses it; a profile that has them keeps them.
    pub fn settle(&mut self, from: usize, runs: [f64; 2]) {
        self.runs.get_or_insert(runs);
        self.count_from(from);
    }

    fn count_from(&mut self, transition: usize) {
        self.from.get_or_insert(transition);
        if let ShapeKind::Spans(spans) = &mut self.kind {
            spans.iter_mut().for_each(|(_, inner)| inner.count_from(transition));
        }
    }
}

#[derive(Debug, Clone)]
pub enum ShapeKind {
    Constant(Number),
    /// From one value to another over a span, or over the whole length to cover; a cubic with level ends if smooth.
    Ramp {
        from: Number,
        to: Number,
        smooth: bool,
        over: Option<Reach>,
    },
    /// Straight between places.
    Points(Vec<(Number, Span, Number)>),
    /// Side by side.
    Spans(Vec<(Reach, Shape)>),
    /// Scattered about a mean.
    Random(Random),
    /// Chainage, m, and values of a column of a data file, with the places of the first and the last row.
    Table {
        column: String,
        rows: Vec<(f64, Number)>,
        ends: [Span; 2],
    },
}

/// From one place to another, as written.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    pub from: Number,
    pub to: Number,
    pub span: Span,
}

/// A random field, as written.
#[derive(Debug, Clone)]
pub struct Random {
    pub mean: Number,
    /// Standard deviation, in the unit and basis of the mean.
    pub deviation: f64,
    /// m.
    pub correlation: f64,
    pub log_normal: bool,
    /// Without a seed, the seed of the scene is used.
    pub seed: Option<u64>,
    /// The path of the field in which it is written. It determines the random values, independent of the rest of the
    /// file.
    pub path: String,
    pub measure: &'static Measure,
}
