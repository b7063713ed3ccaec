//! A point of a study: the scene with some lines edited.

use super::design::Level;
use crate::check::{Modules, Override};
use crate::compile::{Compiled, compile, fingerprint};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lower;
use crate::scenario::{Study, Track};
use crate::store::sha256;

/// A scene that can be compiled many times.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub name: &'a str,
    pub text: &'a str,
    pub modules: &'a (dyn Modules + Sync),
    /// Overrides of every point, from the command line.
    pub set: &'a [Override],
}

/// A point that will run.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPoint {
    /// Its number in the design, from 1; 0 for the scene as it is, if no point of the design equals it.
    pub number: usize,
    /// Whether it is the scene as it is: with the settings of the study, and without varied values.
    pub as_it_is: bool,
    /// One for each axis.
    pub levels: Vec<Level>,
    pub overrides: Vec<Override>,
    /// Identifies the run: SHA-256 over the study's name and every text of the point, with its own lines.
    pub fingerprint: String,
    /// Time of one run on one core, estimated, s.
    pub seconds: f64,
    /// Memory of one run, estimated, bytes.
    pub bytes: u64,
    pub seed: u64,
}

impl Scene<'_> {
    pub fn compile(&self, overrides: &[Override]) -> Compiled {
        let all = [self.set, overrides].concat();
        compile(self.name, self.text, self.modules, &all)
    }
}

impl PlannedPoint {
    /// Identifies one of its runs.
    pub fn key(&self, repeat: u32) -> String {
        format!("{}-{repeat}", self.fingerprint)
    }

    /// The lines of one of its runs: the first run has the seed of the scene, each further run the next seed.
    pub fn overrides_of(&self, repeat: u32) -> Vec<Override> {
        let seed = self.seed + u64::from(repeat);
        let further = (repeat > 0).then(|| Override { path: "solve.seed".into(), value: seed.to_string() });
        self.overrides.iter().cloned().chain(further).collect()
    }
}

/// The lines that a study edits in the same way in every point.
pub(super) fn settings(study: &Study) -> Vec<Override> {
    study.set.iter().map(|s| Override { path: s.path.clone(), value: s.value.clone() }).collect()
}

/// `open.pad.stiffness = 40 MN/m, ore.speed = 200 km/h`
pub fn values(study: &Study, levels: &[Level]) -> String {
    let lines = study.axes.iter().zip(levels).map(|(axis, level)| format!("{} = {}", axis.path, level.text));
    lines.collect::<Vec<_>>().join(", ")
}

/// Identifies the questions and the scene of a point: two studies of one file ask different questions about one scene.
pub(super) fn content(study: &Study, compiled: &Compiled) -> String {
    sha256(format!("{}\n{}", study.name, fingerprint(&compiled.sources)).as_bytes())
}

/// Finds a requested value that no run stores, so that the study does not fail after the first run.
pub(super) fn leaves_open(graph: &Graph, track: &Track, study: &Study) -> Option<Diagnostic> {
    let measured = study.measured();
    let compared = study.constraints.iter().flat_map(|c| &c.operands);
    let why = measured.iter().map(|m| &m.expression).chain(compared).find_map(|e| lower::not_kept(e, graph, track))?;
    let help =
        "ask for values of the tables (see section 6 of the guide), or `record` the value at the seats of interest";
    Some(Diagnostic::new(Code::E0705, why).help(help))
}
