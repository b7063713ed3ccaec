//! The directory of tests of packed beds.

use super::super::error::check_finite;
use super::super::files::{json, table};
use super::super::{NamedBytes, ResultsError, Row, bodies_vtk, contacts_vtk};
use super::view::VIEW;
use super::{BedTestsView, CycleRow, LoopRow, SensorRow, SpecimenRow, VolumeRow};
use std::path::Path;

const SUMMARY: &str = "summary.json";
const BEDS: &str = "beds.json";
const BODIES: &str = "bodies.vtp";
const CONTACTS: &str = "contacts.vtp";

/// Every file of tests: tables, the last bed, the data of the page, and the summary, which comes last. `directory` is
/// used in messages only. Equal runs give equal bytes.
pub fn test_files(view: &BedTestsView, directory: &Path) -> Result<Vec<NamedBytes>, ResultsError> {
    let (run, tests) = (&view.run, &view.tests);
    for (name, scalar) in &run.summary.scalars {
        check_finite(SUMMARY, name, 1, scalar.value)?;
    }
    let beds: Vec<_> = tests.tests.iter().map(|test| &test.bed).collect();
    let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
    bodies_vtk(&view.grains, &mut bodies)
        .and(contacts_vtk(&view.links, &mut contacts))
        .map_err(|cause| ResultsError::unwritable(&directory.join(BODIES), cause))?;
    let mut files = vec![
        (BODIES, bodies),
        (CONTACTS, contacts),
        (CycleRow::FILE, table(&tests.cycles(), directory)?),
        (LoopRow::FILE, table(&tests.loops(), directory)?),
        (SensorRow::FILE, table(&tests.readings(), directory)?),
        (VolumeRow::FILE, table(&tests.volumes(), directory)?),
    ];
    if tests.tests.iter().any(|test| !test.answer.specimen.is_empty()) {
        files.push((SpecimenRow::FILE, table(&tests.specimen(), directory)?));
    }
    files.extend([
        (VIEW, tests_file(view, directory)?.1),
        (BEDS, json(&beds, &directory.join(BEDS))?),
        (SUMMARY, json(&run.summary, &directory.join(SUMMARY))?),
    ]);
    Ok(files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect())
}

/// The file of the view of tests, which [`read_tests`](super::read_tests) reads. `directory` is used in messages only.
pub fn tests_file(view: &BedTestsView, directory: &Path) -> Result<NamedBytes, ResultsError> {
    let bytes = serde_json::to_vec(view).map_err(|cause| ResultsError::unwritable(&directory.join(VIEW), cause))?;
    Ok((VIEW.to_owned(), bytes))
}
