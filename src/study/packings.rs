//! Points compared on the packings that they share, and the packings that a study still needs.
//!
//! Repeat r of every point has the same seed, so points that do not vary the bed stand on the same grains, and the
//! scatter from bed to bed leaves their difference. An open range of repeats is sequential: after each packing, points
//! that are decided get no further one (elimination with paired t intervals; Nelson et al. 2001, Operations Research
//! 49, 950-963). Each look after a packing, and each pair of points, gives chance another opportunity: the 5 % of wrong
//! verdicts that a study may give are divided by looks and pairs (Bonferroni).

use super::answer::{Answer, Row};
use crate::results::{mean_and_confidence, mean_and_interval};
use crate::scenario::{Goal, Repeats};
use crate::units::number;

/// Share of studies that may give a wrong verdict.
const WRONG: f64 = 0.05;

/// Difference of two points in a value, on the packings of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Paired {
    /// Mean of the differences, SI.
    pub of: f64,
    /// Half the width of its 95 % interval; `None` of one packing.
    pub half: Option<f64>,
    /// The mean of the first point on these packings.
    pub first: f64,
}

/// What the packings say about two points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// One of them is better, surely.
    Sure,
    /// Their difference is known to within the tolerance.
    Close,
    /// More packings are needed.
    Open,
}

impl Row {
    /// Number of its packings; 0 if it failed.
    pub fn packings(&self) -> usize {
        self.runs().len()
    }

    /// Differences of a value from that of another row, on each packing of both.
    fn pairs(&self, first: &Row, index: usize) -> Vec<f64> {
        self.runs().iter().zip(first.runs()).map(|(own, other)| own[index] - other[index]).collect()
    }

    /// Difference of a value from that of another row; `None` if one of both failed.
    pub(super) fn paired(&self, first: &Row, index: usize) -> Option<Paired> {
        let pairs = self.pairs(first, index);
        if pairs.is_empty() {
            return None;
        }
        let (of, half) = mean_and_confidence(&pairs);
        let mean = first.runs()[..pairs.len()].iter().map(|run| run[index]).sum::<f64>() / pairs.len() as f64;
        Some(Paired { of, half, first: mean })
    }
}

impl Answer {
    /// Rows that need a further packing; none if the study has a fixed number, or all is decided. With one objective
    /// each row is compared with the best one so far; without an objective with the scene as it is, in every reported
    /// value. With several objectives all rows go on until each is decided in each objective, because any two of
    /// them may meet on the front.
    pub fn open(&self) -> Vec<usize> {
        let (repeats, ran) = (self.study.repeats, self.ran());
        let most = ran.iter().map(|row| self.rows[*row].packings()).max().unwrap_or(0);
        if !repeats.are_open() || most >= repeats.most as usize {
            return Vec::new();
        }
        let alive: Vec<usize> = ran.into_iter().filter(|row| self.rows[*row].packings() == most).collect();
        let asked = self.asked();
        let Some(first) = self.first(&alive) else { return Vec::new() };
        let others = alive.iter().copied().filter(|row| *row != first);
        let is_open = |row: &usize| asked.iter().any(|index| self.verdict(*row, first, *index) == Some(Verdict::Open));
        let open: Vec<usize> = others.filter(is_open).collect();
        match (open.is_empty(), self.study.objectives.len()) {
            (true, _) if alive.len() > 1 || !self.is_unknown(first, &asked) => Vec::new(),
            (_, 0 | 1) => std::iter::once(first).chain(open).collect(),
            _ => alive,
        }
    }

    /// Rows that are compared: those that ran, and with an objective those that meet every constraint.
    fn ran(&self) -> Vec<usize> {
        let is_compared = |row: &Row| match self.study.objectives.is_empty() {
            true => row.failed().is_none(),
            false => row.feasible(),
        };
        (0..self.rows.len()).filter(|row| is_compared(&self.rows[*row])).collect()
    }

    /// Measured values by which rows are compared.
    fn asked(&self) -> Vec<usize> {
        let measured = self.study.measured();
        let place = |text: &str| measured.iter().position(|m| m.text == text);
        match self.study.objectives.is_empty() {
            true => (0..measured.len()).collect(),
            false => self.study.objectives.iter().filter_map(|objective| place(&objective.of.text)).collect(),
        }
    }

    /// The row that the others are compared with: the best one so far if there is one objective, else the scene as it
    /// is.
    fn first(&self, alive: &[usize]) -> Option<usize> {
        if let [_] = self.study.objectives.as_slice() {
            let cost = |row: &usize| self.costs(&self.rows[*row]).map_or(f64::INFINITY, |costs| costs[0]);
            return alive.iter().copied().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        }
        alive.iter().copied().find(|row| self.rows[*row].as_it_is).or(alive.first().copied())
    }

    /// Verdict on two rows in a measured value; `None` if one of both failed.
    pub fn verdict(&self, row: usize, first: usize, index: usize) -> Option<Verdict> {
        let (row, first) = (&self.rows[row], &self.rows[first]);
        let pairs = row.pairs(first, index);
        let Paired { half, first: mean, .. } = row.paired(first, index)?;
        let (of, sure) = mean_and_interval(&pairs, self.outside());
        let whole = self.as_it_is().and_then(|row| row.values()).map_or(mean, |values| values[index]).abs();
        Some(match (half, sure) {
            (_, Some(sure)) if of.abs() > sure => Verdict::Sure,
            (Some(half), _) if half <= self.study.tolerance * whole => Verdict::Close,
            _ => Verdict::Open,
        })
    }

    /// Whether a row that nothing is compared with has a mean that is not known to within the tolerance.
    fn is_unknown(&self, row: usize, asked: &[usize]) -> bool {
        asked.iter().any(|index| {
            let values: Vec<f64> = self.rows[row].runs().iter().map(|run| run[*index]).collect();
            let (mean, half) = mean_and_confidence(&values);
            half.is_none_or(|half| half > self.study.tolerance * mean.abs())
        })
    }

    /// Share of wrong verdicts of one comparison in one look.
    fn outside(&self) -> f64 {
        let rows = self.rows.iter().filter(|row| row.failed().is_none()).count();
        let others = rows.saturating_sub(1);
        // the best point is not known before: any two may be compared
        let pairs = if self.study.objectives.len() == 1 { rows * others / 2 } else { others * self.asked().len() };
        let Repeats { least, most } = self.study.repeats;
        let looks = most - least + 1;
        WRONG / (f64::from(looks) * pairs.max(1) as f64)
    }

    /// Packings of all rows together.
    pub fn runs(&self) -> usize {
        self.rows.iter().map(Row::packings).sum()
    }

    /// How sure the best design is, by its packings: `Point 3 is better than 9 of 10 others with 95 % confidence.`
    /// `None` if nothing is repeated, or there is not one objective.
    pub fn certainty(&self) -> Option<String> {
        let ([objective], true) = (self.study.objectives.as_slice(), self.study.repeats.are_several()) else {
            return None;
        };
        let best = *self.best().first()?;
        let index = *self.asked().first()?;
        let sign = if objective.goal == Goal::Minimise { 1.0 } else { -1.0 };
        let mut found = Found::default();
        for row in self.ran().into_iter().filter(|row| *row != best) {
            let is_worse = sign * self.rows[row].paired(&self.rows[best], index)?.of > 0.0;
            let names = match (self.verdict(row, best, index)?, is_worse) {
                (Verdict::Sure, true) => &mut found.worse,
                (Verdict::Sure, false) => &mut found.better,
                (Verdict::Close, _) => &mut found.close,
                (Verdict::Open, _) => &mut found.open,
            };
            names.push(self.rows[row].name());
        }
        found.sentence(&self.rows[best].name(), self.study.tolerance)
    }
}

/// Rows beside the best design, by what the packings say of them.
#[derive(Default)]
struct Found {
    worse: Vec<String>,
    better: Vec<String>,
    close: Vec<String>,
    open: Vec<String>,
}

impl Found {
    fn sentence(&self, best: &str, tolerance: f64) -> Option<String> {
        let Found { worse, better, close, open } = self;
        let all = worse.len() + better.len() + close.len() + open.len();
        let mut parts = Vec::new();
        match worse.len() {
            0 => {}
            n if n == all => parts.push("is better than every other one with 95 % confidence".to_owned()),
            n => parts.push(format!("is better than {n} of {all} others with 95 % confidence")),
        }
        if !better.is_empty() {
            parts.push(format!("is worse than {} with 95 % confidence", listed(better)));
        }
        if !close.is_empty() {
            let tolerance = number(tolerance * 100.0);
            parts.push(format!("is as good as {}, to within the tolerance of {tolerance} %", listed(close)));
        }
        if !open.is_empty() {
            parts.push(format!("may be better or worse than {}: the packings are too few to decide", listed(open)));
        }
        (all > 0).then(|| format!("{} {}.", capital(best), parts.join("; it ")))
    }
}

fn capital(name: &str) -> String {
    let mut text = name.to_owned();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    text
}

/// `point 2, point 5 and point 7`; the first few of many.
fn listed(names: &[String]) -> String {
    const MOST: usize = 5;
    match names {
        [] => String::new(),
        [only] => only.clone(),
        many if many.len() > MOST => format!("{} and {} more", many[..MOST].join(", "), many.len() - MOST),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{FileId, Span};
    use crate::scenario::response::{Expression, Measure, Reduction, Response};
    use crate::scenario::{Measured, Objective, Sampling, Study};
    use crate::study::PointOutcome;
    use crate::study::design::{Level, inverse_normal};

    /// Normal numbers of a seed (Steele, Lea and Flood 2014).
    struct Normal(u64);

    impl Normal {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            inverse_normal((((z ^ (z >> 31)) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64)
        }
    }

    fn study(repeats: Repeats, objectives: usize) -> Study {
        let of = |text: &str| Measured {
            text: text.to_owned(),
            expression: Expression::Measure(Measure::new(Reduction::Max, Response::Settlement)),
            unit: ("mm".into(), 1.0),
        };
        let objective = |text: &&str| Objective { goal: Goal::Minimise, of: of(text) };
        Study {
            name: "s".into(),
            span: Span::new(FileId(0), 0, 0),
            axes: Vec::new(),
            sampling: Sampling::Grid,
            set: Vec::new(),
            repeats,
            tolerance: 0.05,
            budget: None,
            objectives: ["a", "b"][..objectives].iter().map(objective).collect(),
            report: ["a", "b"].map(of).to_vec(),
            constraints: Vec::new(),
        }
    }

    /// Runs of points with these means: a share of the scatter is that of the bed, equal for all points of a seed.
    struct Beds {
        means: Vec<f64>,
        of_bed: f64,
        of_point: f64,
        seed: u64,
    }

    impl Beds {
        fn run(&self, point: usize, packing: usize) -> Vec<f64> {
            let normal =
                |place: usize| Normal(self.seed ^ ((place as u64) << 32 | packing as u64).rotate_left(17)).next();
            let one = self.means[point] * (1.0 + self.of_bed * normal(0)) + self.of_point * normal(1 + point);
            vec![one, one]
        }

        fn answer(&self, study: &Study, packings: &[usize]) -> Answer {
            let row = |(number, packings): (usize, &usize)| {
                let runs: Vec<Vec<f64>> = (0..*packings).map(|packing| self.run(number, packing)).collect();
                let mean = |i: usize| runs.iter().map(|run| run[i]).sum::<f64>() / runs.len() as f64;
                let (values, deviations) = (vec![mean(0), mean(1)], vec![0.0; 2]);
                let outcome = PointOutcome::Done { values, deviations, runs, misses: Vec::new() };
                Row { number, as_it_is: number == 0, levels: Vec::<Level>::new(), outcome }
            };
            let rows = packings.iter().enumerate().map(row).collect();
            Answer { title: String::new(), study: study.clone(), rows, left_out: 0 }
        }

        /// The study to its end.
        fn played(&self, study: &Study) -> Answer {
            let mut packings = vec![study.repeats.least as usize; self.means.len()];
            loop {
                let answer = self.answer(study, &packings);
                let open = answer.open();
                if open.is_empty() {
                    return answer;
                }
                open.into_iter().for_each(|row| packings[row] += 1);
            }
        }
    }

    const RANGE: Repeats = Repeats { least: 3, most: 12 };
    /// A study of ten mitigations: the scene as it is, and what they leave of the step.
    const STEPS: [f64; 11] = [1.0, 0.4, 0.5, 0.7, 0.75, 0.8, 0.9, 0.95, 1.0, 1.1, 1.3];

    #[test]
    fn a_wrong_verdict_is_rarer_than_one_study_in_twenty() {
        // all points are equal: whatever is called better is wrong
        let (study, mut wrong) = (study(RANGE, 1), 0);
        for seed in 0..1000 {
            let beds = Beds { means: vec![1.0; 8], of_bed: 0.2, of_point: 0.1, seed: 1000 * seed };
            let answer = beds.played(&study);
            let best = answer.best()[0];
            let sure = |row: &usize| answer.verdict(*row, best, 0) == Some(Verdict::Sure);
            wrong += usize::from((0..8).filter(|row| *row != best).any(|row| sure(&row)));
        }
        assert!(wrong <= 50, "{wrong} of 1000 studies");
    }

    #[test]
    fn the_best_design_is_found_with_fewer_runs() {
        let (study, mut right, mut runs) = (study(RANGE, 1), 0, 0);
        for seed in 0..500 {
            let beds = Beds { means: STEPS.to_vec(), of_bed: 0.2, of_point: 0.05, seed: 77 + 1000 * seed };
            let answer = beds.played(&study);
            right += usize::from(answer.best() == [1]);
            runs += answer.runs();
        }
        assert!(right >= 475, "{right} of 500");
        let (of, most) = (runs as f64 / 500.0, 11 * 12);
        assert!(of < 0.65 * f64::from(most), "{of} runs of {most}");
    }

    #[test]
    fn common_beds_separate_what_apart_would_not_be() {
        // beds scatter by a fifth, the designs by a tenth of that
        let beds = Beds { means: vec![1.0, 0.9], of_bed: 0.2, of_point: 0.02, seed: 5 };
        let answer = beds.answer(&study(Repeats::times(5), 1), &[5, 5]);
        let difference = answer.difference(&answer.rows[1], 0).unwrap();
        assert!(difference.of < 0.0 && difference.half.unwrap() < -difference.of, "{difference:?}");
        assert_eq!(answer.verdict(1, 0, 0), Some(Verdict::Sure));
        let values = |row: usize| answer.rows[row].runs().iter().map(|run| run[0]).collect::<Vec<f64>>();
        let spread = |row: usize| (crate::results::mean_and_deviation(&values(row)).1.unwrap(), 5);
        let apart = crate::results::confidence_of_difference(spread(0), spread(1)).unwrap();
        assert!(apart > 2.0 * difference.half.unwrap(), "{apart} {difference:?}");
    }

    #[test]
    fn without_an_objective_each_point_is_compared_with_the_scene_as_it_is() {
        let beds = Beds { means: vec![1.0, 0.5, 0.98], of_bed: 0.2, of_point: 0.1, seed: 3 };
        let answer = beds.played(&study(RANGE, 0));
        let packings: Vec<usize> = answer.rows.iter().map(Row::packings).collect();
        // a half is soon known; two hundredths of a scatter of a tenth are not
        assert!(packings[1] < 12 && packings[2] == 12 && packings[0] == 12, "{packings:?}");
        assert_eq!(answer.certainty(), None);
    }

    #[test]
    fn with_several_objectives_all_points_have_the_same_packings() {
        let beds = Beds { means: vec![1.0, 0.5, 0.98], of_bed: 0.2, of_point: 0.1, seed: 3 };
        let packings: Vec<usize> = beds.played(&study(RANGE, 2)).rows.iter().map(Row::packings).collect();
        assert!(packings.iter().all(|count| *count == packings[0]) && packings[0] > 3, "{packings:?}");
    }

    #[test]
    fn results_without_scatter_need_the_least_packings() {
        let beds = Beds { means: vec![1.0, 0.99, 0.98], of_bed: 0.0, of_point: 0.0, seed: 1 };
        let answer = beds.played(&study(RANGE, 1));
        assert_eq!(answer.runs(), 9);
        let said = "Point 2 is better than every other one with 95 % confidence.";
        assert_eq!(answer.certainty().as_deref(), Some(said));
    }
}
