//! From a node as data to a node that runs. Nodes of other programs bring their builders along.

use super::{LawGround, NodeError, Substructure};
use crate::graph::{CustomNode, Model, Node};
use std::collections::BTreeMap;

type SubstructureBuilder = Box<dyn Fn(&CustomNode) -> Result<Box<dyn Substructure>, NodeError> + Send + Sync>;

/// Builders of nodes: the nodes of this crate, and nodes that a program adds by their kind.
#[derive(Default)]
pub struct Builders {
    substructures: BTreeMap<String, SubstructureBuilder>,
}

impl Builders {
    /// Adds the builder of a kind of substructure, see [`CustomNode::kind`].
    pub fn with_substructure(
        mut self,
        kind: impl Into<String>,
        builder: impl Fn(&CustomNode) -> Result<Box<dyn Substructure>, NodeError> + Send + Sync + 'static,
    ) -> Builders {
        self.substructures.insert(kind.into(), Box::new(builder));
        self
    }

    /// The ground that a node describes.
    pub fn substructure<'a>(&self, node: &'a Node) -> Result<Box<dyn Substructure + 'a>, NodeError> {
        let none = |kind: &str| NodeError::NoBuilder { node: node.name.clone(), kind: kind.to_owned() };
        match &node.model {
            Model::Springs(springs) => Ok(Box::new(LawGround::springs(&springs.supports))),
            Model::Law(law) => Ok(Box::new(LawGround::law(law))),
            Model::Custom(custom) => {
                let builder = self.substructures.get(&custom.kind).ok_or_else(|| none(&custom.kind))?;
                builder(custom).map(|ground| ground as Box<dyn Substructure>)
            }
            Model::Grains(_) | Model::Cells(_) | Model::Check(_) => Err(none("grains")),
            Model::Soil(_) => Err(none("soil")),
            Model::Bed(_) => Err(none("bed under actuators")),
            Model::Actuators(_) => Err(none("actuators")),
            Model::Track(_) | Model::Riding(_) => Err(none("track")),
        }
    }
}
