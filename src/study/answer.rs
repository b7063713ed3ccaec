//! The result of a study: one row per point, the best design or the Pareto front, and the nearest design if none meets
//! every constraint.

use super::design::Level;
use super::miss::Miss;
use super::outcome::PointOutcome;
use super::plan::Plan;
use super::point::PlannedPoint;
use crate::scenario::{Goal, Objective, Study};

/// A finished study.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    pub title: String,
    pub study: Study,
    /// The scene as it is first, if it could run; then the points of the design in order.
    pub rows: Vec<Row>,
    pub left_out: usize,
}

/// A point with its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its number in the design, from 1; 0 if it is only the scene as it is.
    pub number: usize,
    pub as_it_is: bool,
    pub levels: Vec<Level>,
    pub outcome: PointOutcome,
}

impl Row {
    /// The measured values, SI; `None` if the point failed.
    pub fn values(&self) -> Option<&[f64]> {
        match &self.outcome {
            PointOutcome::Done { values, .. } => Some(values),
            PointOutcome::Failed { .. } => None,
        }
    }

    /// Standard deviations of the measured values over repeats, 0 for one run.
    pub fn deviations(&self) -> Option<&[f64]> {
        match &self.outcome {
            PointOutcome::Done { deviations, .. } => Some(deviations),
            PointOutcome::Failed { .. } => None,
        }
    }

    /// The measured values of each packing, SI; empty if the point failed.
    pub(super) fn runs(&self) -> &[Vec<f64>] {
        match &self.outcome {
            PointOutcome::Done { runs, .. } => runs,
            PointOutcome::Failed { .. } => &[],
        }
    }

    /// The miss of each constraint; empty if the point failed.
    pub fn misses(&self) -> &[Option<Miss>] {
        match &self.outcome {
            PointOutcome::Done { misses, .. } => misses,
            PointOutcome::Failed { .. } => &[],
        }
    }

    /// Whether it ran and meets every constraint.
    pub fn feasible(&self) -> bool {
        self.failed().is_none() && self.misses().iter().all(Option::is_none)
    }

    /// Whether it is a point of the design.
    pub fn designed(&self) -> bool {
        self.number > 0
    }

    /// `point 3`
    pub fn name(&self) -> String {
        match self.number {
            0 => "the scene as it is".to_string(),
            number => format!("point {number}"),
        }
    }

    pub fn failed(&self) -> Option<&str> {
        match &self.outcome {
            PointOutcome::Failed { reason, .. } => Some(reason),
            PointOutcome::Done { .. } => None,
        }
    }
}

impl Answer {
    pub fn new(title: &str, plan: &Plan, outcomes: Vec<PointOutcome>) -> Answer {
        let rows = plan.points.iter().zip(outcomes);
        let row = |(p, outcome): (&PlannedPoint, PointOutcome)| Row {
            number: p.number,
            as_it_is: p.as_it_is,
            levels: p.levels.clone(),
            outcome,
        };
        let rows = rows.map(row).collect();
        Answer { title: title.to_string(), study: plan.study.clone(), rows, left_out: plan.left_out }
    }

    /// The points of the design, with their places among the rows.
    pub fn designs(&self) -> impl Iterator<Item = (usize, &Row)> {
        self.rows.iter().enumerate().filter(|(_, row)| row.designed())
    }

    /// The scene as it is, if it could run.
    pub fn as_it_is(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.as_it_is)
    }

    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.failed().is_some())
    }

    /// Objectives of a row; for each, a smaller value is better.
    pub(super) fn costs(&self, row: &Row) -> Option<Vec<f64>> {
        let values = row.values()?;
        let measured = self.study.measured();
        let cost = |objective: &Objective| {
            let index = measured.iter().position(|m| m.text == objective.of.text)?;
            Some(if objective.goal == Goal::Minimise { values[index] } else { -values[index] })
        };
        self.study.objectives.iter().map(cost).collect()
    }

    /// Indices of the designs that no other design beats: with one objective the best, with several the Pareto front in
    /// the order of the first objective. Only designs that meet every constraint are compared; equal designs are all
    /// included. The scene as it is is included if it is a point of the design. Designs that were given up after
    /// fewer packings are not compared by means again.
    pub fn best(&self) -> Vec<usize> {
        if self.study.objectives.is_empty() {
            return Vec::new();
        }
        let most = self.designs().filter(|(_, row)| row.feasible()).map(|(_, row)| row.packings()).max();
        let feasible = self.designs().filter(|(_, row)| row.feasible() && Some(row.packings()) == most);
        let feasible: Vec<(usize, Vec<f64>)> = feasible.filter_map(|(i, row)| Some((i, self.costs(row)?))).collect();
        let mut front: Vec<&(usize, Vec<f64>)> =
            feasible.iter().filter(|(_, own)| !feasible.iter().any(|(_, other)| beats(other, own))).collect();
        front.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        front.into_iter().map(|(index, _)| *index).collect()
    }

    /// If no design meets every constraint: the design with the smallest largest miss, as a share of its limit. `None`
    /// if a design meets every constraint, or none ran.
    pub fn nearest(&self) -> Option<usize> {
        if self.designs().any(|(_, row)| row.feasible()) {
            return None;
        }
        let shares = |row: &Row| row.misses().iter().flatten().map(|miss| miss.share).collect::<Vec<f64>>();
        let largest = |shares: &[f64]| shares.iter().fold(0.0, |a: f64, b| a.max(*b));
        let ran = self.designs().filter(|(_, row)| row.failed().is_none());
        let missed = ran.map(|(index, row)| (index, shares(row)));
        let missed = missed.map(|(index, shares)| (index, largest(&shares), shares.iter().sum::<f64>()));
        let nearest = missed.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
        nearest.map(|(index, ..)| index)
    }

    /// The lines of a design, to paste into the file.
    pub fn lines(&self, row: &Row) -> Vec<String> {
        let varied = self.study.axes.iter().zip(&row.levels);
        varied.map(|(axis, level)| format!("{} = {}", axis.path, level.text)).collect()
    }
}

/// Whether a point is better than another in one objective and worse in none; smaller values are better.
pub(super) fn beats(a: &[f64], b: &[f64]) -> bool {
    a != b && a.iter().zip(b).all(|(a, b)| a <= b)
}
