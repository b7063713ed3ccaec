//! Templates of clumps from surfaces, and grains as copies of the templates.

use super::super::clump::{Template, TemplateError};
use super::super::shape::Mesh;
use super::{Angular, AngularError, Bubbles, Random, Rule, Sample};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

/// A grain of a bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Index of its template.
    pub template: usize,
    /// Diameter of the ball of its volume, m: the scale of its template.
    pub size: f64,
}

/// The grains of a sample: every template equally often, in random order.
pub fn grains(sample: &Sample, templates: usize, seed: u64) -> Vec<Grain> {
    let mut template: Vec<usize> = (0..sample.sizes.len()).map(|k| k % templates.max(1)).collect();
    Random::new(seed, TEMPLATES).shuffle(&mut template);
    sample.sizes.iter().zip(template).map(|(size, template)| Grain { template, size: *size }).collect()
}

/// Number of the random stream for the choice of templates.
const TEMPLATES: u64 = 2;

/// The shape of grains: surfaces, and the rule for filling them with pebbles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClumpShape {
    pub surfaces: Surfaces,
    pub rule: Rule,
}

/// Closed surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Surfaces {
    /// `count` angular grains with equal indices.
    Angular { indices: Angular, count: usize },
    /// Scans, of any size.
    Meshes(Vec<Arc<Mesh>>),
}

/// A template, and the surface for which it was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    pub surface: Arc<Mesh>,
    pub bubbles: Bubbles,
    /// Clump with the volume of the ball of diameter 1.
    pub template: Template,
}

/// Why there are no templates.
#[derive(Debug, Clone, PartialEq)]
pub enum TemplatesError {
    Surface(AngularError),
    /// Pebbles that do not form a clump.
    Clump(TemplateError),
    /// Fewer pebbles fit into a surface than required: the surface is nearly a ball.
    TooFew {
        surface: usize,
        found: usize,
        fewest: usize,
    },
}

impl Default for ClumpShape {
    /// Clumps of two or three pebbles (Ahmadi et al. 2026, 2.1) in five angular grains. With these indices the rule of
    /// the paper gives two or three pebbles in four of five surfaces, and one in the fifth.
    fn default() -> Self {
        let indices = Angular { flatness: 0.7, elongation: 0.7, roundness: 0.15 };
        let rule = Rule { pebbles: [2, 3], ratio: 0.8, distance: 110.0 * PI / 180.0 };
        Self { surfaces: Surfaces::Angular { indices, count: 5 }, rule }
    }
}

impl ClumpShape {
    /// A template for each surface, with the volume of the ball of diameter 1.
    pub fn templates(&self, seed: u64) -> Result<Vec<Template>, TemplatesError> {
        Ok(self.fitted(seed)?.into_iter().map(|fitted| fitted.template).collect())
    }

    /// The same templates, each with its surface.
    pub fn fitted(&self, seed: u64) -> Result<Vec<Fitted>, TemplatesError> {
        let surfaces = match &self.surfaces {
            Surfaces::Angular { indices, count } => {
                let surface = |number| indices.surface(seed, number as u64).map(Arc::new);
                (0..*count).map(surface).collect::<Result<Vec<_>, _>>().map_err(TemplatesError::Surface)?
            }
            Surfaces::Meshes(meshes) => meshes.clone(),
        };
        let fitted = |(number, surface)| self.fit(number, surface);
        // all surfaces are fitted before the first error is returned, so the error does not depend on the threads
        let fitted: Vec<Result<Fitted, TemplatesError>> = surfaces.into_par_iter().enumerate().map(fitted).collect();
        fitted.into_iter().collect()
    }

    fn fit(&self, number: usize, surface: Arc<Mesh>) -> Result<Fitted, TemplatesError> {
        let bubbles = Bubbles::fill(&surface, &self.rule);
        let (found, fewest) = (bubbles.pebbles.len(), self.rule.pebbles[0].max(1));
        if found < fewest {
            return Err(TemplatesError::TooFew { surface: number, found, fewest });
        }
        let clump = Template::from_pebbles(&bubbles.pebbles).map_err(TemplatesError::Clump)?;
        let template = clump.scaled(1.0 / clump.equivalent_diameter());
        Ok(Fitted { surface, bubbles, template })
    }
}

impl fmt::Display for TemplatesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TemplatesError::Surface(error) => error.fmt(f),
            TemplatesError::Clump(error) => error.fmt(f),
            TemplatesError::TooFew { surface, found, fewest } => write!(
                f,
                "only {found} pebbles fit into surface {surface}, fewer than the {fewest} required, because it is nearly a ball: require fewer pebbles"
            ),
        }
    }
}

impl std::error::Error for TemplatesError {}
