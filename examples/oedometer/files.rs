//! Tables: YADE's columns out, and a reference of the same columns in.

use super::cycles::{Cycle, Outcome};
use super::experiment::{Parameters, Row};
use super::scatter::Scatter;
use std::error::Error;
use std::path::Path;

/// A run to compare with: `compress.csv` and `cycles.csv` of a folder.
#[derive(Debug, Clone, Default)]
pub struct Reference {
    pub compression: Vec<Row>,
    pub cycles: Vec<Cycle>,
}

impl Reference {
    pub fn read(folder: &Path) -> Result<Reference, Box<dyn Error>> {
        let open = |name: &str| {
            let path = folder.join(name);
            csv::Reader::from_path(&path).map_err(|cause| format!("{}: {cause}", path.display()))
        };
        let compression = open("compress.csv")?.deserialize().collect::<Result<Vec<Row>, _>>()?;
        let records = open("cycles.csv")?.into_records().collect::<Result<Vec<_>, _>>()?;
        let cycles = records.iter().map(cycle).collect::<Result<Vec<Cycle>, _>>()?;
        Ok(Reference { compression, cycles })
    }
}

fn cycle(record: &csv::StringRecord) -> Result<Cycle, Box<dyn Error>> {
    let values = record.iter().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
    let &[number, before, loaded, after, _, settlement, upper, lower, upper_contacts, lower_contacts] = &values[..]
    else {
        return Err(format!("cycles.csv: expected 10 columns, found {}", values.len()).into());
    };
    Ok(Cycle {
        number: number as usize,
        heights: [before, loaded, after],
        settlement: 1e-3 * settlement,
        porosity: [upper, lower],
        coordination: [upper_contacts, lower_contacts],
    })
}

/// Writes the three tables of a run into `folder`.
pub fn write_run(folder: &Path, outcome: &Outcome, parameters: &Parameters) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    write_rows(&folder.join("compress.csv"), &outcome.compression)?;
    write_rows(&folder.join("cycles_path.csv"), &outcome.path)?;
    let (low, high) = (parameters.low / 1e3, parameters.high / 1e3);
    let mut table = csv::Writer::from_path(folder.join("cycles.csv"))?;
    table.write_record([
        "cycle".to_owned(),
        format!("height_at_{low}_before_m"),
        format!("height_at_{high}_m"),
        format!("height_at_{low}_after_m"),
        "permanent_this_cycle_mm".to_owned(),
        format!("permanent_since_first_{low}kPa_mm"),
        format!("porosity_{high}"),
        format!("porosity_{low}"),
        format!("coordination_{high}"),
        format!("coordination_{low}"),
    ])?;
    for cycle in &outcome.cycles {
        let [before, loaded, after] = cycle.heights;
        let permanent = [1e3 * (before - after), 1e3 * cycle.settlement];
        let values = [&[before, loaded, after], &permanent[..], &cycle.porosity, &cycle.coordination].concat();
        table.write_field(cycle.number.to_string())?;
        table.write_record(values.into_iter().map(number))?;
    }
    Ok(table.flush()?)
}

fn write_rows(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let mut table = csv::Writer::from_path(path)?;
    table.write_record([
        "phase",
        "step",
        "plate_height_m",
        "plate_kPa",
        "floor_kPa",
        "porosity",
        "coordination",
        "coordination_no_rattlers",
        "wall_contacts",
        "rattlers",
        "kinetic_J",
    ])?;
    for row in rows {
        table.write_record([
            row.phase.clone(),
            row.step.to_string(),
            number(row.plate_height_m),
            number(row.plate_kpa),
            number(row.floor_kpa),
            number(row.porosity),
            number(row.coordination),
            number(row.coordination_no_rattlers),
            row.wall_contacts.to_string(),
            row.rattlers.to_string(),
            number(row.kinetic_j),
        ])?;
    }
    Ok(table.flush()?)
}

pub fn write_scatter(path: &Path, scatter: &[Scatter]) -> Result<(), Box<dyn Error>> {
    let mut table = csv::Writer::from_path(path)?;
    table.write_record([
        "observable",
        "unit",
        "at",
        "runs",
        "mean",
        "standard_deviation",
        "min",
        "max",
        "reference",
        "bar",
        "within",
    ])?;
    let maybe = |value: Option<f64>| value.map_or(String::new(), number);
    for row in scatter {
        table.write_record([
            row.observable.to_owned(),
            row.unit.to_owned(),
            number(row.at),
            row.runs.to_string(),
            number(row.mean),
            maybe(row.standard_deviation),
            number(row.min),
            number(row.max),
            maybe(row.reference),
            maybe(row.bar),
            row.within.map_or(String::new(), |within| within.to_string()),
        ])?;
    }
    Ok(table.flush()?)
}

/// Nine digits, as `%.9g` writes them.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    if rounded != 0.0 && rounded.abs() < 1e-4 { format!("{rounded:e}") } else { rounded.to_string() }
}
