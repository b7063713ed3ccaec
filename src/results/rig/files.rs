//! The directory of a test rig.

use super::super::files::{check_finite, json, table};
use super::super::{ResultsError, Row, write_atomically};
use super::view::VIEW;
use super::{CycleRow, LoopRow, RigView, SensorRow, SpecimenRow, VolumeRow};
use std::fs;
use std::path::Path;

const SUMMARY: &str = "summary.json";
const BEDS: &str = "beds.json";

/// Writes tables, the view and the summary into `directory`, which is made where it does not exist. Equal runs leave equal bytes.
pub fn write_rig(view: &RigView, directory: &Path) -> Result<(), ResultsError> {
    let run = &view.run;
    for (name, scalar) in &run.summary.scalars {
        check_finite(SUMMARY, name, 1, scalar.value)?;
    }
    let beds: Vec<_> = run.tests.iter().map(|test| &test.bed).collect();
    let mut files = vec![
        (CycleRow::FILE, table(&run.cycles(), directory)?),
        (LoopRow::FILE, table(&run.loops(), directory)?),
        (SensorRow::FILE, table(&run.readings(), directory)?),
        (VolumeRow::FILE, table(&run.volumes(), directory)?),
    ];
    if run.tests.iter().any(|test| !test.specimen.is_empty()) {
        files.push((SpecimenRow::FILE, table(&run.specimen(), directory)?));
    }
    let whole = serde_json::to_vec(view).map_err(|cause| ResultsError::unwritable(&directory.join(VIEW), cause))?;
    files.extend([
        (VIEW, whole),
        (BEDS, json(&beds, &directory.join(BEDS))?),
        (SUMMARY, json(&run.summary, &directory.join(SUMMARY))?), // last: a directory with a summary is complete
    ]);
    fs::create_dir_all(directory).map_err(|cause| ResultsError::io(directory, "create", cause))?;
    files.iter().try_for_each(|(name, bytes)| Ok(write_atomically(&directory.join(name), bytes)?))
}
