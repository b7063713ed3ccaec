//! The files of a study: a table with one row per point, and the results.

use super::answer::{Answer, Row};
use super::compared::Difference;
use crate::scenario::{Sampling, Values};
use serde_json::{Value, json};

/// A text that no spreadsheet takes for a formula: a text that begins with a sign is put in brackets.
fn no_formula(text: &str) -> String {
    if text.starts_with(['-', '+', '=', '@']) { format!("({text})") } else { text.to_owned() }
}

impl Answer {
    /// `study.csv`: one row per point, the scene as it is first; values in the units of their headers.
    pub fn csv(&self) -> Result<String, String> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.header()).map_err(|e| e.to_string())?;
        let best = self.best();
        for (index, row) in self.rows.iter().enumerate() {
            writer.write_record(self.cells(row, best.contains(&index))).map_err(|e| e.to_string())?;
        }
        let bytes = writer.into_inner().map_err(|e| e.to_string())?;
        String::from_utf8(bytes).map_err(|e| e.to_string())
    }

    fn header(&self) -> Vec<String> {
        let study = &self.study;
        let with_unit = |name: &str, unit: &str| {
            let name = no_formula(name);
            if unit.is_empty() { name } else { format!("{name} [{unit}]") }
        };
        let mut header = vec!["point".to_string(), "as_it_is".to_string()];
        header.extend(study.axes.iter().map(|axis| with_unit(&axis.path, &axis.unit)));
        for m in study.measured() {
            header.push(with_unit(&m.text, &m.unit.0));
            if study.repeats.are_several() {
                header.push(with_unit(&format!("{} sd", m.text), &m.unit.0));
            }
            header.push(with_unit(&format!("{} difference", m.text), &m.unit.0));
            if study.repeats.are_several() {
                header.push(with_unit(&format!("{} difference +-", m.text), &m.unit.0));
            }
        }
        header.extend(study.constraints.iter().map(|c| with_unit(&format!("{} missed by", c.text), &c.unit.0)));
        if study.repeats.are_several() {
            header.push("packings".to_string());
        }
        header.extend(["constraints_met", "best", "status", "reason"].map(String::from));
        header
    }

    fn cells(&self, row: &Row, best: bool) -> Vec<String> {
        let study = &self.study;
        let yes = |yes: bool| if yes { "yes" } else { "no" }.to_string();
        let shown = |value: Option<f64>, size: f64| value.map_or(String::new(), |v| (v / size).to_string());
        let mut cells = vec![row.number.to_string(), yes(row.as_it_is)];
        cells.extend(
            row.levels.iter().map(|level| level.number.map_or_else(|| no_formula(&level.text), |n| n.to_string())),
        );
        for (i, m) in study.measured().iter().enumerate() {
            let at = |values: Option<&[f64]>| values.and_then(|values| values.get(i)).copied();
            cells.push(shown(at(row.values()), m.unit.1));
            if study.repeats.are_several() {
                cells.push(shown(at(row.deviations()), m.unit.1));
            }
            let difference = self.difference(row, i);
            cells.push(shown(difference.map(|difference| difference.of), m.unit.1));
            if study.repeats.are_several() {
                cells.push(shown(difference.and_then(|difference| difference.half), m.unit.1));
            }
        }
        for (i, c) in study.constraints.iter().enumerate() {
            let by = row.misses().get(i).map(|miss| miss.map_or(0.0, |miss| miss.by));
            cells.push(shown(by, c.unit.1));
        }
        if study.repeats.are_several() {
            cells.push(row.packings().to_string());
        }
        let ran = row.failed().is_none();
        cells.push(if ran { yes(row.feasible()) } else { String::new() });
        cells.push(yes(best));
        cells.push(if ran { "done" } else { "failed" }.to_string());
        cells.push(row.failed().unwrap_or_default().to_string());
        cells
    }

    /// The results, for `study.json`; the same for equal studies.
    pub fn json(&self) -> Value {
        let study = &self.study;
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
            "runs": self.runs(),
            "tolerance": study.tolerance,
            "certainty": self.certainty(),
            "objectives": objectives.collect::<Vec<_>>(),
            "subject_to": study.constraints.iter().map(|c| &c.text).collect::<Vec<_>>(),
            "points": self.designs().count(),
            "left_out": self.left_out,
            "failed": self.failures().count(),
            "as_it_is": self.as_it_is().map(|row| self.design(row)),
            "constraints": self.constraints().iter().map(|c| json!({
                "text": c.text,
                "met_by": c.met,
                "missed_by": c.missed,
                "unit": c.unit.0,
                "least_miss": c.least.map(|miss| miss.by / c.unit.1),
                "largest_miss": c.largest.map(|miss| miss.by / c.unit.1),
            })).collect::<Vec<_>>(),
            "nearest": self.nearest().map(|index| self.design(&self.rows[index])),
            "best": self.best().iter().map(|index| self.design(&self.rows[*index])).collect::<Vec<_>>(),
        })
    }

    /// A point with its lines, its measured values, their differences from the scene as it is, and its missed
    /// constraints.
    fn design(&self, row: &Row) -> Value {
        let value = |(index, value): (usize, &f64)| {
            let m = self.study.measured()[index];
            let difference = self.difference(row, index);
            let measured = json!({
                "value": value / m.unit.1,
                "unit": m.unit.0,
                "difference": difference.map(|d: Difference| d.of / m.unit.1),
                "share": difference.and_then(|d| d.share),
                "confidence": difference.and_then(|d| d.half).map(|half| half / m.unit.1),
            });
            (m.text.clone(), measured)
        };
        let values: serde_json::Map<String, Value> =
            row.values().unwrap_or_default().iter().enumerate().map(value).collect();
        let missed = self.study.constraints.iter().zip(row.misses()).filter_map(|(c, miss)| {
            let miss = (*miss)?;
            Some(json!({ "text": c.text, "by": miss.by / c.unit.1, "unit": c.unit.0, "share": miss.share }))
        });
        let (point, as_it_is) = (row.number, row.as_it_is);
        let lines = if row.designed() { self.lines(row) } else { Vec::new() };
        json!({
            "point": point, "as_it_is": as_it_is, "packings": row.packings(), "lines": lines, "values": values,
            "missed": missed.collect::<Vec<_>>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_no_formula() {
        assert_eq!(no_formula("-max(settlement)"), "(-max(settlement))");
        assert_eq!(no_formula("max(void)"), "max(void)");
    }
}
