//! Ports of nodes, the edges between them, and the check that they fit together.

use super::{Graph, Quantity};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The quantities that a node gives to other nodes, and the quantities that it needs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Ports {
    pub gives: Vec<Quantity>,
    pub takes: Vec<Quantity>,
}

/// The connection of a quantity from the node that gives it to a node that takes it, both by name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edge {
    pub from: String,
    pub to: String,
    /// Name of the quantity.
    pub quantity: String,
}

impl Edge {
    /// An edge by the names of its ends and of its quantity.
    pub fn new(from: &str, to: &str, quantity: &Quantity) -> Edge {
        Edge { from: from.into(), to: to.into(), quantity: quantity.name.to_string() }
    }
}

/// A reason why the nodes and edges of a plan do not fit together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Fault {
    /// Two nodes have the same name.
    TwoNodes { name: String },
    /// An edge begins or ends at a node that does not exist.
    NoNode { edge: Edge, name: String },
    /// The node at the start of an edge does not give the quantity.
    NotGiven { edge: Edge },
    /// The node at the end of an edge does not take the quantity.
    NotTaken { edge: Edge },
    /// No edge brings a quantity that a node takes.
    Missing { node: String, quantity: Quantity },
    /// Several edges bring the same quantity to a node.
    Doubled { node: String, quantity: Quantity, from: Vec<String> },
    /// Both ends of an edge use one name for different quantities.
    Contradictory { edge: Edge, given: Quantity, taken: Quantity },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::TwoNodes { name } => write!(f, "two nodes are called `{name}`"),
            Fault::NoNode { edge, name } => {
                write!(f, "the edge of `{}` names a node `{name}`, which does not exist", edge.quantity)
            }
            Fault::NotGiven { edge } => write!(f, "node `{}` gives no `{}`", edge.from, edge.quantity),
            Fault::NotTaken { edge } => write!(f, "node `{}` takes no `{}`", edge.to, edge.quantity),
            Fault::Missing { node, quantity } => write!(f, "node `{node}` takes {quantity}, and no edge brings it"),
            Fault::Doubled { node, quantity, from } => {
                write!(f, "node `{node}` takes `{}` from one node, but {} give it", quantity.name, from.join(" and "))
            }
            Fault::Contradictory { edge, given, taken } => {
                write!(f, "node `{}` gives {given}, node `{}` takes {taken}", edge.from, edge.to)
            }
        }
    }
}

/// All faults of a graph, in the order of its nodes and edges; empty if the graph may run.
pub fn faults(graph: &Graph) -> Vec<Fault> {
    let mut found = Vec::new();
    for (index, node) in graph.nodes.iter().enumerate() {
        if graph.nodes[..index].iter().any(|other| other.name == node.name) {
            found.push(Fault::TwoNodes { name: node.name.clone() });
        }
    }
    found.extend(graph.edges.iter().filter_map(|edge| of_edge(graph, edge)));
    for node in &graph.nodes {
        for quantity in node.ports().takes {
            let brings = |edge: &&Edge| edge.to == node.name && edge.quantity == quantity.name;
            let from: Vec<String> = graph.edges.iter().filter(brings).map(|edge| edge.from.clone()).collect();
            match from.len() {
                0 => found.push(Fault::Missing { node: node.name.clone(), quantity }),
                1 => {}
                _ => found.push(Fault::Doubled { node: node.name.clone(), quantity, from }),
            }
        }
    }
    found
}

fn of_edge(graph: &Graph, edge: &Edge) -> Option<Fault> {
    let no_node = |name: &str| Fault::NoNode { edge: edge.clone(), name: name.to_owned() };
    let Some(from) = graph.node(&edge.from) else { return Some(no_node(&edge.from)) };
    let Some(to) = graph.node(&edge.to) else { return Some(no_node(&edge.to)) };
    let named = |quantities: Vec<Quantity>| quantities.into_iter().find(|quantity| quantity.name == edge.quantity);
    let Some(given) = named(from.ports().gives) else { return Some(Fault::NotGiven { edge: edge.clone() }) };
    let Some(taken) = named(to.ports().takes) else { return Some(Fault::NotTaken { edge: edge.clone() }) };
    let fits = given.unit == taken.unit && given.basis == taken.basis && given.rate == taken.rate;
    (!fits).then(|| Fault::Contradictory { edge: edge.clone(), given, taken })
}
