//! A point of a study: the scene with some lines edited.

use super::design::Level;
use crate::check::{Modules, Override};
use crate::compile::{Compiled, compile, fingerprint};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lower;
use crate::scenario::{Study, Track};
use crate::store::sha256;

/// A scene that can be compiled again and again.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub name: &'a str,
    pub text: &'a str,
    pub modules: &'a (dyn Modules + Sync),
    /// Overrides of every point, those of the command line.
    pub set: &'a [Override],
}

/// A point that will run.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPoint {
    /// Its place in the design, from 1; 0 of the scene as it is, where no point of the design is that.
    pub number: usize,
    /// Whether it is the scene as it is: with what the study sets, and as if nothing varied.
    pub as_it_is: bool,
    /// One for each axis.
    pub levels: Vec<Level>,
    pub overrides: Vec<Override>,
    /// Names what runs: SHA-256 over the study's name and every text of the point, its own lines included.
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
    /// Names one of its runs.
    pub fn key(&self, repeat: u32) -> String {
        format!("{}-{repeat}", self.fingerprint)
    }

    /// The lines of one of its runs: the first has the seed of the scene, each further one the next.
    pub fn overrides_of(&self, repeat: u32) -> Vec<Override> {
        let seed = self.seed + u64::from(repeat);
        let further = (repeat > 0).then(|| Override { path: "solve.seed".into(), value: seed.to_string() });
        self.overrides.iter().cloned().chain(further).collect()
    }
}

/// The lines that a study edits alike in every point.
pub(super) fn settings(study: &Study) -> Vec<Override> {
    study.set.iter().map(|s| Override { path: s.path.clone(), value: s.value.clone() }).collect()
}

/// `open.pad.stiffness = 40 MN/m, ore.speed = 200 km/h`
pub fn values(study: &Study, levels: &[Level]) -> String {
    let lines = study.axes.iter().zip(levels).map(|(axis, level)| format!("{} = {}", axis.path, level.text));
    lines.collect::<Vec<_>>().join(", ")
}

/// Names what a point asks and of what: two studies of one file ask other things of one scene.
pub(super) fn content(study: &Study, compiled: &Compiled) -> String {
    sha256(format!("{}\n{}", study.name, fingerprint(&compiled.sources)).as_bytes())
}

/// A study that asks for what no run keeps would learn so after the first one.
pub(super) fn leaves_open(graph: &Graph, track: &Track, study: &Study) -> Option<Diagnostic> {
    let measured = study.measured();
    let compared = study.constraints.iter().flat_map(|c| &c.operands);
    let why = measured.iter().map(|m| &m.expression).chain(compared).find_map(|e| lower::not_kept(e, graph, track))?;
    let help = "ask for what the tables hold (see section 6 of the guide), or `record` it at the seats of interest";
    Some(Diagnostic::new(Code::E0705, why).help(help))
}
