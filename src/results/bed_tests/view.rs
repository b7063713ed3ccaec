//! Tests with the last bed at its end: the data of the page, stored beside the tables (`tests.json`).

use super::super::files::read_json;
use super::super::{Grain, Link, ResultsError, Run, grains, links};
use super::BedTests;
use crate::solvers::granular::{Bed, Domain, Failure, Real, Wall};
use serde::{Deserialize, Serialize};
use std::path::Path;

pub(super) const VIEW: &str = "tests.json";

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct BedTestsView {
    pub run: Run,
    pub tests: BedTests,
    pub grains: Vec<Grain>,
    pub links: Vec<Link>,
    pub walls: Vec<Wall>,
    pub domain: Domain,
}

impl BedTestsView {
    /// The view of tests whose last bed ended so.
    pub fn new<R: Real>(mut run: Run, bed: &mut Bed<R>) -> Result<Option<BedTestsView>, Failure> {
        let Some(tests) = run.tests.take() else { return Ok(None) };
        let snapshot = bed.snapshot()?;
        let (grains, links) = (grains(bed, &snapshot, None), links(bed, &snapshot));
        Ok(Some(BedTestsView { run, tests, grains, links, walls: bed.walls().to_vec(), domain: *bed.domain() }))
    }

    /// The view of a run, of the views of all its packings in their order; `None` if there are no tests.
    pub fn of_packings(mut run: Run, mut packings: Vec<BedTestsView>) -> Option<BedTestsView> {
        let (tests, last) = (run.tests.take()?, packings.pop()?);
        Some(BedTestsView { run, tests, ..last })
    }
}

/// The tests of a directory; `None` if it holds none.
pub fn read_tests(directory: &Path) -> Result<Option<BedTestsView>, ResultsError> {
    let path = directory.join(VIEW);
    path.exists().then(|| read_json(&path)).transpose()
}
