//! The soil: its elements, its nodes and their supports.

use super::chunk::Chunk;
use super::energy::{Energy, Ledger};
use super::error::{SoilError, number, within};
use super::mesh::Mesh;
use super::nodes::Nodes;
use super::shape::{Formulation, Shape};
use super::shapes::shapes;
use super::stiffness::fastest;

/// Settings of the computation of a soil.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Settings {
    pub formulation: Formulation,
    /// \[m/s²\]
    pub gravity: [f64; 3],
    pub damping: Damping,
}

/// Losses in addition to plastic flow and quiet boundaries.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Damping {
    /// Time β \[s\]: damping forces are β times stiffness times velocity; a wave of frequency f has the damping ratio π
    /// f β. It shortens the stable step.
    pub stiffness: f64,
    /// Cundall's local damping, from 0 to below 1: the share of the unbalanced force of a node that acts against its
    /// velocity. Use it for states of rest; it damps waves of all frequencies and slows down a falling body.
    pub local: f64,
}

/// Soil in motion: hexahedra with small strains, masses at the nodes, leapfrog in time.
///
/// Strains and rotations are small: forces act on the undeformed soil. After the first step, velocities are half a step
/// before positions.
#[derive(Debug, Clone)]
pub struct Soil {
    pub(super) mesh: Mesh,
    pub(super) settings: Settings,
    pub(super) shapes: Vec<Shape>,
    /// Shape of each element.
    pub(super) kinds: Vec<u32>,
    pub(super) chunks: Vec<Chunk>,
    pub(super) nodes: Nodes,
    /// Largest squared frequency of the elements at each node \[1/s²\].
    pub(super) rates: Vec<f64>,
    /// Largest squared frequency of the mesh, with a margin, once it has been measured \[1/s²\].
    pub(super) measured: Option<f64>,
    pub(super) ledger: Ledger,
    pub(super) clock: Clock,
}

/// The time of a soil.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Clock {
    pub steps: u64,
    pub time: f64,
    /// The last step \[s\]; 0 if velocities belong to the time of the positions.
    pub last: f64,
}

impl Soil {
    /// Unstressed soil without supports.
    ///
    /// # Errors
    /// Elements without volume, invalid settings.
    pub fn new(mesh: Mesh, settings: Settings) -> Result<Soil, SoilError> {
        settings.gravity.iter().try_for_each(|&g| number("gravity", g))?;
        let Damping { stiffness, local } = settings.damping;
        within("the stiffness damping of the soil", stiffness, stiffness >= 0.0, "a time from 0")?;
        within("the local damping of the soil", local, (0.0..1.0).contains(&local), "from 0 to below 1")?;
        let (shapes, kinds) = shapes(&mesh, settings.formulation)?;
        let chunks = Chunk::cut(&mesh, &shapes, &kinds);
        let nodes = Nodes::new(&mesh, &shapes, &kinds, &chunks);
        let fastest: Vec<f64> = shapes.iter().map(fastest).collect();
        let mut rates = vec![0.0; mesh.nodes().len()];
        for (element, &kind) in mesh.elements().iter().zip(&kinds) {
            for &node in &element.nodes {
                let rate: &mut f64 = &mut rates[node as usize];
                *rate = rate.max(fastest[kind as usize]);
            }
        }
        let (ledger, clock) = (Ledger::default(), Clock::default());
        Ok(Soil { mesh, settings, shapes, kinds, chunks, nodes, rates, measured: None, ledger, clock })
    }

    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Positions of the nodes \[m\].
    pub fn positions(&self) -> Vec<[f64; 3]> {
        let nodes = self.mesh.nodes().iter().zip(&self.nodes.displacement);
        nodes.map(|(made, u)| [0, 1, 2].map(|axis| made[axis] + u[axis])).collect()
    }

    /// Displacements of the nodes from their initial positions \[m\].
    pub fn displacements(&self) -> &[[f64; 3]] {
        &self.nodes.displacement
    }

    /// Velocities of the nodes \[m/s\]: the mean of the last step.
    pub fn velocities(&self) -> &[[f64; 3]] {
        &self.nodes.velocity
    }

    /// Masses of the nodes \[kg\].
    pub fn masses(&self) -> &[f64] {
        &self.nodes.mass
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    pub fn steps(&self) -> u64 {
        self.clock.steps
    }

    /// Adds to the force on a node \[N\] in the next step, or in the next state of rest.
    #[inline]
    pub fn add_force(&mut self, node: usize, force: [f64; 3]) {
        self.nodes.add_force(node, force);
    }

    /// Sets displacement \[m\] and velocity \[m/s\] of a node; its motion continues from there.
    pub fn set_motion(&mut self, node: usize, displacement: [f64; 3], velocity: [f64; 3]) {
        self.nodes.displacement[node] = displacement;
        self.nodes.velocity[node] = velocity;
        self.clock.last = 0.0;
    }

    /// Changes gravity \[m/s²\] from the next step on.
    ///
    /// # Errors
    /// A component that is not a finite number.
    pub fn set_gravity(&mut self, gravity: [f64; 3]) -> Result<(), SoilError> {
        gravity.iter().try_for_each(|&g| number("gravity", g))?;
        self.settings.gravity = gravity;
        Ok(())
    }

    /// Starts or stops recording energies from the next step on. Recording costs a tenth of a step.
    pub fn watch(&mut self, on: bool) {
        self.ledger = Ledger::begin(on);
    }

    /// The energy account; zeros unless energies are recorded.
    pub fn energy(&self) -> Energy {
        self.ledger.now
    }
}
