//! The tier of a scene with `substructure = auto` and a `budget`: the cheapest one whose expected error is within the
//! `tolerance`, or else the most accurate one that the `budget` and the `memory` allow.
//!
//! Without a budget `auto` never takes grains: they take hours.
//!
//! If it takes the law of a scene with grains, some cells of grains check the law, as far as the budget allows. Where
//! both part by more than the tolerance leaves beside the error of cells, the run begins again in the next better tier.

use super::by_law;
use crate::diag::has_errors;
use crate::graph::{Decision, ExpectedError, Graph, Rejected};
use crate::lower::Planner;
use crate::scenario::{Given, Grains, Loading, Origin, Scenario, Tier};
use crate::units::{duration, number, percent};

/// The scene with the tier that was taken, and the decision for its plan.
pub struct Taken {
    pub scenario: Scenario,
    pub decision: Decision,
    pub next: Option<NextTier>,
}

/// The tier in which a run begins again if its law and the cells that check it part too far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextTier {
    pub tier: Tier,
    /// Difference / largest settlement that the tolerance leaves beside the expected error of cells.
    pub limit: f64,
    /// The tolerance of trains that are left out there, if the planner has one.
    pub tolerance: Option<f64>,
}

/// Cells of each kind that check a law.
const CHECKS: u32 = 2;

/// A tier that can run the scene.
struct Offer {
    tier: Tier,
    seconds: f64,
    bytes: f64,
    /// Expected error / largest settlement; infinite if it is not known.
    error: f64,
    /// Its parts.
    parts: ExpectedError,
}

/// Chooses the tier; `None` if the scene leaves no choice.
pub fn tier(planner: &Planner, scenario: &Scenario) -> Option<Taken> {
    let grains = &scenario.solve.grains;
    let budget = *grains.budget?;
    if *grains.tier != Tier::Auto || !matches!(scenario.loading, Some(Loading::Traffic(_))) {
        return None;
    }
    let offers: Vec<Offer> = [Tier::Law, Tier::Cells, Tier::Zone, Tier::Full]
        .into_iter()
        .filter_map(|tier| offer(planner, scenario, tier))
        .collect();
    if offers.iter().all(|offer| offer.tier == Tier::Law) {
        return None;
    }
    let fits = |offer: &&Offer| offer.seconds <= budget && grains.memory.is_none_or(|memory| offer.bytes <= *memory);
    let accurate = |offer: &&Offer| offer.error <= *grains.tolerance;
    let cheapest = |a: &&Offer, b: &&Offer| a.seconds.total_cmp(&b.seconds);
    let (taken, mut why) = if let Some(offer) = offers.iter().filter(fits).filter(accurate).min_by(cheapest) {
        (offer, "it is the cheapest tier with an expected error within the `tolerance`".to_owned())
    } else if let Some(offer) = offers.iter().filter(fits).min_by(|a, b| a.error.total_cmp(&b.error)) {
        (offer, format!("it has the smallest expected error within the budget of {}", duration(budget)))
    } else {
        let offer = offers.iter().min_by(cheapest)?;
        (offer, format!("no tier fits; it is the cheapest, but {}", against(offer, grains, budget)))
    };
    let others = offers.iter().filter(|offer| offer.tier != taken.tier);
    let rejected = others.map(|offer| rejected(offer, grains, budget)).collect();
    let mut what = format!("`substructure = {}`", taken.tier.name());
    let of_tier = with(scenario, taken.tier);
    let better = offers.iter().filter(fits).filter(|offer| offer.error < taken.error).min_by(cheapest);
    let of_cells = offers.iter().find(|offer| offer.tier == Tier::Cells).and_then(|cells| cells.parts.of_tier);
    let limit = of_cells.map(|error| *grains.tolerance - error).filter(|limit| *limit > 0.0);
    let next = better.filter(|_| taken.tier == Tier::Law).zip(limit);
    let checked = next.and_then(|next| Some((next, checked(planner, &of_tier, fits)?)));
    let (scenario, next) = match checked {
        Some(((better, limit), checked)) => {
            let (cells, tier) = (*checked.solve.grains.check_cells, better.tier);
            let tolerance = better.parts.numerical;
            what += &format!(", checked by cells of grains under {cells} sleepers of each kind");
            why += &format!(
                "; where law and cells part by more than {} of the largest settlement, the run begins again with \
                 `substructure = {}`",
                percent(limit),
                tier.name()
            );
            (checked, Some(NextTier { tier, limit, tolerance }))
        }
        None => (of_tier, None),
    };
    let decision = Decision { pass: "budget".into(), what, why, rejected };
    Some(Taken { scenario, decision, next })
}

/// The scene by a law with cells of grains that check it; `None` if the scene wants none or the budget allows none.
fn checked(planner: &Planner, by_law: &Scenario, fits: impl Fn(&&Offer) -> bool) -> Option<Scenario> {
    let mut checked = by_law.clone();
    let cells = &mut checked.solve.grains.check_cells;
    if cells.origin == Origin::Default {
        *cells = Given::derived(CHECKS);
    }
    (**cells > 0).then_some(())?;
    let offer = offer(planner, &checked, Tier::Law)?;
    fits(&&offer).then_some(checked)
}

fn with(scenario: &Scenario, tier: Tier) -> Scenario {
    let mut of_tier = scenario.clone();
    of_tier.solve.grains.tier = Given::derived(tier);
    of_tier
}

/// The plan of a tier, if it can run.
fn offer(planner: &Planner, scenario: &Scenario, tier: Tier) -> Option<Offer> {
    let of_tier = with(scenario, tier);
    let by_law = by_law::settlement(planner, &of_tier);
    let lowered = planner.lower_with(&of_tier, by_law.as_deref());
    let graph: Graph = lowered.graph.filter(|graph| graph.runs && !has_errors(&lowered.diagnostics))?;
    let (seconds, bytes) = (graph.cost.seconds_on_two_cores, graph.cost.bytes as f64);
    let error = graph.error.share().unwrap_or(f64::INFINITY);
    Some(Offer { tier, seconds, bytes, error, parts: graph.error })
}

fn rejected(offer: &Offer, grains: &Grains, budget: f64) -> Rejected {
    let why = against(offer, grains, budget);
    let error = Some(offer.error).filter(|error| error.is_finite());
    Rejected { seconds: Some(offer.seconds), error, ..Rejected::new(offer.tier.name(), why) }
}

/// The reason against a tier.
fn against(offer: &Offer, grains: &Grains, budget: f64) -> String {
    let memory = grains.memory.filter(|memory| offer.bytes > **memory);
    if offer.seconds > budget {
        format!("it misses the budget of {} by {}", duration(budget), duration(offer.seconds - budget))
    } else if let Some(memory) = memory {
        let mib = |bytes: f64| number((bytes / f64::from(1 << 20)).ceil());
        format!("it needs {} MiB, more than the limit of {} MiB", mib(offer.bytes), mib(*memory))
    } else if offer.error > *grains.tolerance {
        "its expected error is above the `tolerance`".to_owned()
    } else {
        "it costs more".to_owned()
    }
}
