//! A ground of another program: it settles by the same amount under every train, takes the whole history of every
//! sleeper's force, may soften from block to block, and may fail once.

use super::scene::planned;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use trackbed::execute::Executor;
use trackbed::graph::quantity::{SETTLEMENT, SLEEPER_FORCES, SUPPORT_DAMPING, SUPPORT_STIFFNESS};
use trackbed::graph::{CustomNode, Graph, Model, Node, Ports, Responses, SupportNode};
use trackbed::nodes::{Builders, Forces, Load, Mark, NodeError, Substructure};

/// The parameters of the node.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sinking {
    pub supports: Vec<SupportNode>,
    /// What every sleeper settles under every train, m.
    pub each: f64,
    /// Share of their stiffness that supports keep after a block.
    pub keeps: f64,
    /// Whether the track is told of it.
    pub tells: bool,
}

pub const KIND: &str = "sinking";
/// m.
pub const EACH: f64 = 1e-4;

impl Sinking {
    /// On the supports of a plan.
    pub fn under(graph: &Graph) -> Sinking {
        Sinking { supports: graph.supports.clone(), each: EACH, keeps: 1.0, tells: true }
    }

    pub fn node(&self, name: &str) -> Node {
        let ports = Ports { gives: vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT], takes: vec![SLEEPER_FORCES] };
        let details = vec![format!("{} m a train", self.each)];
        let parameters = serde_json::to_value(self).unwrap();
        Node::new(name, Model::Custom(CustomNode { kind: KIND.into(), ports, details, parameters }))
    }

    /// A plan with this ground in the place of its own.
    pub fn in_the_place_of_the_law(&self, plan: &Graph) -> Graph {
        let mut graph = plan.clone();
        let node = graph.nodes.iter_mut().find(|node| matches!(node.model, Model::Law(_))).unwrap();
        *node = self.node(&node.name.clone());
        let name = node.name.clone();
        for edge in graph.edges.iter_mut().filter(|edge| edge.to == name) {
            edge.quantity = SLEEPER_FORCES.name.to_string();
        }
        graph
    }
}

/// The plan of the scene on this ground, as `change` wants it.
pub fn plan(change: impl FnOnce(&mut Sinking)) -> Graph {
    let (_, graph) = planned();
    let mut sinking = Sinking::under(&graph);
    change(&mut sinking);
    sinking.in_the_place_of_the_law(&graph)
}

/// Largest of the history of every seat, and largest peak under a wheel, N; the history has so many values.
pub struct Heard {
    pub history: Vec<f64>,
    pub peak: Vec<f64>,
    pub values: Vec<usize>,
}

/// What the grounds of a program have seen, and what they are to do.
#[derive(Default)]
pub struct Witness {
    /// Trains after which one block fails; 0 for none.
    pub fails_after: AtomicU64,
    pub heard: Mutex<Vec<Heard>>,
    /// Trains that a ground remembered after it was rolled back.
    pub rolled_back_to: Mutex<Vec<u64>>,
}

/// An executor that knows this ground.
pub fn executor(witness: &Arc<Witness>) -> Executor {
    let witness = witness.clone();
    let build = move |node: &CustomNode| -> Result<Box<dyn Substructure>, NodeError> {
        let sinking: Sinking = serde_json::from_value(node.parameters.clone()).map_err(|error| other(&error))?;
        let seats = sinking.supports.iter().map(|support| support.spring).collect();
        let state = State { trains: 0, responses: Responses { revision: 0, seats } };
        Ok(Box::new(Ground { sinking, state, witness: witness.clone() }))
    };
    Executor::default().with_builders(Builders::default().with_substructure(KIND, build))
}

fn other(why: &dyn std::fmt::Display) -> NodeError {
    NodeError::Other { node: KIND.into(), why: why.to_string() }
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    trains: u64,
    responses: Responses,
}

struct Ground {
    sinking: Sinking,
    state: State,
    witness: Arc<Witness>,
}

impl Ground {
    fn settled(&self, trains: u64) -> Vec<f64> {
        let of = |support: &SupportNode| {
            let added = if support.spring.is_some() { self.sinking.each * trains as f64 } else { 0.0 };
            support.settlement + added
        };
        self.sinking.supports.iter().map(of).collect()
    }

    fn hear(&self, load: &Load<'_>) {
        let forces = load.passage.forces.as_ref().expect("the ground takes whole histories");
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        self.witness.heard.lock().unwrap().push(Heard {
            history: forces.seats.iter().map(|history| largest(&mut history.iter().copied())).collect(),
            peak: load.passage.peaks.iter().map(|peaks| largest(&mut peaks.iter().map(|peak| peak.force))).collect(),
            values: forces.seats.iter().map(Vec::len).collect(),
        });
    }
}

fn trains(loads: &[Load<'_>]) -> u64 {
    loads.iter().map(|load| load.trains).sum()
}

impl Substructure for Ground {
    fn responses(&self) -> &Responses {
        &self.state.responses
    }

    fn settlement(&self) -> Vec<f64> {
        self.settled(self.state.trains)
    }

    fn forces(&self) -> Forces {
        Forces::Histories
    }

    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError> {
        Ok(self.settled(self.state.trains + trains(loads)))
    }

    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        loads.iter().for_each(|load| self.hear(load));
        let before = self.state.trains;
        self.state.trains += trains(loads);
        if before > 0
            && self.witness.fails_after.compare_exchange(before, 0, Ordering::SeqCst, Ordering::SeqCst).is_ok()
        {
            return Err(other(&"the ground gave way"));
        }
        if self.sinking.keeps != 1.0 {
            self.state.responses.seats.iter_mut().flatten().for_each(|spring| spring.stiffness *= self.sinking.keeps);
            self.state.responses.revision += u64::from(self.sinking.tells);
        }
        Ok(())
    }

    fn mark(&self) -> Mark {
        Mark(Box::new(self.state.clone()))
    }

    fn roll_back(&mut self, mark: Mark) {
        self.state = *mark.0.downcast::<State>().expect("a mark of its own");
        self.witness.rolled_back_to.lock().unwrap().push(self.state.trains);
    }

    fn tamp(&mut self, _: &[usize], _: f64) -> Result<(), NodeError> {
        Err(other(&"nobody tamps it"))
    }

    fn save(&self) -> Result<serde_json::Value, NodeError> {
        serde_json::to_value(&self.state).map_err(|error| other(&error))
    }

    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        self.state = serde_json::from_value(state.clone()).map_err(|error| other(&error))?;
        Ok(())
    }
}
