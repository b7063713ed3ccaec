//! A run's directory: which file holds which part of a [`Run`], and both ways between them.
//!
//! Numbers are written and read back bit for bit, and two equal runs give equal bytes. Values that differ between equal
//! runs go into `timings.json`, which is not part of the [`Run`]. A number that is not finite is refused before any
//! file is touched.

use super::error::check_finite;
use super::histories::{self, HISTORIES};
use super::{ResultsError, Row, Run, write_atomically};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const SCENARIO: &str = "scenario.json";
const SUMMARY: &str = "summary.json";
const TIMINGS: &str = "timings.json";
/// The scene of a result as one file, with every value written out; directories of older versions have none.
pub const RESOLVED: &str = "resolved.track";

/// A file of a result directory: its path in there, and its bytes.
pub type NamedBytes = (String, Vec<u8>);

/// Every file of `run`; `directory` stands in messages only. The summary comes last.
pub fn files(run: &Run, directory: &Path) -> Result<Vec<NamedBytes>, ResultsError> {
    let mut files = vec![
        (SCENARIO, scenario_json(run, directory)?),
        (super::SleeperRow::FILE, table(&run.sleepers, directory)?),
        (super::BlockRow::FILE, table(&run.blocks, directory)?),
        (super::RailRow::FILE, table(&run.rail, directory)?),
    ];
    // these files exist only with several laws, cells that check a law, several trains, or tamping
    if !run.laws.is_empty() {
        files.push((super::LawRow::FILE, table(&run.laws, directory)?));
    }
    if !run.check.is_empty() {
        files.push((super::CheckRow::FILE, table(&run.check, directory)?));
    }
    if !run.trains.is_empty() {
        files.push((super::TrainRow::FILE, table(&run.trains, directory)?));
    }
    if !run.tampings.is_empty() {
        files.push((super::TampingRow::FILE, table(&run.tampings, directory)?));
    }
    let made_by = Some(&run.summary.provenance);
    files.push((HISTORIES, histories::encode(&run.histories, made_by, directory)?));
    let named = files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes));
    let states = super::states::files(run, directory)?;
    let beds = super::under_track_files::files(&run.beds, &run.summary.provenance, directory)?;
    let summary = (SUMMARY.to_owned(), summary_json(run, directory)?);
    Ok(named.chain(beds).chain(states).chain([summary]).collect())
}

/// Writes every file of `run` into `directory`, which is made where it does not exist.
pub fn write(run: &Run, directory: &Path) -> Result<(), ResultsError> {
    write_files(&files(run, directory)?, directory)
}

/// Writes files into `directory`, each at once, in their order.
pub fn write_files(files: &[NamedBytes], directory: &Path) -> Result<(), ResultsError> {
    for (name, bytes) in files {
        let path = directory.join(name);
        let folder = path.parent().unwrap_or(directory);
        fs::create_dir_all(folder).map_err(|cause| ResultsError::io(folder, "create", cause))?;
        write_atomically(&path, bytes)?;
    }
    Ok(())
}

/// The summary of a finished run or test.
pub fn read_summary(directory: &Path) -> Result<super::Summary, ResultsError> {
    read_json(&directory.join(SUMMARY))
}

/// Reads a run back from its directory.
pub fn read(directory: &Path) -> Result<Run, ResultsError> {
    // The summary first: without it the directory holds no run, and the message is to say so.
    let summary: super::Summary = read_json(&directory.join(SUMMARY))?;
    let scenario: crate::scenario::Scenario = read_json(&directory.join(SCENARIO))?;
    let packings = super::packings::read_packings(directory, &summary.scalars, &scenario.solve)?;
    Ok(Run {
        summary,
        sleepers: read_table(directory)?,
        blocks: read_table(directory)?,
        laws: read_table_if_any(directory)?,
        check: read_table_if_any(directory)?,
        rail: read_table(directory)?,
        trains: read_table_if_any(directory)?,
        tampings: read_table_if_any(directory)?,
        histories: histories::decode(&directory.join(HISTORIES))?,
        beds: super::under_track_files::read(directory)?,
        tests: None,
        packings,
        scenario,
    })
}

/// Whether a directory holds the summary of a finished run.
pub(super) fn is_finished(directory: &Path) -> bool {
    directory.join(SUMMARY).is_file()
}

/// Reads the table of sleepers alone.
pub(super) fn read_sleepers(directory: &Path) -> Result<Vec<super::SleeperRow>, ResultsError> {
    read_table(directory)
}

/// `timings.json`: seconds, rates and whatever else differs between two equal runs.
pub fn timings_file(timings: &BTreeMap<String, f64>, directory: &Path) -> Result<NamedBytes, ResultsError> {
    for (row, (name, value)) in timings.iter().enumerate() {
        check_finite(TIMINGS, name, row + 1, *value)?;
    }
    Ok((TIMINGS.to_owned(), json(timings, &directory.join(TIMINGS))?))
}

/// Reads `timings.json`; empty if there is none.
pub fn read_timings(directory: &Path) -> Result<BTreeMap<String, f64>, ResultsError> {
    let path = directory.join(TIMINGS);
    if path.exists() { read_json(&path) } else { Ok(BTreeMap::new()) }
}

fn summary_json(run: &Run, directory: &Path) -> Result<Vec<u8>, ResultsError> {
    let path = directory.join(SUMMARY);
    for (name, scalar) in &run.summary.scalars {
        if ["expectations", "reliance", "provenance"].contains(&name.as_str()) {
            return Err(ResultsError::unwritable(&path, format!("a scalar cannot be called `{name}`")));
        }
        check_finite(SUMMARY, name, 1, scalar.value)?;
    }
    for (row, verdict) in run.summary.expectations.iter().enumerate() {
        verdict.values.iter().try_for_each(|value| check_finite(SUMMARY, "expectations", row + 1, *value))?;
    }
    json(&run.summary, &path)
}

/// JSON cannot hold a number that is not finite: a value that does not come back equal held such a number.
fn scenario_json(run: &Run, directory: &Path) -> Result<Vec<u8>, ResultsError> {
    let path = directory.join(SCENARIO);
    let bytes = json(&run.scenario, &path)?;
    match serde_json::from_slice(&bytes) {
        Ok(back) if run.scenario == back => Ok(bytes),
        Ok(_) => Err(ResultsError::unwritable(&path, "a value of the scene is not finite")),
        Err(cause) => Err(ResultsError::unwritable(&path, format!("a value of the scene is not finite ({cause})"))),
    }
}

pub(super) fn json<T: Serialize>(value: &T, path: &Path) -> Result<Vec<u8>, ResultsError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|cause| ResultsError::unwritable(path, cause))?;
    bytes.push(b'\n');
    Ok(bytes)
}

pub(super) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, ResultsError> {
    let bytes = fs::read(path).map_err(|cause| ResultsError::io(path, "read", cause))?;
    serde_json::from_slice(&bytes).map_err(|cause| ResultsError::malformed(path, cause))
}

pub(super) fn table<R: Row>(rows: &[R], directory: &Path) -> Result<Vec<u8>, ResultsError> {
    let path = directory.join(R::FILE);
    let fail = |cause: csv::Error| ResultsError::unwritable(&path, cause);
    // The header is written by hand so that a table without rows has one too.
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(R::COLUMNS).map_err(fail)?;
    for (index, row) in rows.iter().enumerate() {
        check_row(row, index + 1, &path)?;
        writer.serialize(row).map_err(fail)?;
    }
    writer.into_inner().map_err(|cause| ResultsError::unwritable(&path, cause))
}

fn check_row<R: Row>(row: &R, number: usize, path: &Path) -> Result<(), ResultsError> {
    let column = not_finite(row).map_err(|cause| ResultsError::unwritable(path, cause))?;
    column.map_or(Ok(()), |column| Err(ResultsError::not_finite(R::FILE, column, number)))
}

/// The first column of a row that holds no finite number. JSON turns such a number into null, and a row has no other
/// null.
fn not_finite<R: Row>(row: &R) -> Result<Option<&'static str>, serde_json::Error> {
    let fields = serde_json::to_value(row)?;
    Ok(R::COLUMNS.iter().copied().find(|column| fields[*column].is_null()))
}

/// A table that exists only in some runs.
fn read_table_if_any<R: Row>(directory: &Path) -> Result<Vec<R>, ResultsError> {
    if directory.join(R::FILE).exists() { read_table(directory) } else { Ok(Vec::new()) }
}

fn read_table<R: Row>(directory: &Path) -> Result<Vec<R>, ResultsError> {
    let path = directory.join(R::FILE);
    let bytes = fs::read(&path).map_err(|cause| ResultsError::io(&path, "read", cause))?;
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let header = reader.headers().map_err(|cause| ResultsError::malformed(&path, cause))?;
    if !header.iter().eq(R::COLUMNS.iter().copied()) {
        let found = header.iter().collect::<Vec<_>>().join(",");
        let expected = R::COLUMNS.join(",");
        return Err(ResultsError::malformed(&path, format!("expected columns `{expected}`, found `{found}`")));
    }
    let mut rows: Vec<R> = Vec::new();
    for row in reader.deserialize() {
        let row = row.map_err(|cause| ResultsError::malformed(&path, cause))?;
        if let Some(column) = not_finite(&row).map_err(|cause| ResultsError::malformed(&path, cause))? {
            return Err(ResultsError::read_not_finite(&path, column, rows.len() + 1));
        }
        rows.push(row);
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{BlockRow, RailRow, SleeperRow, example};

    fn columns<R: Row>(row: &R) {
        let fields = serde_json::to_value(row).unwrap();
        let mut expected = R::COLUMNS.to_vec();
        expected.sort_unstable();
        assert!(fields.as_object().unwrap().keys().eq(expected), "{}", R::FILE);
        assert!(!fields.as_object().unwrap().values().any(serde_json::Value::is_null));
    }

    #[test]
    fn columns_are_the_fields() {
        let run = example::transition();
        columns::<SleeperRow>(&run.sleepers[0]);
        columns::<BlockRow>(&run.blocks[0]);
        columns::<RailRow>(&run.rail[0]);
    }

    #[test]
    fn a_run_comes_back_bit_for_bit() {
        let mut run = example::transition();
        run.sleepers[3].settlement_m = 0.1 + 0.2;
        run.sleepers[4].void_m = -0.0;
        run.histories[5].value = f64::MIN_POSITIVE / 7.0;
        run.summary.scalars.get_mut("max_void").unwrap().value = 1.0 / 3.0;
        let directory = tempfile::tempdir().unwrap();
        let (first, second) = (directory.path().join("a/b"), directory.path().join("c"));
        write(&run, &first).unwrap();
        let back = read(&first).unwrap();
        assert!(run == back);
        assert_eq!(back.sleepers[4].void_m.to_bits(), (-0.0_f64).to_bits());
        write(&back, &second).unwrap();
        let mut names: Vec<String> =
            fs::read_dir(&first).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        assert_eq!(
            names,
            [
                "blocks.csv",
                "histories.parquet",
                "rail.csv",
                "scenario.json",
                "sleepers.csv",
                "summary.json",
                "trains.csv"
            ]
        );
        for name in names {
            assert!(fs::read(first.join(&name)).unwrap() == fs::read(second.join(&name)).unwrap(), "{name}");
        }
    }

    #[test]
    fn scalars_stand_at_the_top_level() {
        let run = example::bench();
        let directory = tempfile::tempdir().unwrap();
        write(&run, directory.path()).unwrap();
        let text = fs::read_to_string(directory.path().join(SUMMARY)).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["max_rail_moment"]["value"], 17.66e3);
        assert_eq!(json["max_rail_displacement"]["unit"], "m");
        assert_eq!(json["provenance"]["seed"], 1);
        assert!(read(directory.path()).unwrap() == run);
    }

    #[test]
    fn numbers_that_are_none_are_refused_by_name() {
        let directory = tempfile::tempdir().unwrap();
        let refusal = |change: fn(&mut Run)| {
            let mut run = example::bench();
            change(&mut run);
            write(&run, &directory.path().join("never")).unwrap_err().to_string()
        };
        let text = refusal(|run| run.sleepers[1].max_rail_seat_load_N = f64::NAN);
        assert_eq!(
            text,
            "refused to write `sleepers.csv`: column `max_rail_seat_load_N` of row 2 is not a finite number"
        );
        let text = refusal(|run| run.histories[0].value = f64::INFINITY);
        assert_eq!(text, "refused to write `histories.parquet`: column `value` of row 1 is not a finite number");
        let text = refusal(|run| run.summary.scalars.get_mut("max_rail_moment").unwrap().value = f64::NAN);
        assert_eq!(text, "refused to write `summary.json`: column `max_rail_moment` of row 1 is not a finite number");
        assert!(refusal(|run| run.scenario.solve.gravity.value = f64::NAN).contains("scenario.json"));
        assert!(!directory.path().join("never").exists());
    }

    #[test]
    fn errors_name_the_file_and_what_is_wrong() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path();
        let error = || read(path).unwrap_err().to_string();
        assert!(error().contains("cannot read `") && error().contains("summary.json`"), "{}", error());
        write(&example::bench(), path).unwrap();
        fs::write(path.join("blocks.csv"), "axles,more\n1,2\n").unwrap();
        assert!(error().contains("blocks.csv`: expected columns `axles,block_axles,"), "{}", error());
        let header = BlockRow::COLUMNS.join(",");
        fs::write(path.join("blocks.csv"), format!("{header}\n1,2,x,4,5,6,7,8,9,10\n")).unwrap();
        assert!(error().contains("blocks.csv`") && error().contains("line: 2"), "{}", error());
        fs::write(path.join("blocks.csv"), header).unwrap();
        fs::write(path.join("histories.parquet"), "PAR1 and nothing else").unwrap();
        assert!(error().contains("histories.parquet`") && !error().contains('\n'), "{}", error());
    }

    #[test]
    fn timings_stand_apart() {
        let directory = tempfile::tempdir().unwrap();
        assert!(read_timings(directory.path()).unwrap().is_empty());
        let timings = BTreeMap::from([("wall_s".to_owned(), 12.5)]);
        write_files(&[timings_file(&timings, directory.path()).unwrap()], directory.path()).unwrap();
        assert_eq!(read_timings(directory.path()).unwrap(), timings);
    }
}
