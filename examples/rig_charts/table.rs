//! The table of all tests, written and read.

use super::Row;
use super::test::Answer;

const HEADER: &str = "chart,setting,seed,grains,porosity,settlement_1_mm,settlement_2_to_10_mm,stiffness_10_MN_per_m,steps,packing_s,testing_s";

pub fn write(rows: &[Row]) -> String {
    let lines: Vec<String> = rows.iter().map(line).collect();
    format!("{HEADER}\n{}\n", lines.join("\n"))
}

/// A test that failed has a line of its place alone.
pub fn line(row: &Row) -> String {
    let place = format!("{},{},{}", row.chart, row.name, row.seed);
    match &row.answer {
        Ok(a) => format!(
            "{place},{},{:.4},{:.4},{:.4},{:.2},{},{:.1},{:.1}",
            a.grains,
            a.porosity,
            1e3 * a.first,
            1e3 * a.growth,
            1e-6 * a.stiffness,
            a.steps,
            a.packing,
            a.testing
        ),
        Err(reason) => {
            eprintln!("{place}: {reason}");
            format!("{place},,,,,,,,")
        }
    }
}

pub fn read(text: &str) -> Option<Vec<Row>> {
    text.lines().skip(1).map(row).collect()
}

fn row(line: &str) -> Option<Row> {
    let cells: Vec<&str> = line.split(',').collect();
    let number = |place: usize| cells.get(place)?.parse::<f64>().ok();
    let answer = || {
        Some(Answer {
            grains: number(3)? as usize,
            porosity: number(4)?,
            first: number(5)? / 1e3,
            growth: number(6)? / 1e3,
            stiffness: number(7)? * 1e6,
            steps: number(8)? as u64,
            packing: number(9)?,
            testing: number(10)?,
        })
    };
    let (chart, name) = (cells.first()?.to_string(), cells.get(1)?.to_string());
    Some(Row { chart, name, seed: number(2)? as u64, answer: answer().ok_or_else(|| "it failed".to_owned()) })
}
