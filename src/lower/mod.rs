//! From the scenario to the solver graph: passes that choose models, places, steps and blocks, and say why.

mod accuracy;
mod answers;
mod bays;
mod bed;
mod blocks;
mod clumps;
mod cost;
mod crib;
mod dry_run;
mod foundation;
mod glue;
pub(crate) mod memo;
mod origins;
mod outlook;
mod pass;
mod passage;
mod records;
mod supports;
mod tier;
mod track;

pub use answers::{PLACE_TOLERANCE, absent, not_kept};
pub use bed::{BedUse, beds};
pub use origins::{Origins, Parameter};
pub use pass::{Draft, Pass};
pub use supports::{supports, with_stated_supports};
pub use tier::{Proposal, Tier};

use crate::diag::{Code, Diagnostic, Severity};
use crate::graph::{Graph, faults};
use crate::scenario::Scenario;
use crate::schema::{Reader, Reads};
use tier::ChooseTier;

/// Result of planning a scene.
pub struct Lowered {
    /// The plan; `None` if nothing acts on the track, if the scene has an error, or if no tier has a plan.
    pub graph: Option<Graph>,
    /// Places in the text from which the parameters of the plan come.
    pub origins: Origins,
    /// Fields that passes and tiers read, and whether each pass or tier acted.
    pub readers: Vec<Reader>,
    pub diagnostics: Vec<Diagnostic>,
}

/// The passes and tiers that plan scenes.
pub struct Planner {
    tiers: Vec<Box<dyn Tier>>,
    /// Passes of another program, run before the plan is checked.
    further: Vec<Box<dyn Pass>>,
    /// Names of passes that are left out.
    without: Vec<String>,
}

/// The name of a pass that does not exist or cannot be left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoSuchPass {
    pub name: String,
    /// Names of the passes that can be left out.
    pub optional: Vec<&'static str>,
}

impl Default for Planner {
    fn default() -> Planner {
        Planner {
            tiers: vec![
                Box::new(tier::Equilibrium),
                Box::new(tier::TestRig),
                Box::new(tier::SettlementLaws),
                Box::new(tier::Cells),
                Box::new(tier::Zone),
                Box::new(tier::Full),
            ],
            further: Vec::new(),
            without: Vec::new(),
        }
    }
}

impl Planner {
    /// Adds a tier of another program, asked after the tiers of this crate.
    pub fn with_tier(mut self, tier: Box<dyn Tier>) -> Planner {
        self.tiers.push(tier);
        self
    }

    /// Adds a pass of another program, run after the passes of this crate.
    pub fn with_pass(mut self, pass: Box<dyn Pass>) -> Planner {
        self.further.push(pass);
        self
    }

    /// Leaves out the pass with this name.
    pub fn without(mut self, name: &str) -> Result<Planner, NoSuchPass> {
        let optional: Vec<&'static str> =
            self.passes().iter().filter(|pass| pass.without().is_some()).map(|pass| pass.name()).collect();
        if !optional.contains(&name) {
            return Err(NoSuchPass { name: name.to_owned(), optional });
        }
        self.without.push(name.to_owned());
        Ok(self)
    }

    /// The passes in their order.
    fn passes(&self) -> Vec<Box<dyn Pass + '_>> {
        let mut passes: Vec<Box<dyn Pass + '_>> = vec![
            // steps are shorter than the time in which a wheel crosses an element
            Box::new(accuracy::Mesh),
            // trains before tiers: blocks are counted in whole trains, and all tiers use the same passages
            Box::new(passage::Passages),
            Box::new(blocks::Cut),
            // all tiers use the same supports
            Box::new(supports::Supports),
            // the error of a block is a share of the settlement, which depends on the supports
            Box::new(accuracy::Exchange),
            Box::new(accuracy::Compare),
            // grains lie in the bays that differ from the far field
            Box::new(bays::Bays),
            // a tier makes the nodes and estimates their cost
            Box::new(ChooseTier(&self.tiers)),
            // the following passes change a plan that has a cost
            Box::new(blocks::Shared),
            Box::new(records::Records),
        ];
        passes.extend(self.further.iter().map(|pass| Box::new(&**pass) as Box<dyn Pass + '_>));
        passes
    }

    /// Lowers a scene.
    pub fn lower(&self, scenario: &Scenario) -> Lowered {
        self.lower_with(scenario, None)
    }

    /// Lowers a scene. `by_law` is the settlement of every seat by the law of the scene \[m\], from which the tiers
    /// with grains find the sleepers that need grains.
    pub fn lower_with(&self, scenario: &Scenario, by_law: Option<&[f64]>) -> Lowered {
        let origins = Origins::new(scenario);
        let mut draft = Draft::new(scenario, &origins, by_law);
        if scenario.loading.is_none() {
            draft.diagnostics.push(nothing_acts(scenario));
        }
        for pass in self.passes() {
            match pass.without().filter(|_| self.without.iter().any(|name| name == pass.name())) {
                Some(instead) => {
                    instead(&mut draft);
                    draft.decide(pass.name(), "left out", "`--without` says so");
                }
                None => pass.run(&mut draft),
            }
        }
        let readers = self.readers(scenario, draft.tier);
        let (graph, mut diagnostics) = finished(draft);
        if let Some(graph) = graph.as_ref().filter(|graph| graph.runs) {
            diagnostics.extend(answers::refusals(scenario, graph));
        }
        Lowered { graph, origins, readers, diagnostics }
    }

    /// Fields that the passes and tiers read; `tier` is the name of the tier that was taken.
    pub fn readers(&self, scenario: &Scenario, tier: Option<&str>) -> Vec<Reader> {
        let of_passes = self.passes().into_iter().flat_map(|pass| {
            let left_out = pass.without().is_some() && self.without.iter().any(|name| name == pass.name());
            let acted = pass.acts(scenario) && !left_out;
            pass.reads().iter().map(move |reads| Reader { reads, acted })
        });
        let of_tiers = self.tiers.iter().flat_map(|other| {
            let acted = tier == Some(other.name());
            let reads = other.reads().iter().chain(other.also_reads(scenario));
            reads.map(move |reads| Reader { reads, acted })
        });
        of_passes.chain(of_tiers).collect()
    }
}

/// A reference to a pass is also a pass.
impl Pass for &dyn Pass {
    fn name(&self) -> &'static str {
        (**self).name()
    }

    fn reads(&self) -> &'static [&'static Reads] {
        (**self).reads()
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        (**self).acts(scenario)
    }

    fn run(&self, draft: &mut Draft<'_>) {
        (**self).run(draft);
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        (**self).without()
    }
}

/// Lowers a scene with the passes and tiers of this crate.
pub fn lower(scenario: &Scenario) -> Lowered {
    Planner::default().lower(scenario)
}

/// The plan of a draft, if there is no error and its nodes fit together.
fn finished(draft: Draft<'_>) -> (Option<Graph>, Vec<Diagnostic>) {
    let wrong = draft.is_wrong();
    // a track without rails and without a load needs these first
    let idle = draft.scenario.loading.is_none() && !draft.scenario.track.has_rails();
    let Draft {
        supports,
        nodes,
        edges,
        schedule,
        records,
        cost,
        error,
        decisions,
        runs,
        mut diagnostics,
        refusals,
        ..
    } = draft;
    diagnostics.extend(refusals);
    diagnostics.retain(|diagnostic| !idle || diagnostic.code != Code::E0604);
    let (Some(schedule), Some(cost)) = (schedule.filter(|_| !wrong), cost) else { return (None, diagnostics) };
    let graph = Graph { nodes, edges, schedule, records, supports, decisions, cost, error, runs };
    let faults = faults(&graph);
    diagnostics.extend(faults.iter().map(|fault| Diagnostic::new(Code::E0612, fault.to_string())));
    (faults.is_empty().then_some(graph), diagnostics)
}

fn nothing_acts(scenario: &Scenario) -> Diagnostic {
    let help = match scenario.track.has_rails() {
        true => "add `traffic { trains = ..., total = 500 axles }` to run the scene",
        false => {
            "add a `load` with `on = sleepers` or `on = bed` to run the scene as a rig, or give it rails and `traffic`"
        }
    };
    Diagnostic::new(Code::E0601, "nothing acts on the track: there is neither `traffic` nor `load`")
        .severity(Severity::Warning)
        .help(help)
}
