//! Result of a trial: right, coarse, refused, or wrong without a diagnostic, judged by a reference and by the
//! diagnostics before the run.

use super::planned::Planned;
use super::variant::Measured;
use crate::diag::Code;
use crate::execute::RunError;
use crate::execute::diagnose;
use crate::graph::Clock;
use crate::lint::lint;
use crate::lower::{Lowered, lower};
use crate::nodes::{NodeError, RUNAWAY};
use crate::scenario::Scenario;
use crate::solvers::track::TrackError;
use crate::units::number;
use serde::Serialize;

/// Result of a trial.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "ends")]
pub enum Verdict {
    /// Within [`TOLERATED`] of the reference.
    Stable { error: f64 },
    /// Further away, and a diagnostic has said so before the run.
    Coarse { error: f64, code: &'static str },
    /// Unstable because of its numerics, while the reference is stable, and a run reports it.
    Unstable { why: String, code: &'static str },
    /// Refused, before or during the run.
    Refused { code: &'static str, message: String },
    /// Neither right nor diagnosed.
    Wrong { why: String },
}

impl Verdict {
    pub fn name(&self) -> &'static str {
        match self {
            Verdict::Stable { .. } => "stable",
            Verdict::Coarse { .. } => "coarse",
            Verdict::Unstable { .. } => "unstable",
            Verdict::Refused { .. } => "refused",
            Verdict::Wrong { .. } => "wrong",
        }
    }

    pub fn is_wrong(&self) -> bool {
        matches!(self, Verdict::Wrong { .. })
    }

    pub fn error(&self) -> Option<f64> {
        match self {
            Verdict::Stable { error } | Verdict::Coarse { error, .. } => Some(*error),
            _ => None,
        }
    }

    pub fn code(&self) -> Option<&'static str> {
        match self {
            Verdict::Coarse { code, .. } | Verdict::Unstable { code, .. } | Verdict::Refused { code, .. } => Some(code),
            _ => None,
        }
    }

    /// In a line.
    pub fn told(&self) -> String {
        let percent = |error: &f64| number((error * 1e5).round() / 1e3);
        match self {
            Verdict::Stable { error } => format!("{} % off", percent(error)),
            Verdict::Coarse { error, code } => format!("{} % off, {code} warns", percent(error)),
            Verdict::Unstable { why, code } => format!("{code}: {why}"),
            Verdict::Refused { code, message } => format!("{code}: {message}"),
            Verdict::Wrong { why } => why.clone(),
        }
    }

    /// Additional text.
    pub fn why(&self) -> &str {
        match self {
            Verdict::Unstable { why, .. } | Verdict::Wrong { why } => why,
            Verdict::Refused { message, .. } => message,
            _ => "",
        }
    }
}

/// Largest error of a passage that still shows what happens: of the wheel force as a root mean square over the static
/// one, and of the peak seat loads over the largest of them.
pub const TOLERATED: f64 = 0.1;

/// Diagnostics of `check` on the time step before the run.
pub(super) enum Foreseen {
    Fine,
    Warned(&'static str),
    Refused(&'static str, String),
}

impl Foreseen {
    pub fn warning(&self) -> Option<&'static str> {
        if let Foreseen::Warned(code) = self { Some(code) } else { None }
    }
}

/// Lowers a scene and returns the diagnostics on its numerics, also from rules that the scene silences.
pub(super) fn check(scenario: &Scenario) -> (Option<Planned>, Foreseen, Vec<&'static str>) {
    let Lowered { graph, origins, diagnostics, .. } = lower(scenario);
    if let Some(error) = diagnostics.iter().find(|d| d.is_error()) {
        return (None, Foreseen::Refused(error.code.as_str(), error.message.clone()), Vec::new());
    }
    let Some(planned) = graph.and_then(|graph| Planned::new(&graph, &origins)) else {
        return (None, Foreseen::Refused(Code::E0601.as_str(), "nothing runs over the track".into()), Vec::new());
    };
    let aloud = Scenario { allow: Vec::new(), deny: Vec::new(), ..scenario.clone() };
    let mut warnings = lint(&aloud, &planned.graph);
    warnings.dedup_by_key(|d| d.code);
    // on the step, and on a speed at which the track no longer responds as at rest
    let foreseen = match warnings.iter().find(|d| [Code::L1005, Code::L1002].contains(&d.code)) {
        Some(warning) => Foreseen::Warned(warning.code.as_str()),
        None => Foreseen::Fine,
    };
    (Some(planned), foreseen, warnings.iter().map(|d| d.code.as_str()).collect())
}

/// The diagnostic that a user would see.
pub(super) fn refused(cause: &TrackError, planned: &Planned) -> Verdict {
    let error = RunError::node(Clock::Axles(0), NodeError::Track(cause.clone()));
    let diagnostic = diagnose(&error, &planned.graph, &planned.origins);
    Verdict::Refused { code: diagnostic.code.as_str(), message: diagnostic.message }
}

/// Compares a passage with its reference. `warning` is the code that reported its numerics before the run.
pub(super) fn judge(
    measured: &Measured,
    reference: &Measured,
    static_force: f64,
    warning: Option<&'static str>,
) -> Verdict {
    let errors = measured.errors(reference, static_force);
    let error = errors.wheel_force_rms.max(errors.seat_load);
    let code = Code::E0703.as_str();
    if measured.wheel_peak > RUNAWAY * static_force {
        let message = format!("a wheel force of {:.1} times the static one", measured.wheel_peak / static_force);
        // of the scene itself, or of its numerics
        return if reference.wheel_peak > 0.5 * RUNAWAY * static_force {
            Verdict::Refused { code, message }
        } else {
            Verdict::Unstable { why: message, code }
        };
    }
    match warning {
        _ if !error.is_finite() => Verdict::Wrong { why: "a force is not a number".into() },
        _ if error <= TOLERATED => Verdict::Stable { error },
        Some(code) => Verdict::Coarse { error, code },
        None => Verdict::Wrong { why: format!("{:.0} % from the reference", 100.0 * error) },
    }
}
