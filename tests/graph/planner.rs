//! Tiers and passes of another program: a ground that it brings along is proposed beside those of this crate, and a
//! pass of its own changes the plan and says why.

use super::scene::{SCENE, Told};
use super::sinking::{EACH, Sinking, Witness, executor};
use std::sync::Arc;
use trackbed::check::{NoModules, Override};
use trackbed::compile::{Compiled, compile_with};
use trackbed::diag::Code;
use trackbed::graph::{Cost, Edge, ExpectedError, Graph, Model, Schedule};
use trackbed::lower::{self, Draft, Pass, Planner, Proposal, Tier};

/// Proposes the ground of the test wherever trains run; for so many seconds.
struct SinkingTier(f64);

impl Tier for SinkingTier {
    fn name(&self) -> &'static str {
        "sinking"
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let blocks = draft.blocks.clone().ok_or("no train runs")?;
        let law = lower::lower(draft.scenario).graph.ok_or("the scene has no plan on a law")?;
        let Graph { nodes, edges, cost, .. } = Sinking::under(&law).in_the_place_of_the_law(&law);
        Ok(Proposal {
            nodes,
            edges,
            schedule: Schedule::Blocks(Box::new(blocks)),
            cost: Cost { seconds: self.0, seconds_on_two_cores: self.0, ..cost },
            what: "the same settlement everywhere".into(),
            why: "a test asks for it".into(),
            error: ExpectedError { of_tier: Some(0.5), evidence: "a guess".into(), ..ExpectedError::default() },
            runs: true,
            refusals: Vec::new(),
        })
    }
}

/// Has the rail meshed coarsely.
struct Coarse;

impl Pass for Coarse {
    fn name(&self) -> &'static str {
        "coarse"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        for node in &mut draft.nodes {
            if let Model::Track(track) = &mut node.model {
                track.elements_per_bay = 1;
            }
        }
        draft.decide(self.name(), "1 element a bay", "a first look is enough");
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(as_it_is)
    }
}

fn as_it_is(_: &mut Draft<'_>) {}

/// Takes what the ground needs away.
struct Forgets;

impl Pass for Forgets {
    fn name(&self) -> &'static str {
        "forgets"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        draft.edges.retain(|edge: &Edge| edge.to != "substructure");
    }
}

fn compiled(planner: &Planner, set: &[&str]) -> Compiled {
    let set: Vec<Override> = set.iter().map(|text| Override::parse(text).unwrap()).collect();
    compile_with(planner, "scene.track", SCENE, &NoModules, &set)
}

fn text(compiled: &Compiled) -> String {
    compiled.graph.as_ref().unwrap_or_else(|| panic!("{:?}", compiled.diagnostics)).listing().text()
}

#[test]
fn the_cheapest_tier_is_taken_whoever_brings_it() {
    let cheap = Planner::default().with_tier(Box::new(SinkingTier(1e-9)));
    let found = compiled(&cheap, &[]);
    let plan = text(&found);
    for line in [
        "node substructure: `sinking` of another program\n  0.0001 m a train\n",
        "edge track -> substructure: sleeper forces",
        "pass tier: the same settlement everywhere\n  because a test asks for it\n",
        "  not law: it costs more",
    ] {
        assert!(plan.contains(line), "{line}\n{plan}");
    }
    let mut told = Told::default();
    executor(&Arc::<Witness>::default()).run(found.runnable().unwrap(), &mut told, None).unwrap();
    assert!(told.blocks.last().unwrap().settlement.contains(&(6.0 * EACH)));

    let dear = text(&compiled(&Planner::default().with_tier(Box::new(SinkingTier(1e9))), &[]));
    assert!(dear.contains("  not sinking: it costs more, about ") && dear.contains(", expected error 50 %"), "{dear}");
    // a scene that asks for a tier gets that one, at any price
    let asked = text(&compiled(&cheap, &["solve.substructure=law"]));
    assert!(asked.contains("  not sinking: the scene asks for another tier"), "{asked}");
    assert!(!asked.contains("of another program"), "{asked}");
}

#[test]
fn a_pass_changes_the_plan_and_can_be_left_out() {
    let elements = |planner: &Planner| {
        let found = compiled(planner, &[]);
        (found.graph.as_ref().unwrap().track().unwrap().elements_per_bay, text(&found))
    };
    let (coarse, plan) = elements(&Planner::default().with_pass(Box::new(Coarse)));
    assert!(coarse == 1 && plan.contains("pass coarse: 1 element a bay\n  because a first look is enough\n"), "{plan}");
    let without = Planner::default().with_pass(Box::new(Coarse)).without("coarse");
    let (usual, plan) = elements(&without.ok().unwrap());
    assert!(usual == 2 && plan.contains("pass coarse: left out\n"), "{plan}");
    assert_eq!(usual, elements(&Planner::default()).0);
    let needed = Planner::default().with_pass(Box::new(Coarse)).without("tier").err().unwrap();
    assert_eq!(
        (needed.name.as_str(), needed.optional),
        ("tier", vec!["mesh", "exchange", "compare", "bays", "share", "record", "coarse"])
    );
}

#[test]
fn a_plan_that_a_pass_breaks_is_no_plan() {
    let found = compiled(&Planner::default().with_pass(Box::new(Forgets)), &[]);
    assert!(found.graph.is_none());
    let [mistake] = &found.diagnostics[..] else { panic!("{:?}", found.diagnostics) };
    assert_eq!(mistake.code, Code::E0612);
    assert!(mistake.message.starts_with("node `substructure` takes peaks of sleeper forces"), "{}", mistake.message);
}
