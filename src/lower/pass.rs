//! What a pass is, and what passes work on.

use super::Origins;
use crate::diag::{Diagnostic, has_errors};
use crate::graph::{Blocks, Cost, Decision, Edge, Node, PassagePlan, Record, Rejected, Schedule, SupportNode};
use crate::scenario::Scenario;
use crate::schema::Reads;

/// One decision of the planner. The list of passes is the story of a plan; see [`super::Planner`].
pub trait Pass: Send + Sync {
    /// The name by which it is switched off and told.
    fn name(&self) -> &'static str;

    /// Which fields of the scene it reads.
    fn reads(&self) -> &'static [&'static Reads] {
        &[]
    }

    /// Whether it has something to decide about a scene.
    fn acts(&self, _: &Scenario) -> bool {
        true
    }

    /// Decides, and says so.
    fn run(&self, draft: &mut Draft<'_>);

    /// Leaves the decision out: what stands in its place is dearer and makes no error of its own. `None` of a pass without which
    /// there is no plan.
    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        None
    }
}

/// A plan on its way through the passes.
pub struct Draft<'a> {
    pub scenario: &'a Scenario,
    pub origins: &'a Origins,
    /// The passage of each kind of train, in the order of the traffic; none where no train runs.
    pub passages: Vec<PassagePlan>,
    /// The loop over axles, before a tier takes it.
    pub blocks: Option<Blocks>,
    /// Settlement of every seat after all axles by the law of the scene, m; `None` where no tier asks for it or the law cannot run.
    pub by_law: Option<&'a [f64]>,
    /// Chainages between which the tier `zone` has grains, m.
    pub bays: Vec<[f64; 2]>,
    /// The name of the tier that was taken.
    pub tier: Option<&'static str>,
    /// What carries every seat of a track, as far as the scene or its layers say.
    pub supports: Vec<SupportNode>,
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub schedule: Option<Schedule>,
    pub records: Vec<Record>,
    pub cost: Option<Cost>,
    /// Whether this version can run what the tier made.
    pub runs: bool,
    pub decisions: Vec<Decision>,
    pub diagnostics: Vec<Diagnostic>,
    /// What stands against running the plan, which can be looked at all the same.
    pub refusals: Vec<Diagnostic>,
}

impl<'a> Draft<'a> {
    pub(super) fn new(scenario: &'a Scenario, origins: &'a Origins, by_law: Option<&'a [f64]>) -> Draft<'a> {
        Draft {
            scenario,
            origins,
            passages: Vec::new(),
            blocks: None,
            by_law,
            bays: Vec::new(),
            tier: None,
            supports: Vec::new(),
            nodes: Vec::new(),
            edges: Vec::new(),
            schedule: None,
            records: Vec::new(),
            cost: None,
            runs: false,
            decisions: Vec::new(),
            diagnostics: Vec::new(),
            refusals: Vec::new(),
        }
    }

    /// Says what a pass decided, and why.
    pub fn decide(&mut self, pass: &str, what: impl Into<String>, why: impl Into<String>) {
        self.decide_against(pass, what, why, Vec::new());
    }

    /// Says what a pass decided, why, and what it did not take.
    pub fn decide_against(
        &mut self,
        pass: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        rejected: Vec<Rejected>,
    ) {
        self.decisions.push(Decision { pass: pass.into(), what: what.into(), why: why.into(), rejected });
    }

    /// Whether rails, pads and supports of known stiffness carry a wheel all along the track.
    pub fn is_sprung(&self) -> bool {
        let track = &self.scenario.track;
        let mut seats = track.seats.iter().zip(&self.supports);
        track.has_rails()
            && seats.all(|(seat, node)| seat.pad.is_some() && (!seat.is_ballasted() || node.spring.is_some()))
    }

    /// Whether a mistake stands against the plan.
    pub fn is_wrong(&self) -> bool {
        has_errors(&self.diagnostics)
    }
}
