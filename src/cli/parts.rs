//! Packings of a test rig as parts of a run: processes that share them compute each packing in a directory of its own
//! below the directory of the run, and the run is made of the finished parts.

use crate::graph::Graph;
use crate::results::{self, BedTest, BedTestsView, ResultsError};
use crate::scenario::Grains;
use crate::store::{Directory, Finished, StoreError, Unfinished, Work};
use std::path::PathBuf;

/// Says that the packings of a run are computed as parts.
const DIVIDED: &str = "divided";

/// The finished parts of a run.
pub(super) struct Parts {
    /// In the order of the packings.
    pub views: Vec<BedTestsView>,
    /// Seconds of computing of all of them.
    pub seconds: f64,
    /// Number of starts and continuations.
    pub starts: u64,
}

impl Parts {
    /// Makes parts of the packings of a run that is begun.
    pub fn divide(run: &Directory) -> Result<(), StoreError> {
        run.keep(DIVIDED, b"").map(drop)
    }

    /// Directory of each part, by the place of its packing; empty if the run is computed as a whole.
    pub fn directories(run: &Unfinished, graph: &Graph) -> Result<Vec<PathBuf>, StoreError> {
        let is_divided = run.kept(DIVIDED)?.is_some();
        let packings = graph.tested_packings().filter(|_| is_divided).unwrap_or(0);
        Ok((0..packings).map(|place| run.part(&place.to_string())).collect())
    }

    /// The parts of a run; `None` if it is computed as a whole. Fails if a part is not finished.
    pub fn read(run: &Unfinished, graph: &Graph, work: &Work) -> Result<Option<Parts>, ResultsError> {
        let mut parts = Parts { views: Vec::new(), seconds: 0.0, starts: 0 };
        for directory in Parts::directories(run, graph)? {
            let unfinished = || StoreError::damaged(&directory, "this packing of the run is not finished");
            let finished = Finished::open(&directory)?.filter(|finished| finished.manifest().work == *work);
            finished.ok_or_else(unfinished)?.verify()?;
            parts.views.push(results::read_tests(&directory)?.ok_or_else(unfinished)?);
            let timings = results::read_timings(&directory)?;
            let timing = |name: &str| timings.get(name).copied().unwrap_or(0.0);
            parts.seconds += timing("solve_s");
            parts.starts += timing("parts") as u64;
        }
        Ok(Some(parts).filter(|parts| !parts.views.is_empty()))
    }

    /// The first parts that suffice for an open range of repeats; otherwise all.
    pub fn sufficient(mut self, grains: &Grains) -> Parts {
        let tests = |views: &[BedTestsView]| {
            let mut all = views[0].tests.clone();
            all.tests = views.iter().flat_map(|view| view.tests.tests.clone()).collect();
            all
        };
        let is_enough = |count: &usize| grains.repeats.are_open() && tests(&self.views[..*count]).are_enough(grains);
        if let Some(count) = (1..self.views.len()).find(is_enough) {
            self.views.truncate(count);
        }
        self
    }

    /// The test of every packing.
    pub fn tests(&self) -> Vec<BedTest> {
        self.views.iter().flat_map(|view| view.tests.tests.clone()).collect()
    }
}
