//! The laws of contact: of a wheel on the rail, and of a support that pushes a sleeper and never pulls.
//!
//! A support at gap coordinate g (sleeper below support level: g > 0) carries `R = max(0, k g + c g')` while g > 0 and
//! nothing while g < 0. Within one time step `g' = r g + d`, with r > 0 given by the integrator and d the speed at which the
//! sleeper would pass g = 0. For d > 0 the force jumps from 0 to c d at g = 0; filled in, the graph of R over g is monotone
//! in every case, so a time step has exactly one solution:
//!
//! ```text
//! d > 0:   R = 0 (g <= 0),   0 <= R <= c d (g = 0),   R = (k + c r) g + c d (g >= 0)
//! d <= 0:  R = max(0, (k + c r) g + c d)
//! ```

use super::WheelContact;

/// Which branch of its graph a support is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SupportPhase {
    /// It carries spring and damper force.
    #[default]
    Closed,
    /// The sleeper arrives: its gap is zero and the support carries part of the damper force.
    Touching,
    /// It carries nothing.
    Open,
}

/// The line `R = stiffness g + offset` of a closed support within a time step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SupportLine {
    /// k + c r, N/m.
    pub stiffness: f64,
    /// c d, N.
    pub offset: f64,
}

/// Gaps below this are none, m.
const GAP_TOLERANCE: f64 = 1e-14;

impl SupportLine {
    /// The phase that follows from a trial: the gap coordinate, m, and the force that the phase `now` gave, N.
    #[inline]
    pub fn phase_after(&self, now: SupportPhase, gap: f64, force: f64) -> SupportPhase {
        let force_tolerance = self.stiffness * GAP_TOLERANCE;
        let jumps = self.offset > 0.0;
        match now {
            SupportPhase::Closed if jumps && gap < -GAP_TOLERANCE => SupportPhase::Touching,
            SupportPhase::Closed if !jumps && force < -force_tolerance => SupportPhase::Open,
            SupportPhase::Touching if !jumps => SupportPhase::Closed,
            SupportPhase::Touching if force < -force_tolerance => SupportPhase::Open,
            SupportPhase::Touching if force > self.offset + force_tolerance => SupportPhase::Closed,
            SupportPhase::Open if jumps && gap > GAP_TOLERANCE => SupportPhase::Touching,
            SupportPhase::Open if !jumps && self.stiffness * gap + self.offset > force_tolerance => {
                SupportPhase::Closed
            }
            unchanged => unchanged,
        }
    }
}

/// The force of a wheel over its indentation of the rail, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WheelLaw {
    /// `constant max(0, δ)^1.5`.
    Hertz { constant: f64 },
    /// `stiffness δ + offset`, in both directions.
    Line { stiffness: f64, offset: f64 },
    /// A force that is given, N.
    Given { force: f64 },
}

impl WheelLaw {
    /// The law of a wheel whose indentation does not change.
    pub fn at_rest(contact: WheelContact) -> Self {
        match contact {
            WheelContact::Hertz(constant) => WheelLaw::Hertz { constant },
            WheelContact::Linear { stiffness, .. } => WheelLaw::Line { stiffness, offset: 0.0 },
            WheelContact::Given(force) => WheelLaw::Given { force },
        }
    }

    /// The law at the end of a step of `time_step` (s) that begins at `indentation` after a change by `change` (m) in the
    /// step before. A damper takes the speed that the last two indentations and the new one give to second order,
    /// `δ' = (3 δ_n+1 - 4 δ_n + δ_n-1)/(2 Δt)`, so that slope and unevenness of the wheel's path are part of it.
    #[inline]
    pub fn in_step(contact: WheelContact, indentation: f64, change: f64, time_step: f64) -> Self {
        match contact {
            WheelContact::Linear { stiffness, damping } => {
                let share = 0.5 * damping / time_step;
                WheelLaw::Line { stiffness: stiffness + 3.0 * share, offset: -share * (3.0 * indentation + change) }
            }
            other => Self::at_rest(other),
        }
    }

    /// The force, where it is given, N.
    #[inline]
    pub fn given(&self) -> Option<f64> {
        match *self {
            WheelLaw::Given { force } => Some(force),
            _ => None,
        }
    }

    /// Whether the force at this indentation (m) depends on it.
    #[inline]
    pub fn touches(&self, indentation: f64) -> bool {
        match self {
            WheelLaw::Hertz { .. } => indentation > 0.0,
            WheelLaw::Line { .. } => true,
            WheelLaw::Given { .. } => false,
        }
    }

    /// N.
    #[inline]
    pub fn force(&self, indentation: f64) -> f64 {
        match *self {
            WheelLaw::Hertz { constant } => {
                let d = indentation.max(0.0);
                constant * d * d.sqrt()
            }
            WheelLaw::Line { stiffness, offset } => stiffness * indentation + offset,
            WheelLaw::Given { force } => force,
        }
    }

    /// Its derivative, N/m.
    #[inline]
    pub fn stiffness(&self, indentation: f64) -> f64 {
        match *self {
            WheelLaw::Hertz { constant } => 1.5 * constant * indentation.max(0.0).sqrt(),
            WheelLaw::Line { stiffness, .. } => stiffness,
            WheelLaw::Given { .. } => 0.0,
        }
    }

    /// The tangent at an indentation that touches, as `δ = flexibility F + rest`, m/N and m.
    #[inline]
    pub fn line(&self, indentation: f64) -> (f64, f64) {
        let flexibility = 1.0 / self.stiffness(indentation);
        match *self {
            // F/F' = 2/3 δ for the power 3/2.
            WheelLaw::Hertz { .. } => (flexibility, indentation - indentation / 1.5),
            WheelLaw::Line { offset, .. } => (flexibility, -offset * flexibility),
            WheelLaw::Given { .. } => (flexibility, 0.0),
        }
    }

    /// The indentation under `force` (N), m; 0 where the force is given.
    pub fn indentation(&self, force: f64) -> f64 {
        match *self {
            WheelLaw::Hertz { constant } => (force.max(0.0) / constant).powf(2.0 / 3.0),
            WheelLaw::Line { stiffness, offset } => (force - offset) / stiffness,
            WheelLaw::Given { .. } => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hertz_of_a_20_t_axle() {
        let law = WheelLaw::Hertz { constant: 100e9 };
        let indentation = law.indentation(98.1e3);
        assert!((indentation - 0.0987e-3).abs() < 0.5e-7, "{indentation}");
        assert!((law.force(indentation) / 98.1e3 - 1.0).abs() < 1e-14);
        assert_eq!(law.force(-1e-3), 0.0);
    }

    #[test]
    fn tangents_touch_their_law() {
        for law in [WheelLaw::Hertz { constant: 100e9 }, WheelLaw::Line { stiffness: 3e6, offset: 50.0 }] {
            let (flexibility, rest) = law.line(1e-4);
            assert!((flexibility * law.force(1e-4) + rest - 1e-4).abs() < 1e-18);
        }
    }

    /// A damper on a path of constant curvature: its speed is exact.
    #[test]
    fn damper_speed_is_of_second_order() {
        let contact = WheelContact::Linear { stiffness: 0.0, damping: 1.0 };
        let (dt, path) = (0.1, |t: f64| 2.0 + 3.0 * t + 4.0 * t * t);
        let law = WheelLaw::in_step(contact, path(0.5), path(0.5) - path(0.4), dt);
        assert!((law.force(path(0.6)) - (3.0 + 8.0 * 0.6)).abs() < 1e-12);
    }
}
