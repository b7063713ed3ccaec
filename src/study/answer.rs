//! What a study found: a row a point, the best design or the Pareto front, and the files that say so.

use super::design::Level;
use super::perform::{PointOutcome, PointResult};
use super::plan::Plan;
use crate::scenario::{Goal, Sampling, Study, Values};
use serde_json::{Value, json};

/// A finished study.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    pub title: String,
    pub study: Study,
    pub rows: Vec<Row>,
    pub left_out: usize,
}

/// A point with what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    pub number: usize,
    pub levels: Vec<Level>,
    pub outcome: PointOutcome,
}

impl Row {
    /// What is measured, SI; `None` where the point failed.
    pub fn values(&self) -> Option<&[f64]> {
        match &self.outcome {
            PointOutcome::Done { values, .. } => Some(values),
            PointOutcome::Failed { .. } => None,
        }
    }

    /// Standard deviations of the same over repeats, 0 for one run.
    pub fn deviations(&self) -> Option<&[f64]> {
        match &self.outcome {
            PointOutcome::Done { deviations, .. } => Some(deviations),
            PointOutcome::Failed { .. } => None,
        }
    }

    /// Whether it ran and meets every constraint.
    pub fn feasible(&self) -> bool {
        matches!(&self.outcome, PointOutcome::Done { met, .. } if met.iter().all(|m| *m))
    }

    pub fn failed(&self) -> Option<&str> {
        match &self.outcome {
            PointOutcome::Failed { reason, .. } => Some(reason),
            PointOutcome::Done { .. } => None,
        }
    }
}

impl Answer {
    pub fn new(title: &str, plan: &Plan, results: Vec<PointResult>) -> Answer {
        let rows = plan.points.iter().zip(results);
        let rows = rows.map(|(p, r)| Row { number: p.number, levels: p.levels.clone(), outcome: r.outcome });
        Answer { title: title.to_string(), study: plan.study.clone(), rows: rows.collect(), left_out: plan.left_out }
    }

    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.failed().is_some())
    }

    /// Objectives of a row, each the smaller the better.
    fn costs(&self, row: &Row) -> Option<Vec<f64>> {
        let values = row.values()?;
        let measured = self.study.measured();
        let cost = |objective: &crate::scenario::Objective| {
            let index = measured.iter().position(|m| m.text == objective.of.text)?;
            Some(if objective.goal == Goal::Minimise { values[index] } else { -values[index] })
        };
        self.study.objectives.iter().map(cost).collect()
    }

    /// Indices of the rows that no other one beats: of one objective the best, of several the Pareto front in the order of
    /// the first. Only rows that meet every constraint take part; equal ones all do.
    pub fn best(&self) -> Vec<usize> {
        if self.study.objectives.is_empty() {
            return Vec::new();
        }
        let feasible: Vec<(usize, Vec<f64>)> = self
            .rows
            .iter()
            .enumerate()
            .filter(|(_, row)| row.feasible())
            .filter_map(|(i, row)| Some((i, self.costs(row)?)))
            .collect();
        let beats = |a: &[f64], b: &[f64]| a != b && a.iter().zip(b).all(|(a, b)| a <= b);
        let mut front: Vec<&(usize, Vec<f64>)> =
            feasible.iter().filter(|(_, own)| !feasible.iter().any(|(_, other)| beats(other, own))).collect();
        front.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        front.into_iter().map(|(index, _)| *index).collect()
    }

    /// `study.csv`: a row a point, values in the units of their headers.
    pub fn csv(&self) -> Result<String, String> {
        let study = &self.study;
        let with_unit = |name: &str, unit: &str| if unit.is_empty() { name.into() } else { format!("{name} [{unit}]") };
        let measured = study.measured();
        let mut header = vec!["point".to_string()];
        header.extend(study.axes.iter().map(|axis| with_unit(&axis.path, &axis.unit)));
        for m in &measured {
            header.push(with_unit(&m.text, &m.unit.0));
            if study.repeats > 1 {
                header.push(with_unit(&format!("{} sd", m.text), &m.unit.0));
            }
        }
        header.extend(["constraints_met", "best", "status", "reason"].map(String::from));
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&header).map_err(|e| e.to_string())?;
        let best = self.best();
        for (index, row) in self.rows.iter().enumerate() {
            let mut cells = vec![row.number.to_string()];
            cells.extend(row.levels.iter().map(|level| level.number.map_or(level.text.clone(), |n| n.to_string())));
            for (i, m) in measured.iter().enumerate() {
                let (value, deviation) = match &row.outcome {
                    PointOutcome::Done { values, deviations, .. } => (Some(values[i]), Some(deviations[i])),
                    PointOutcome::Failed { .. } => (None, None),
                };
                let shown = |value: Option<f64>| value.map_or(String::new(), |v| (v / m.unit.1).to_string());
                cells.push(shown(value));
                if study.repeats > 1 {
                    cells.push(shown(deviation));
                }
            }
            let yes = |yes: bool| if yes { "yes" } else { "no" }.to_string();
            let ran = row.failed().is_none();
            cells.push(if ran { yes(row.feasible()) } else { String::new() });
            cells.push(yes(best.contains(&index)));
            cells.push(if ran { "done" } else { "failed" }.to_string());
            cells.push(row.failed().unwrap_or_default().to_string());
            writer.write_record(&cells).map_err(|e| e.to_string())?;
        }
        let bytes = writer.into_inner().map_err(|e| e.to_string())?;
        String::from_utf8(bytes).map_err(|e| e.to_string())
    }

    /// What was found, for `study.json`; the same for equal studies.
    pub fn json(&self) -> Value {
        let study = &self.study;
        let measured = study.measured();
        let design = |index: &usize| {
            let row = &self.rows[*index];
            let lines: Vec<String> = self.lines(row);
            let values = measured.iter().zip(row.values().unwrap_or_default());
            let values: serde_json::Map<String, Value> = values
                .map(|(m, value)| (m.text.clone(), json!({ "value": value / m.unit.1, "unit": m.unit.0 })))
                .collect();
            json!({ "point": row.number, "lines": lines, "values": values })
        };
        let axes = study.axes.iter().map(|axis| {
            let values = match &axis.values {
                Values::Listed(choices) => json!(choices.iter().map(|c| &c.text).collect::<Vec<_>>()),
                Values::Spread(spread) => json!(spread),
            };
            json!({ "path": axis.path, "unit": axis.unit, "values": values })
        });
        let objectives = study.objectives.iter().map(|o| json!({ "goal": o.goal, "of": o.of.text }));
        let sampling = match study.sampling {
            Sampling::Grid => "grid".to_string(),
            Sampling::LatinHypercube { points } => format!("latin_hypercube({points})"),
            Sampling::Sobol { points } => format!("sobol({points})"),
        };
        json!({
            "title": self.title,
            "study": study.name,
            "vary": axes.collect::<Vec<_>>(),
            "sampling": sampling,
            "set": study.set.iter().map(|s| s.line()).collect::<Vec<_>>(),
            "repeats": study.repeats,
            "objectives": objectives.collect::<Vec<_>>(),
            "subject_to": study.constraints.iter().map(|c| &c.text).collect::<Vec<_>>(),
            "points": self.rows.len(),
            "left_out": self.left_out,
            "failed": self.failures().count(),
            "best": self.best().iter().map(design).collect::<Vec<_>>(),
        })
    }

    /// The lines of a design, to paste into the file.
    pub fn lines(&self, row: &Row) -> Vec<String> {
        let varied = self.study.axes.iter().zip(&row.levels);
        varied.map(|(axis, level)| format!("{} = {}", axis.path, level.text)).collect()
    }
}
