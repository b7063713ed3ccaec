//! A node as data: its name, the parameters of its solver, and its ports, which follow from the parameters.

use super::quantity::*;
use super::{ActuatorsNode, BedNode, CellsNode, GrainsNode, LawNode, Ports, SoilNode, SpringsNode, TrackNode};
use serde::{Deserialize, Serialize};

/// A part of the simulation that owns a state and advances it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Node {
    pub name: String,
    pub model: Model,
}

/// The model of a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// Rail, pads, sleepers and slab with the vehicles on them.
    Track(Box<TrackNode>),
    /// The same track, computed step by step together with the grains under it.
    Riding(Box<TrackNode>),
    /// Supports that do not settle.
    Springs(SpringsNode),
    /// Supports that settle by a law.
    Law(LawNode),
    /// A bed of grains with sleepers or a plate on it, under actuators.
    Bed(Box<BedNode>),
    /// The loads of a rig.
    Actuators(ActuatorsNode),
    /// The grains under a track.
    Grains(GrainsNode),
    /// A cell of grains for each distinct sleeper.
    Cells(CellsNode),
    /// Cells of grains under some sleepers, whose settlement is compared with the settlement of the track.
    Check(CellsNode),
    /// The ground below the grains.
    Soil(SoilNode),
    /// A node of another program, which also builds it.
    Custom(CustomNode),
}

/// A node that this crate does not know, as data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CustomNode {
    /// The name by which its builder is found.
    pub kind: String,
    pub ports: Ports,
    /// Description for readers, one line for each item.
    pub details: Vec<String>,
    pub parameters: serde_json::Value,
}

impl Node {
    /// A node with a name.
    pub fn new(name: impl Into<String>, model: Model) -> Node {
        Node { name: name.into(), model }
    }

    /// The quantities that the node gives and takes.
    pub fn ports(&self) -> Ports {
        let (gives, takes) = match &self.model {
            Model::Track(_) => {
                let forces = vec![WHEEL_FORCES, SLEEPER_FORCE_PEAKS, SLEEPER_FORCES];
                (forces, vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT])
            }
            Model::Riding(_) => (vec![SLEEPER_VELOCITY], vec![GRAIN_PUSH]),
            Model::Springs(_) => (vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT], vec![]),
            Model::Law(_) => (vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT], vec![SLEEPER_FORCE_PEAKS]),
            Model::Bed(bed) if bed.is_driven() => (vec![SLEEPER_DISPLACEMENT], vec![ACTUATOR_VELOCITY]),
            Model::Bed(_) => (vec![SLEEPER_DISPLACEMENT], vec![ACTUATOR_FORCE]),
            Model::Actuators(actuators) if actuators.drive() => (vec![ACTUATOR_VELOCITY], vec![]),
            Model::Actuators(_) => (vec![ACTUATOR_FORCE], vec![]),
            Model::Grains(grains) => {
                let (mut gives, mut takes) = match grains.ridden {
                    true => (vec![GRAIN_PUSH], vec![SLEEPER_VELOCITY]),
                    false => (vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT], vec![WHEEL_FORCES]),
                };
                if grains.on_soil {
                    gives.push(GRAIN_FORCE);
                    takes.push(SOIL_VELOCITY);
                }
                (gives, takes)
            }
            Model::Cells(_) => (vec![SUPPORT_STIFFNESS, SUPPORT_DAMPING, SETTLEMENT], vec![SLEEPER_FORCES]),
            Model::Check(_) => (vec![], vec![SLEEPER_FORCES]),
            Model::Soil(_) => (vec![SOIL_VELOCITY], vec![GRAIN_FORCE]),
            Model::Custom(node) => return node.ports.clone(),
        };
        Ports { gives, takes }
    }
}
