//! A study: which values of a scene vary and over what, and what is asked of each point. Pure data; a value that varies is
//! kept as text of the language, since a point is the scene with those lines edited.

use super::response::{Expectation, Expression};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Study {
    pub name: String,
    /// The header of its declaration.
    pub span: Span,
    pub axes: Vec<Axis>,
    pub sampling: Sampling,
    /// Lines edited alike in every point.
    pub set: Vec<Setting>,
    /// Runs of each point; run r has the seed of the scene + r.
    pub repeats: u32,
    /// Time of computing on one core that the whole study may take, s, and where it is stated.
    pub budget: Option<(f64, Span)>,
    pub objectives: Vec<Objective>,
    pub report: Vec<Measured>,
    pub constraints: Vec<Expectation>,
}

/// A value that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The path as `--set` takes it.
    pub path: String,
    /// Where the path stands.
    pub span: Span,
    /// What stands behind its numbers, such as `MN/m per seat`; empty for plain numbers and for values that are none.
    pub unit: String,
    pub values: Values,
    /// What the scene itself says there; `None` where it could not be read.
    pub written: Option<Written>,
}

/// What the scene as it is says where a study varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Written {
    pub text: String,
    /// In the unit of the axis; `None` where it is no number, or one of another basis.
    pub number: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Values {
    Listed(Vec<Choice>),
    Spread(Spread),
}

/// One entry of a list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The value as it would stand in the file.
    pub text: String,
    /// In the unit of the axis; `None` where it is no number.
    pub number: Option<f64>,
    pub span: Span,
}

/// How numbers are spread, in the unit of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Spread {
    Uniform {
        from: f64,
        to: f64,
    },
    Normal {
        mean: f64,
        deviation: f64,
    },
    /// `sigma` is the standard deviation of the logarithm.
    LogNormal {
        median: f64,
        sigma: f64,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sampling {
    /// Every combination.
    Grid,
    LatinHypercube {
        points: u32,
    },
    Sobol {
        points: u32,
    },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    pub path: String,
    pub value: String,
    pub span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    Minimise,
    Maximise,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    pub goal: Goal,
    pub of: Measured,
}

/// An expression of responses under its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The expression as written.
    pub text: String,
    pub expression: Expression,
    /// The unit in which it reads well, and its size in SI.
    pub unit: (String, f64),
}

impl Study {
    /// Everything that is measured, objectives first, each once.
    pub fn measured(&self) -> Vec<&Measured> {
        let mut all: Vec<&Measured> = Vec::new();
        for measured in self.objectives.iter().map(|o| &o.of).chain(&self.report) {
            if !all.iter().any(|m| m.text == measured.text) {
                all.push(measured);
            }
        }
        all
    }
}

impl Setting {
    /// The line that it stands for.
    pub fn line(&self) -> String {
        format!("{} = {}", self.path, self.value)
    }
}
