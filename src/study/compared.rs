//! The points of a study compared with the scene as it is, and with their constraints.

use super::answer::{Answer, Row, beats};
use super::miss::Miss;
use super::packings::Paired;
use crate::scenario::response::{Expectation, Expression, Reduction, Response};
use crate::scenario::{Goal, Measured, Objective};
use crate::units::number;

/// Difference of a measured value between a point and the scene as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// SI.
    pub of: f64,
    /// The difference as a share of the value of the scene as it is; `None` if a share has no meaning: zero, a change
    /// of sign, a place or
    /// a count.
    pub share: Option<f64>,
    /// Half the width of the 95 % interval of `of`, SI; `None` of one packing.
    pub half: Option<f64>,
}

/// Results of the designs for one constraint.
#[derive(Debug, Clone, PartialEq)]
pub struct MetAndMissed {
    pub text: String,
    /// The unit for output, and its size in SI.
    pub unit: (String, f64),
    /// Numbers of designs that meet it and that miss it.
    pub met: usize,
    pub missed: usize,
    /// The smallest and the largest miss of the designs, by share.
    pub least: Option<Miss>,
    pub largest: Option<Miss>,
}

impl Difference {
    fn from_first(what: &Measured, Paired { of, half, first }: Paired) -> Difference {
        let place_or_count = matches!(&what.expression, Expression::Measure(m)
            if m.reduction == Reduction::PlaceOfMax || m.response == Response::VoidedSleepers);
        let value = first + of;
        let of_a_kind = value * first > 0.0 || value == 0.0 && first != 0.0;
        let share = of / first.abs();
        let share = (of_a_kind && !place_or_count && share.abs() < 10.0).then_some(share);
        Difference { of, share, half }
    }

    /// `-38 %`, `+0.4 mm` if a share has no meaning, or `same`; over packings `-38 +- 5 %`.
    pub fn text(&self, what: &Measured) -> String {
        let half = self.half.filter(|half| *half > 0.0);
        if self.of == 0.0 && half.is_none() {
            return "same".to_string();
        }
        let (of, half, unit) = match self.share {
            Some(share) => (share * 100.0, half.map(|half| half * (share / self.of).abs() * 100.0), "%"),
            None => (self.of / what.unit.1, half.map(|half| half / what.unit.1), what.unit.0.as_str()),
        };
        let half = half.map_or(String::new(), |half| format!(" +- {}", two_digits(half)));
        format!("{}{half} {unit}", signed(of)).trim_end().to_string()
    }

    /// `38 % less than as it is`, `38 +- 5 % less than as it is`
    pub fn words(&self, what: &Measured) -> String {
        let text = self.text(what);
        if self.half.is_some_and(|half| self.of.abs() <= half && half > 0.0) {
            return format!("not surely other than as it is ({text})");
        }
        match text.strip_prefix(['-', '+']) {
            Some(amount) if self.of < 0.0 => format!("{amount} less than as it is"),
            Some(amount) => format!("{amount} more than as it is"),
            None => "the same as it is".to_string(),
        }
    }
}

/// Two digits below ten, whole numbers above.
fn rounded(x: f64) -> f64 {
    if x.abs() < 10.0 { format!("{x:.1e}").parse().unwrap_or(x) } else { x.round() }
}

fn two_digits(x: f64) -> String {
    number(rounded(x))
}

/// A number with its sign: two digits below ten, whole numbers above.
fn signed(x: f64) -> String {
    let rounded = rounded(x);
    if rounded > 0.0 { format!("+{}", number(rounded)) } else { number(rounded) }
}

impl Answer {
    /// Difference of a row from the scene as it is in the measured value of that index, on the packings of both; `None`
    /// if one of both failed, and for the scene as it is itself.
    pub fn difference(&self, row: &Row, index: usize) -> Option<Difference> {
        let as_it_is = self.as_it_is().filter(|_| !row.as_it_is)?;
        Some(Difference::from_first(self.study.measured().get(index)?, row.paired(as_it_is, index)?))
    }

    /// Every constraint, with the results of the designs that ran.
    pub fn constraints(&self) -> Vec<MetAndMissed> {
        let one = |(index, constraint): (usize, &Expectation)| {
            let misses: Vec<Option<Miss>> =
                self.designs().filter_map(|(_, row)| row.misses().get(index).copied()).collect();
            let by_share = |a: &Miss, b: &Miss| a.share.total_cmp(&b.share);
            let missed = || misses.iter().flatten().copied();
            MetAndMissed {
                text: constraint.text.clone(),
                unit: constraint.unit.clone(),
                met: misses.len() - missed().count(),
                missed: missed().count(),
                least: missed().min_by(by_share),
                largest: missed().max_by(by_share),
            }
        };
        self.study.constraints.iter().enumerate().map(one).collect()
    }

    /// The missed constraints of a row, each as `` `max(settlement) < 3 mm` by 0.4 mm (13 %) ``.
    pub fn missed(&self, row: &Row) -> Vec<String> {
        let pairs = self.study.constraints.iter().zip(row.misses());
        pairs.filter_map(|(c, miss)| Some(format!("`{}` by {}", c.text, amount(&(*miss)?, &c.unit)))).collect()
    }

    /// The best designs compared with the scene as it is; `None` if there is nothing to compare.
    pub fn against_as_it_is(&self) -> Option<String> {
        let as_it_is = self.as_it_is()?;
        let best = self.best();
        let own = best.iter().any(|index| self.rows[*index].as_it_is);
        let sentence = match (self.study.objectives.len(), own) {
            (1, true) => "No design is better than the scene as it is, which is one of them.".to_string(),
            (1, false) => self.best_against(&self.rows[*best.first()?])?,
            (_, true) => "One of them is the scene as it is.".to_string(),
            (_, false) => self.front_against(&best, as_it_is)?,
        };
        match self.missed(as_it_is).as_slice() {
            [] => Some(sentence),
            missed => Some(format!("{sentence} The scene as it is misses {}.", missed.join(" and "))),
        }
    }

    /// The best design by one objective.
    fn best_against(&self, best: &Row) -> Option<String> {
        let Objective { goal, of: what } = &self.study.objectives[0];
        let index = self.study.measured().iter().position(|m| m.text == what.text)?;
        // on the packings of both
        let difference = self.difference(best, index)?;
        let worse = if *goal == Goal::Minimise { difference.of } else { -difference.of };
        if worse >= 0.0 {
            return Some("No design is better than the scene as it is.".to_string());
        }
        Some(format!("`{}` is {}.", what.text, difference.words(what)))
    }

    /// The designs of the front.
    fn front_against(&self, best: &[usize], as_it_is: &Row) -> Option<String> {
        let before = self.costs(as_it_is)?;
        let costs = best.iter().filter_map(|index| self.costs(&self.rows[*index]));
        let of = best.len();
        let them = if of == 1 { "It" } else { "None of them" };
        let is = if of == 1 { "is not" } else { "is" };
        Some(match costs.filter(|costs| beats(costs, &before)).count() {
            0 if of == 0 => return None,
            0 => format!("{them} {is} better than the scene as it is without being worse in some objective."),
            1 if of == 1 => "It is better than the scene as it is in some objective, and worse in none.".to_string(),
            1 => format!("One of the {of} is better than the scene as it is in some objective, and worse in none."),
            n => format!("{n} of the {of} are better than the scene as it is in some objective, and worse in none."),
        })
    }
}

/// `0.4 mm (13 %)`
pub fn amount(miss: &Miss, unit: &(String, f64)) -> String {
    let by = format!("{} {}", significant(miss.by / unit.1), unit.0);
    format!("{} ({} %)", by.trim_end(), significant(miss.share * 100.0))
}

/// Three digits; whole numbers above 100.
fn significant(x: f64) -> String {
    number(if x.abs() < 100.0 { format!("{x:.2e}").parse().unwrap_or(x) } else { x.round() })
}
