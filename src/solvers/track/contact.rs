//! The two laws of contact: Hertz between wheel and rail, and a support that pushes a sleeper and never pulls.
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

/// Force of a wheel that indents the rail by `indentation` (m), N.
#[inline]
pub(super) fn hertz_force(constant: f64, indentation: f64) -> f64 {
    let d = indentation.max(0.0);
    constant * d * d.sqrt()
}

/// Its derivative, N/m.
#[inline]
pub(super) fn hertz_stiffness(constant: f64, indentation: f64) -> f64 {
    1.5 * constant * indentation.max(0.0).sqrt()
}

/// The indentation under `force` (N), m.
pub(super) fn hertz_indentation(constant: f64, force: f64) -> f64 {
    (force.max(0.0) / constant).powf(2.0 / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hertz_of_a_20_t_axle() {
        let indentation = hertz_indentation(100e9, 98.1e3);
        assert!((indentation - 0.0987e-3).abs() < 0.5e-7, "{indentation}");
        assert!((hertz_force(100e9, indentation) / 98.1e3 - 1.0).abs() < 1e-14);
        assert_eq!(hertz_force(100e9, -1e-3), 0.0);
    }
}
