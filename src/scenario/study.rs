//! A study: the values of a scene that vary, their ranges, and the requested responses of each point. Pure data. A
//! varying value is kept as text of the language, because a point is the scene with these fields edited.

use super::Repeats;
use super::response::{Expectation, Expression};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Study {
    pub name: String,
    /// Place of the header of its declaration.
    pub span: Span,
    pub axes: Vec<Axis>,
    pub sampling: Sampling,
    /// Fields that have the same new value in every point.
    pub set: Vec<Setting>,
    /// Runs of each point; run r has the seed of the scene + r.
    pub repeats: Repeats,
    /// Difference of a measured value that does not matter / value of the scene as it is: it ends an open range of
    /// repeats.
    pub tolerance: f64,
    /// Largest computing time of the whole study on one core, s, and its place in the text.
    pub budget: Option<(f64, Span)>,
    pub objectives: Vec<Objective>,
    pub report: Vec<Measured>,
    pub constraints: Vec<Expectation>,
}

/// A value that varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The path in the notation of `--set`.
    pub path: String,
    /// Place of the path in the text.
    pub span: Span,
    /// The text after its numbers, such as `MN/m per seat`; empty for plain numbers and for values that are not
    /// numbers.
    pub unit: String,
    pub values: Values,
    /// The value in the scene itself; `None` if it could not be read.
    pub written: Option<Written>,
}

/// The value of the unchanged scene at a varied path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Written {
    pub text: String,
    /// Value in the unit of the axis; `None` if it is not a number or has another basis.
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
    /// The value as text of the language.
    pub text: String,
    /// Value in the unit of the axis; `None` if it is not a number.
    pub number: Option<f64>,
    pub span: Span,
}

/// The distribution of numbers, in the unit of the axis.
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

/// An expression of responses with its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The expression as written.
    pub text: String,
    pub expression: Expression,
    /// The unit for display, and its size in SI.
    pub unit: (String, f64),
}

impl Study {
    /// All measured expressions, objectives first, each once.
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
    /// The setting as a line of text.
    pub fn line(&self) -> String {
        format!("{} = {}", self.path, self.value)
    }
}
