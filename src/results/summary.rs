//! `summary.json`: the scalars of a run under their names, its expectations, and its provenance.

use super::Reliance;
use crate::check::EDIT;
use crate::diag::Sources;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Scalars by name, and the provenance of the whole run. The scalars stand at the top level of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    #[serde(flatten)]
    pub scalars: BTreeMap<String, Scalar>,
    pub expectations: Vec<Verdict>,
    /// The reliance of its numbers; empty in a file of an older version.
    #[serde(default)]
    pub reliance: Reliance,
    pub provenance: Provenance,
}

/// A number and its SI unit; `1` for a count or a ratio.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    pub value: f64,
    pub unit: String,
}

impl Scalar {
    pub fn new(value: f64, unit: &str) -> Self {
        Scalar { value, unit: unit.to_owned() }
    }
}

/// An expectation of the scene and its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    pub text: String,
    pub met: bool,
    /// The operands as computed, in `unit`; empty if one could not be computed.
    pub values: Vec<f64>,
    pub unit: String,
    /// Why an operand could not be computed; the expectation then counts as missed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

/// Provenance of a run: the data needed to repeat it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    pub program: String,
    pub version: String,
    /// Name of the main file.
    pub file: String,
    /// Text of the main file, and the SHA-256 of all texts and overrides.
    pub source: String,
    pub source_sha256: String,
    /// Lines that were edited for the run, as `path = value`.
    #[serde(default)]
    pub overrides: Vec<String>,
    pub seed: u64,
    /// The solver graph as `trackbed plan` prints it.
    pub plan: String,
}

impl Provenance {
    /// Provenance of a run of `sources`, the main file first, with the hash of all inputs and the plan.
    pub fn new(sources: &Sources, sha256: String, seed: u64, plan: String) -> Provenance {
        // the name alone: equal scenes give equal files wherever they lie
        let name = |path: &str| path.rsplit(['/', '\\']).next().unwrap_or(path).to_string();
        let edits = sources.iter().filter(|(_, source)| source.name == EDIT);
        let main = sources.iter().next().map(|(_, s)| (name(&s.name), s.text.clone())).unwrap_or_default();
        Provenance {
            program: env!("CARGO_PKG_NAME").into(),
            version: env!("CARGO_PKG_VERSION").into(),
            file: main.0,
            source: main.1,
            source_sha256: sha256,
            overrides: edits.map(|(_, edit)| edit.text.trim().to_owned()).collect(),
            seed,
            plan,
        }
    }
}
