//! A directory of finished results, read.

use super::kind::Kind;
use super::made::Made;
use super::study_table::StudyTable;
use super::{CompareError, Sample};
use crate::results::{self, BedTests, BedTestsView, RESOLVED, Run, Scalar, TestTables};
use crate::store::Finished;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// One directory.
#[derive(Debug)]
pub struct Subject {
    /// A short name, unlike those of the others.
    pub name: String,
    pub path: PathBuf,
    pub content: Content,
    /// The whole scene as one file; `None` if an older version has not kept it.
    pub resolved: Option<String>,
    /// The program that made it, its file and its seed.
    pub made: Made,
}

#[derive(Debug)]
pub enum Content {
    Run(Box<Run>),
    Tests(Box<BedTestsView>),
    Study(Box<StudyTable>),
}

impl Subject {
    /// Reads a directory under a name; each of its files is checked against its hash.
    pub fn read((name, path): (String, &PathBuf)) -> Result<Subject, CompareError> {
        let finished = Finished::open(path)?.ok_or_else(|| CompareError::Nothing { path: path.clone() })?;
        finished.verify()?;
        let text = finished.read(RESOLVED)?.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let (content, made) = content(&finished, path)?;
        Ok(Subject { name, path: path.clone(), content, resolved: text, made })
    }

    pub fn kind(&self) -> Kind {
        match self.content {
            Content::Run(_) => Kind::Run,
            Content::Tests(_) => Kind::Tests,
            Content::Study(_) => Kind::Study,
        }
    }

    /// The run of a track.
    pub fn run(&self) -> Option<&Run> {
        match &self.content {
            Content::Run(run) => Some(run),
            _ => None,
        }
    }

    /// The tests of a rig.
    pub fn tests(&self) -> Option<&BedTestsView> {
        match &self.content {
            Content::Tests(view) => Some(view),
            _ => None,
        }
    }

    pub fn study(&self) -> Option<&StudyTable> {
        match &self.content {
            Content::Study(study) => Some(study),
            _ => None,
        }
    }

    /// Every scalar of a run or of tests: its value on each packing, and its unit.
    pub fn scalars(&self) -> BTreeMap<String, (Sample, String)> {
        let mut all: BTreeMap<String, (Sample, String)> = BTreeMap::new();
        for (seed, scalars) in self.packings() {
            for (name, Scalar { value, unit }) in scalars {
                let (sample, _) = all.entry(name).or_insert_with(|| (Sample::default(), unit));
                sample.values.push((seed, value));
            }
        }
        all
    }

    /// Seeds and scalars of the packings; a result of one has one.
    fn packings(&self) -> Vec<(u64, BTreeMap<String, Scalar>)> {
        match &self.content {
            Content::Run(run) => {
                let own = (run.scenario.solve.seed, run.summary.scalars.clone());
                let further = run.packings.iter().map(|packing| (packing.seed, packing.scalars.clone()));
                std::iter::once(own).chain(further).collect()
            }
            Content::Tests(view) => {
                let one = |test: &results::BedTest| BedTests { tests: vec![test.clone()], ..view.tests.clone() };
                view.tests.tests.iter().map(|test| (test.answer.seed, TestTables::new(&one(test)).scalars)).collect()
            }
            Content::Study(_) => Vec::new(),
        }
    }
}

/// Type of the results in a finished directory, by its files.
fn content(finished: &Finished, path: &Path) -> Result<(Content, Made), CompareError> {
    let manifest = finished.manifest();
    let has = |name: &str| manifest.file(name).is_some();
    if has("study.json") {
        let study = StudyTable::read(finished, path)?;
        let made = study.made.clone();
        return Ok((Content::Study(Box::new(study)), made));
    }
    if let Some(view) = results::read_tests(path)? {
        let made = Made::of_summary(&view.run.scenario.title, &view.run.summary);
        return Ok((Content::Tests(Box::new(view)), made));
    }
    if !has("summary.json") {
        let work = manifest.work.name.clone();
        return Err(CompareError::Other { path: path.to_owned(), work });
    }
    let run = results::read(path)?;
    let made = Made::of_summary(&run.scenario.title, &run.summary);
    Ok((Content::Run(Box::new(run)), made))
}
