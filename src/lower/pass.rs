//! The trait of a pass, and the draft plan that passes change.

use super::Origins;
use crate::diag::{Diagnostic, has_errors};
use crate::graph::{
    Blocks, Cost, Decision, Edge, ExpectedError, Node, PassagePlan, Record, Rejected, Schedule, SupportNode,
};
use crate::scenario::Scenario;
use crate::schema::Reads;

/// One decision of the planner; see [`super::Planner`] for the list of passes.
pub trait Pass: Send + Sync {
    /// The name of the pass in the plan and in `--without`.
    fn name(&self) -> &'static str;

    /// Fields of the scene that the pass reads.
    fn reads(&self) -> &'static [&'static Reads] {
        &[]
    }

    /// Whether the pass acts on a scene.
    fn acts(&self, _: &Scenario) -> bool {
        true
    }

    /// Makes the decision and reports it.
    fn run(&self, draft: &mut Draft<'_>);

    /// Replacement if the pass is left out: it costs more and adds no error. `None` if there is no plan without the
    /// pass.
    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        None
    }
}

/// A plan that the passes complete step by step.
pub struct Draft<'a> {
    pub scenario: &'a Scenario,
    pub origins: &'a Origins,
    /// Elements of the rail between two seats.
    pub elements_per_bay: u32,
    /// The passage of each kind of train, in the order of the traffic; empty if no train runs.
    pub passages: Vec<PassagePlan>,
    /// The loop over axles, before a tier uses it.
    pub blocks: Option<Blocks>,
    /// Settlement of every seat after all axles by the law of the scene, m; `None` if no tier asks for it or the law
    /// cannot run.
    pub by_law: Option<&'a [f64]>,
    /// Chainages between which the tier `zone` has grains, m.
    pub bays: Vec<[f64; 2]>,
    /// The name of the tier that was taken.
    pub tier: Option<&'static str>,
    /// The support of every seat of a track, as far as it is known from the scene or its layers.
    pub supports: Vec<SupportNode>,
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub schedule: Option<Schedule>,
    pub records: Vec<Record>,
    pub cost: Option<Cost>,
    pub error: ExpectedError,
    /// Whether this version can run the plan of the tier.
    pub runs: bool,
    pub decisions: Vec<Decision>,
    pub diagnostics: Vec<Diagnostic>,
    /// Reasons against running the plan, which can still be shown.
    pub refusals: Vec<Diagnostic>,
}

impl<'a> Draft<'a> {
    pub(super) fn new(scenario: &'a Scenario, origins: &'a Origins, by_law: Option<&'a [f64]>) -> Draft<'a> {
        Draft {
            scenario,
            origins,
            elements_per_bay: *scenario.solve.elements_per_bay,
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
            error: ExpectedError::default(),
            runs: false,
            decisions: Vec::new(),
            diagnostics: Vec::new(),
            refusals: Vec::new(),
        }
    }

    /// Adds a decision of a pass and its reason.
    pub fn decide(&mut self, pass: &str, what: impl Into<String>, why: impl Into<String>) {
        self.decide_against(pass, what, why, Vec::new());
    }

    /// Adds a decision of a pass, its reason, and the rejected alternatives.
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

    /// Whether the plan has an error.
    pub fn is_wrong(&self) -> bool {
        has_errors(&self.diagnostics)
    }
}
