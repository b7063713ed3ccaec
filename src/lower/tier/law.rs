//! Tier `law`: a settlement law under each sleeper, published or fitted.

use super::cells::OF_CELLS;
use super::check::{self, Check};
use super::{Proposal, Tier, edges};
use crate::graph::{ExpectedError, LawBounds, LawNode, Model, NamedLaw, Node, OwnLaw, Schedule};
use crate::lower::outlook::Outlook;
use crate::lower::{Draft, accuracy, cost, supports, track};
use crate::scenario::{Loading, Scenario, SettlementLaw, law_argument};
use crate::schema::Reads;
use crate::solvers::settlement::{Form, Logarithm};
use crate::units::percent;

pub struct SettlementLaws;

/// Fields of supports that settle, and that move under trains.
const READS: Reads = Reads {
    fields: &[
        "solve.law",
        "trackform.law",
        "law.form",
        "law.loads",
        "law.cycles",
        "law.voids",
        "law.error",
        "law.cycle_per",
        "solve.check_cells",
        "support.damping",
        "support.damping_time",
        "usp.damping_time",
    ],
    acts_where: "where trains run over supports that settle by a law",
};

/// Largest error of a published law / largest settlement of grains, of any sleeper in eight scenes (docs/validation.md,
/// "Expected errors on grains").
const OF_LAW: f64 = 0.78;

impl Tier for SettlementLaws {
    fn name(&self) -> &'static str {
        "law"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&track::READS, &track::SUPPORTS, &READS]
    }

    fn also_reads(&self, scenario: &Scenario) -> &'static [&'static Reads] {
        if *scenario.solve.grains.check_cells > 0 { &check::READS } else { &[] }
    }

    fn propose(&self, draft: &Draft<'_>) -> Result<Proposal, String> {
        let scenario = draft.scenario;
        if !matches!(scenario.loading, Some(Loading::Traffic(_))) {
            return Err("no train runs, and a law computes settlement only under trains".into());
        }
        if !draft.is_sprung() {
            return Err("rails, pads or supports of known stiffness are missing".into());
        }
        let Some(blocks) = &draft.blocks else { return Err("the traffic cannot be cut into blocks".into()) };
        let node = track::track(draft);
        let law = LawNode {
            supports: draft.supports.clone(),
            law: named(&scenario.solve.law),
            followers: scenario.solve.other_laws.iter().map(named).collect(),
            own: own(scenario),
        };
        let outlook = Outlook::new(&node, &law.supports, &law.law.law, blocks);
        let cost = cost::of_blocks(&node, blocks, &outlook);
        let Check { node: cells, cost: of_cells, refusals } = check::check(draft, outlook.blocks);
        let laws = [Node::new("track", Model::Track(Box::new(node))), Node::new("substructure", Model::Law(law))];
        let checked = cells.as_ref().map_or(String::new(), check::told);
        let what = format!("a settlement law under each sleeper{checked}");
        let nodes: Vec<Node> = laws.into_iter().chain(cells).collect();
        let stated = "the scene gives the stiffness of its supports";
        let why = if stands_on_layers(scenario) { "the layers give the stiffness of the supports" } else { stated };
        Ok(Proposal {
            edges: edges(&nodes),
            nodes,
            schedule: Schedule::Blocks(Box::new(blocks.clone())),
            cost: of_cells.map_or(cost, |cells| cost.and(cells)),
            what,
            why: why.into(),
            error: ExpectedError { numerical: accuracy::expected(blocks, &outlook), ..of_law(scenario) },
            runs: refusals.is_empty(),
            refusals,
        })
    }
}

/// Error of the law, against grains where the scene has a layer of them.
fn of_law(scenario: &Scenario) -> ExpectedError {
    let laws = scenario.driving_laws();
    let stated = laws.iter().map(|law| Some((law.error?, law.name.as_str()))).collect::<Option<Vec<_>>>();
    if let Some((error, name)) = stated.and_then(|all| all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))) {
        let evidence = format!(
            "law `{name}` states an error of {} against the cells to which it was fitted, and cells differ by up to {} \
             from a whole bed",
            percent(error),
            percent(OF_CELLS)
        );
        return ExpectedError { numerical: None, of_tier: Some(error + OF_CELLS), evidence };
    }
    let has_grains =
        scenario.track.sections.iter().any(|section| section.layers.iter().any(|l| l.granular().is_some()));
    ExpectedError {
        numerical: None,
        of_tier: has_grains.then_some(OF_LAW),
        evidence:
            "published laws differ from each other by a factor of ten and more, and the law of the shortened scene \
                   is 45 to 78 % off in eight scenes of grains"
                .into(),
    }
}

/// The laws of single sleepers, each with its seats.
fn own(scenario: &Scenario) -> Vec<OwnLaw> {
    let mut own: Vec<OwnLaw> = Vec::new();
    for (seat, law) in scenario.track.seats.iter().enumerate().filter_map(|(seat, it)| Some((seat, it.own_law()?))) {
        let law = named(law);
        match own.iter_mut().find(|known| known.law == law) {
            Some(known) => known.seats.push(seat),
            None => own.push(OwnLaw { law, seats: vec![seat] }),
        }
    }
    own
}

/// Whether a sleeper stands on layers without a stated support.
fn stands_on_layers(scenario: &Scenario) -> bool {
    scenario.track.seats.iter().any(supports::stands_on_layers)
}

fn named(law: &SettlementLaw) -> NamedLaw {
    let most = |range: Option<(f64, f64)>| range.map_or(f64::INFINITY, |(_, most)| most);
    let bounds = law.error.map(|_| LawBounds { force: most(law.loads), void: most(law.voids) });
    NamedLaw { name: law.name.clone(), law: law.law, details: describe(law), bounds }
}

/// The form of a law with its parameters in the notation of the language, for half a sleeper.
fn describe(named: &SettlementLaw) -> String {
    let mut law = named.law;
    let name = law.form.name();
    let parameters = law.form.parameters().into_iter();
    let parameters: Vec<String> =
        parameters.map(|(argument, value)| format!("{argument} {}", law_argument(name, argument, *value))).collect();
    let logarithm = match law.form {
        Form::Hettler(law) => match law.logarithm {
            Logarithm::Natural => ", natural logarithm",
            Logarithm::Decimal => ", decimal logarithm",
        },
        _ => "",
    };
    format!("{name}: {}{logarithm}; one cycle per {}", parameters.join(", "), law.cycle_per.name())
}
