//! The miss of a constraint by a run.

use crate::results::holds;
use crate::scenario::response::Expectation;
use serde::{Deserialize, Serialize};

/// The miss of a constraint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Miss {
    /// The difference to the limit, SI.
    pub by: f64,
    /// The same as a share of the limit. If the limit is zero, or both sides come from the run, as a share of the
    /// larger side.
    pub share: f64,
}

impl Miss {
    /// The miss of a comparison with these operands, SI; for a chained comparison the largest miss. `None` if it is
    /// met.
    pub fn against(comparison: &Expectation, values: &[f64]) -> Option<Miss> {
        let missed = |side: usize| {
            let (left, right) = (values[side], values[side + 1]);
            if holds(left, comparison.operators[side], right) {
                return None;
            }
            let by = (left - right).abs();
            let known = |index: usize| (!comparison.operands[index].needs_a_run()).then(|| values[index].abs());
            let limit = known(side).or(known(side + 1)).filter(|limit| *limit > 0.0);
            let whole = limit.unwrap_or(left.abs().max(right.abs()));
            Some(Miss { by, share: if whole > 0.0 { by / whole } else { 0.0 } })
        };
        (0..comparison.operators.len()).filter_map(missed).max_by(|a, b| a.share.total_cmp(&b.share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{FileId, Span};
    use crate::scenario::response::{Expression, Measure, Reduction, Response};
    use crate::syntax::tree::Comparison;

    /// `lower < response <= upper`
    fn between(lower: f64, upper: f64) -> Expectation {
        let response = Expression::Measure(Measure::new(Reduction::Max, Response::Settlement));
        Expectation {
            text: String::new(),
            span: Span::new(FileId(0), 0, 0),
            operands: vec![Expression::Number(lower), response, Expression::Number(upper)],
            operators: vec![Comparison::Less, Comparison::LessOrEqual],
            unit: ("mm".into(), 1e-3),
        }
    }

    #[test]
    fn a_miss_is_a_share_of_the_limit_that_is_missed() {
        let miss = |lower: f64, found: f64, upper: f64| Miss::against(&between(lower, upper), &[lower, found, upper]);
        assert_eq!(miss(1.0, 2.0, 4.0), None);
        assert_eq!(miss(1.0, 5.0, 4.0), Some(Miss { by: 1.0, share: 0.25 }));
        assert_eq!(miss(2.0, 1.0, 4.0), Some(Miss { by: 1.0, share: 0.5 }));
        // at a limit of zero the share refers to the found value, and the limit itself may be excluded
        assert_eq!(miss(-9.0, 3.0, 0.0), Some(Miss { by: 3.0, share: 1.0 }));
        assert_eq!(miss(2.0, 2.0, 4.0), Some(Miss { by: 0.0, share: 0.0 }));
    }
}
