//! The model under the sleepers: every tier is asked, and the cheapest tier that can run the scene is taken.
//!
//! A tier is one file. It states whether it can run a scene, the cost, the expected error, and the nodes of its plan. A
//! tier that cannot run the scene still returns its plan, so that physics rules can check the plan.

mod cells;
mod check;
mod equilibrium;
mod grains;
mod law;
mod loads;
mod refused;
mod rig;
mod soil;
mod volumes;
mod waiting;

pub use cells::Cells;
pub use equilibrium::Equilibrium;
pub use grains::{Full, Zone};
pub use law::SettlementLaws;
pub use rig::TestRig;

use super::{Draft, Pass};
use crate::diag::{Diagnostic, has_errors};
use crate::graph::{Cost, Edge, ExpectedError, Node, Quantity, Rejected, Schedule};
use crate::scenario::{self, Scenario};
use crate::schema::Reads;

/// A model of the track bed under the sleepers.
pub trait Tier: Send + Sync {
    /// The word with which a scene asks for the tier.
    fn name(&self) -> &'static str;

    /// Fields of the scene that the plan and its nodes read.
    fn reads(&self) -> &'static [&'static Reads] {
        &[]
    }

    /// Fields that the plan and its nodes read besides, for this scene.
    fn also_reads(&self, _: &Scenario) -> &'static [&'static Reads] {
        &[]
    }

    /// The plan of a scene, or the reason why the tier has no plan for it.
    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String>;

    /// Whether the tier may run a scene that asks for this word.
    fn answers(&self, word: &str) -> bool {
        self.name() == word
    }
}

/// A plan of a tier.
pub struct Proposal {
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub schedule: Schedule,
    pub cost: Cost,
    /// The decision and its reason, for the plan.
    pub what: String,
    pub why: String,
    pub error: ExpectedError,
    /// Whether this version can run it.
    pub runs: bool,
    /// Reasons against running the plan.
    pub refusals: Vec<Diagnostic>,
}

/// Asks every tier and takes the cheapest that can run.
pub(super) struct ChooseTier<'t>(pub &'t [Box<dyn Tier>]);

impl Pass for ChooseTier<'_> {
    fn name(&self) -> &'static str {
        "tier"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        // with `auto` the planner chooses
        let word = Some(*draft.scenario.solve.grains.tier)
            .filter(|tier| *tier != scenario::Tier::Auto)
            .map(scenario::Tier::name);
        let mut rejected = Vec::new();
        let mut offers: Vec<(&'static str, Proposal)> = Vec::new();
        for tier in self.0 {
            match tier.propose(draft) {
                Ok(proposal) if word.is_none_or(|word| tier.answers(word)) => offers.push((tier.name(), proposal)),
                // a budget has compared the others already
                Ok(_) if draft.scenario.solve.grains.tier.origin == scenario::Origin::Derived => {}
                Ok(proposal) => rejected.push(not_asked(tier.name(), &proposal)),
                Err(why) => rejected.push(Rejected::new(tier.name(), why)),
            }
        }
        // plans that can run come first, then the cheapest; equal plans keep the order of the tiers
        offers.sort_by(|(_, a), (_, b)| {
            let seconds = |proposal: &Proposal| proposal.cost.seconds_on_two_cores;
            b.runs.cmp(&a.runs).then(seconds(a).total_cmp(&seconds(b)))
        });
        let mut offers = offers.into_iter();
        let Some((name, mut taken)) = offers.next() else {
            let refused = loads::refusals(draft.scenario, None);
            let waits = if refused.is_empty() { waiting::refusal(draft.scenario) } else { None };
            draft.diagnostics.extend(refused.into_iter().chain(waits));
            return;
        };
        rejected.extend(offers.map(|(name, proposal)| dearer(name, &proposal)));
        draft.tier = Some(name);
        taken.refusals.extend(loads::refusals(draft.scenario, Some(&taken.schedule)));
        take(draft, taken, rejected);
    }
}

fn take(draft: &mut Draft<'_>, taken: Proposal, rejected: Vec<Rejected>) {
    let Proposal { nodes, edges, schedule, cost, what, why, error, refusals, runs } = taken;
    draft.refusals = refusals;
    (draft.nodes, draft.edges, draft.error) = (nodes, edges, error);
    (draft.schedule, draft.cost) = (Some(schedule), Some(cost));
    // a plan with an error is shown but not run, even if its tier can run it
    draft.runs = runs && !has_errors(&draft.refusals);
    draft.decide_against("tier", what, why, rejected);
}

fn not_asked(name: &str, proposal: &Proposal) -> Rejected {
    let why = "the scene asks for another tier".to_owned();
    offered(name, why, proposal)
}

fn dearer(name: &str, proposal: &Proposal) -> Rejected {
    let why = if proposal.runs { "it costs more" } else { "this version cannot run it yet" };
    offered(name, why.to_owned(), proposal)
}

fn offered(name: &str, why: String, proposal: &Proposal) -> Rejected {
    let seconds = Some(proposal.cost.seconds_on_two_cores);
    Rejected { seconds, error: proposal.error.share(), ..Rejected::new(name, why) }
}

/// Edges for all quantities that one node takes and another node gives.
fn edges(nodes: &[Node]) -> Vec<Edge> {
    let mut edges = Vec::new();
    for to in nodes {
        for quantity in to.ports().takes {
            let gives = |node: &&Node| node.name != to.name && node.ports().gives.contains(&quantity);
            let from = nodes.iter().find(gives);
            edges.extend(from.map(|from: &Node| Edge::new(&from.name, &to.name, &quantity as &Quantity)));
        }
    }
    edges
}
