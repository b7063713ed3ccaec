//! The graph as a person reads it: text, JSON and DOT.

use super::{Blocks, Decision, Estimate, Graph, NamedLaw, Schedule, SubstructureNode};
use crate::scenario::{Beam, Integrator, Update, law_argument};
use crate::solvers::settlement::{Form, Logarithm};
use crate::units::number;
use serde::Serialize;

/// A graph in names and sentences.
#[derive(Debug, Clone, Serialize)]
pub struct Listing {
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub schedule: Vec<String>,
    pub passes: Vec<Decision>,
    pub estimate: Option<Estimate>,
}

#[derive(Debug, Clone, Serialize)]
pub struct Node {
    pub name: &'static str,
    pub model: String,
    pub details: Vec<String>,
}

/// One quantity from node to node, once a block.
#[derive(Debug, Clone, Serialize)]
pub struct Edge {
    pub from: &'static str,
    pub to: &'static str,
    pub quantity: &'static str,
    pub symbol: &'static str,
    pub unit: &'static str,
}

const EDGES: [Edge; 3] = [
    Edge {
        from: "substructure",
        to: "track",
        quantity: "support stiffness and damping",
        symbol: "k, c",
        unit: "N/m, N s/m",
    },
    Edge { from: "track", to: "substructure", quantity: "sleeper-ballast forces", symbol: "R(t)", unit: "N" },
    Edge { from: "substructure", to: "track", quantity: "settlement", symbol: "s", unit: "m" },
];

impl Graph {
    pub fn listing(&self) -> Listing {
        Listing {
            nodes: vec![self.track_node(), self.substructure_node()],
            edges: match self.substructure {
                SubstructureNode::Law { .. } => EDGES.to_vec(),
                SubstructureNode::Fixed => EDGES[..1].to_vec(),
            },
            schedule: self.schedule_lines(),
            passes: self.decisions.clone(),
            estimate: Some(self.estimate),
        }
    }

    fn track_node(&self) -> Node {
        let track = &self.track.track;
        let mut details = vec![
            format!(
                "rail: {}, {} elements a bay, {} m .. {} m",
                match self.track.beam {
                    Beam::Euler => "Euler-Bernoulli",
                    Beam::Timoshenko => "Timoshenko",
                },
                self.track.elements_per_bay,
                number(track.start()),
                number(track.end())
            ),
            format!("seats: {}", track.seats.len()),
        ];
        details.extend(track.sections.iter().map(|s| {
            let seats = track.seats.iter().filter(|seat| track.sections[seat.section].start == s.start).count();
            let foot = if s.slab.is_some() { "on a slab" } else { "on sleepers" };
            format!("section {}: {} m, {seats} seats {foot}", s.name, number(s.end - s.start))
        }));
        if let Schedule::Blocks(blocks) = &self.schedule {
            for ((train, plan), share) in blocks.kinds().zip(&blocks.sequence.shares) {
                let count =
                    if blocks.others.is_empty() { String::new() } else { format!(", {} of them", share.trains) };
                details.push(format!(
                    "train {}: {} vehicles, {} axles, {} km/h{count}",
                    train.name,
                    train.vehicles.len(),
                    train.axles(),
                    number(*train.speed * 3.6)
                ));
                details.push(format!(
                    "passage: wheels from {} m to {} m, {}, step {} ms{}",
                    number(plan.left),
                    number(plan.right),
                    integrator(plan.integrator),
                    number(plan.time_step * 1e3),
                    if plan.adaptive.is_some() { " or shorter" } else { "" }
                ));
            }
        }
        Node { name: "track", model: "2D finite element track with multibody vehicles, one Newton".into(), details }
    }

    fn substructure_node(&self) -> Node {
        match &self.substructure {
            SubstructureNode::Fixed => Node {
                name: "substructure",
                model: "supports as given, without settlement".into(),
                details: Vec::new(),
            },
            SubstructureNode::Law { law, followers } => Node {
                name: "substructure",
                model: format!("tier law: {} under each sleeper", law.name),
                details: std::iter::once(describe(law))
                    .chain(followers.iter().map(|f| format!("beside it {}, {}", f.name, describe(f))))
                    .collect(),
            },
        }
    }

    fn schedule_lines(&self) -> Vec<String> {
        match &self.schedule {
            Schedule::Static { .. } => vec!["one static equilibrium under the test loads".to_string()],
            Schedule::Blocks(b) => {
                vec![
                    block_line(b, &self.estimate),
                    match b.update {
                        Update::Adaptive { .. } => {
                            "each block: static state -> passage -> settlement of half of it -> passage -> settlement of the block"
                        }
                        _ => "each block: static state -> passage -> settlement of the block",
                    }
                    .into(),
                    format!(
                        "recorded after {} axles",
                        b.recorded.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")
                    ),
                ]
            }
        }
    }
}

fn integrator(integrator: Integrator) -> String {
    match integrator {
        Integrator::GeneralisedAlpha { rho } => format!("generalised-alpha (rho {})", number(rho)),
        Integrator::Hht { alpha } => format!("Hilber-Hughes-Taylor (alpha {})", number(alpha)),
        Integrator::Newmark => "Newmark, average acceleration".into(),
    }
}

/// The form of a law with its parameters, SI, of one half sleeper.
fn describe(named: &NamedLaw) -> String {
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

/// `500 axles in 25 blocks, 20 axles each`
fn block_line(blocks: &Blocks, estimate: &Estimate) -> String {
    let total = blocks.total;
    match blocks.update {
        Update::Adaptive { tolerance, cap } => {
            let cap = cap.map_or(String::new(), |cap| format!(" and {} mm of settlement", number(cap * 1e3)));
            format!("{total} axles in blocks that err by at most {} mm{cap}", number(tolerance * 1e3))
        }
        Update::Fixed { .. } | Update::Geometric { .. } => {
            let [shortest, longest] = estimate.block_axles;
            let range = match shortest == longest {
                true => format!("{longest} axles each"),
                false => format!("{shortest} to {longest} axles"),
            };
            format!("{total} axles in {} blocks, {range}", estimate.blocks)
        }
    }
}

impl Listing {
    pub fn text(&self) -> String {
        let mut out = String::new();
        for node in &self.nodes {
            out.push_str(&format!("node {}: {}\n", node.name, node.model));
            node.details.iter().for_each(|d| out.push_str(&format!("  {d}\n")));
        }
        out.push('\n');
        for e in &self.edges {
            out.push_str(&format!("edge {} -> {}: {}, {} [{}]\n", e.from, e.to, e.quantity, e.symbol, e.unit));
        }
        out.push('\n');
        self.schedule.iter().for_each(|line| out.push_str(&format!("schedule: {line}\n")));
        out.push('\n');
        for pass in &self.passes {
            out.push_str(&format!("pass {}: {}\n  because {}\n", pass.pass, pass.what, pass.why));
        }
        if let Some(e) = &self.estimate {
            out.push_str(&format!(
                "\nestimate: {} unknowns, {} passages, {} steps, about {} s on one core, {} MB\n",
                e.unknowns,
                e.passages,
                e.steps,
                number((e.seconds * 10.0).round() / 10.0),
                e.bytes.div_ceil(1_000_000)
            ));
        }
        out
    }

    /// For Graphviz.
    pub fn dot(&self) -> String {
        let mut out = String::from("digraph plan {\n  rankdir=LR\n  node [shape=box]\n");
        for node in &self.nodes {
            out.push_str(&format!("  {} [label=\"{}\\n{}\"]\n", node.name, node.name, node.model.replace('"', "'")));
        }
        for e in &self.edges {
            out.push_str(&format!("  {} -> {} [label=\"{} [{}]\"]\n", e.from, e.to, e.symbol, e.unit));
        }
        out.push_str("}\n");
        out
    }
}
