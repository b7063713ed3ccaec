//! What stands under the sleepers: every tier is asked, and the cheapest that answers is taken.
//!
//! A tier is one file: it says whether it can run a scene, what that costs, by how much it is expected to be off, and which nodes it
//! makes. One that refuses yields its plan all the same, so that physics rules can speak of it.

mod cells;
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
use crate::graph::{Cost, Edge, Node, Quantity, Rejected, Schedule};
use crate::scenario;
use crate::schema::Reads;

/// A model of what lies under the sleepers.
pub trait Tier: Send + Sync {
    /// The word by which a scene asks for it.
    fn name(&self) -> &'static str;

    /// Which fields of the scene its plan reads, and with them the nodes of the plan.
    fn reads(&self) -> &'static [&'static Reads] {
        &[]
    }

    /// The plan that it makes of a scene; why there is none where the scene is not for it.
    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String>;

    /// Whether a scene that asks for a tier by this word is content with it.
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
    /// In words, for the plan.
    pub what: String,
    pub why: String,
    pub error: ExpectedError,
    /// Whether this version can run it.
    pub runs: bool,
    /// What stands against running it.
    pub refusals: Vec<Diagnostic>,
}

/// By how much a tier is expected to be off.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedError {
    /// The error divided by the largest settlement; `None` where nobody has measured it.
    pub share: Option<f64>,
    /// The evidence for this share.
    pub evidence: String,
}

/// Asks every tier and takes the cheapest that can run.
pub(super) struct ChooseTier<'t>(pub &'t [Box<dyn Tier>]);

impl Pass for ChooseTier<'_> {
    fn name(&self) -> &'static str {
        "tier"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let word = asked(*draft.scenario.solve.grains.tier);
        let mut rejected = Vec::new();
        let mut offers: Vec<(&'static str, Proposal)> = Vec::new();
        for tier in self.0 {
            match tier.propose(draft) {
                Ok(proposal) if word.is_none_or(|word| tier.answers(word)) => offers.push((tier.name(), proposal)),
                Ok(proposal) => rejected.push(not_asked(tier.name(), &proposal)),
                Err(why) => rejected.push(Rejected { what: tier.name().into(), why, seconds: None }),
            }
        }
        // those that run first, the cheapest of them first; equal ones stay in the order of the tiers
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
    let Proposal { nodes, edges, schedule, cost, what, why, refusals, runs, .. } = taken;
    draft.refusals = refusals;
    (draft.nodes, draft.edges) = (nodes, edges);
    (draft.schedule, draft.cost) = (Some(schedule), Some(cost));
    // whatever its tier says, a plan against which an error stands is only looked at
    draft.runs = runs && !has_errors(&draft.refusals);
    draft.decide_against("tier", what, why, rejected);
}

/// The word of a tier; `None` leaves the choice to the planner.
fn asked(tier: scenario::Tier) -> Option<&'static str> {
    match tier {
        scenario::Tier::Auto => None,
        scenario::Tier::Law => Some("law"),
        scenario::Tier::Cells => Some("cells"),
        scenario::Tier::Zone => Some("zone"),
        scenario::Tier::Full => Some("full"),
    }
}

fn not_asked(name: &str, proposal: &Proposal) -> Rejected {
    let why = "the scene asks for another tier".to_owned();
    Rejected { what: name.into(), why, seconds: Some(proposal.cost.seconds_on_two_cores) }
}

fn dearer(name: &str, proposal: &Proposal) -> Rejected {
    let why = if proposal.runs { "it costs more" } else { "this version cannot run it yet" };
    let error = match proposal.error.share {
        Some(share) => format!("{why}; off by about {} % ({})", (100.0 * share).round(), proposal.error.evidence),
        None => format!("{why}; {}", proposal.error.evidence),
    };
    Rejected { what: name.into(), why: error, seconds: Some(proposal.cost.seconds_on_two_cores) }
}

/// Edges that bring everything that a node takes and another gives.
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
