//! The law of the support of a sleeper; the support pushes and never pulls.
//!
//! At gap coordinate g (sleeper below support level: g > 0) the spring carries `E(g) = k g`. With a seating of
//! stiffness `k_s <= k` and closure a, `E(g) = k_s g` up to a and `k_s a + k (g - a)` beyond, for example for loose
//! ballast. One damper acts along both: `R = max(0, E(g) + c g')` for g > 0, 0 for g < 0.
//!
//! Within one time step `g' = r g + d`; the integrator gives r > 0, and d is the speed at which the sleeper would pass
//! g = 0. For d > 0 the force jumps from 0 to c d at g = 0. With this jump filled in, the graph of R over g is maximal
//! monotone in all cases, because E has slopes above zero:
//!
//! ```text
//! d > 0:   R = 0 (g <= 0),   0 <= R <= c d (g = 0),   R = E(g) + c r g + c d (g >= 0)
//! d <= 0:  R = max(0, E(g) + c r g + c d)
//! ```
//!
//! The rest of the step responds to forces by a positive definite compliance, and so do wheels with monotone laws. The
//! sum of both is strongly monotone, so a time step has exactly one solution.

use serde::{Deserialize, Serialize};

/// The branch of its graph on which a support is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SupportPhase {
    /// It carries with its full stiffness.
    #[default]
    Closed,
    /// It carries with the stiffness of its seating.
    Seating,
    /// The sleeper is touching down: its gap is zero and the support carries part of the damper force.
    Touching,
    /// It carries no force.
    Open,
}

impl SupportPhase {
    pub(super) fn word(self) -> &'static str {
        match self {
            SupportPhase::Closed => "closed",
            SupportPhase::Seating => "seating",
            SupportPhase::Touching => "touching",
            SupportPhase::Open => "open",
        }
    }
}

/// The spring and damper under a sleeper, for one seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spring {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// Stiffness of the first compression, N/m, and its range, m.
    pub seating: Option<(f64, f64)>,
}

impl Spring {
    /// Compression under a force (N), m.
    pub fn compression(&self, force: f64) -> f64 {
        match self.seating {
            Some((soft, closure)) if force < soft * closure => force / soft,
            Some((soft, closure)) => closure + (force - soft * closure) / self.stiffness,
            None => force / self.stiffness,
        }
    }
}

/// A support whose stiffness is lower before `closure`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seating {
    /// N/m, above 0 and at most the stiffness of the support.
    pub stiffness: f64,
    /// Displacement over which the seating alone acts, m, above 0.
    pub closure: f64,
}

/// A sleeper of the mesh, and its support.
#[derive(Debug, Clone, Copy)]
pub(super) struct SleeperSupport {
    pub seat: usize,
    pub unknown: usize,
    pub support_stiffness: f64,
    pub support_damping: f64,
    pub seating: Option<Seating>,
}

/// Gaps below this count as zero, m.
const GAP_TOLERANCE: f64 = 1e-14;

impl SleeperSupport {
    /// Full stiffness minus stiffness of the seating, N/m, and its closure, m; both 0 without a seating.
    #[inline]
    fn seating(&self) -> (f64, f64) {
        match self.seating {
            Some(seating) if seating.stiffness < self.support_stiffness => {
                (self.support_stiffness - seating.stiffness, seating.closure)
            }
            _ => (0.0, 0.0),
        }
    }

    /// Force of a closed support without seating minus force of this closed support, N.
    #[inline]
    pub fn seating_loss(&self) -> f64 {
        let (lack, closure) = self.seating();
        lack * closure
    }

    /// Full stiffness minus the stiffness of a support in a phase, N/m.
    pub fn lacking_stiffness(&self, phase: SupportPhase) -> f64 {
        match phase {
            SupportPhase::Closed => 0.0,
            SupportPhase::Seating => self.seating().0,
            SupportPhase::Touching | SupportPhase::Open => self.support_stiffness,
        }
    }

    /// Force of a resting support extrapolated in its phase to gap coordinate 0, N.
    pub fn offset_at_rest(&self, phase: SupportPhase) -> f64 {
        if phase == SupportPhase::Closed { -self.seating_loss() } else { 0.0 }
    }

    /// Spring force at a gap coordinate (m) in a phase, N.
    pub fn spring_force(&self, phase: SupportPhase, gap: f64) -> f64 {
        (self.support_stiffness - self.lacking_stiffness(phase)) * gap + self.offset_at_rest(phase)
    }

    /// The force at a gap coordinate (m) that changes by `rate`, m/s: `max(0, E(g) + c g')` while g > 0, N.
    #[inline]
    pub fn push(&self, gap: f64, rate: f64) -> f64 {
        if gap <= 0.0 {
            return 0.0;
        }
        let (lack, closure) = self.seating();
        (self.support_stiffness * gap - lack * gap.min(closure) + self.support_damping * rate).max(0.0)
    }

    /// The phase at rest at a gap coordinate (m): the phase `now`, unless the gap contradicts it.
    pub fn phase_at_rest(&self, now: SupportPhase, gap: f64) -> SupportPhase {
        let (lack, closure) = self.seating();
        let agrees = match now {
            SupportPhase::Open => gap <= GAP_TOLERANCE,
            SupportPhase::Seating => -GAP_TOLERANCE <= gap && gap <= closure + GAP_TOLERANCE,
            SupportPhase::Closed => gap >= closure - GAP_TOLERANCE,
            SupportPhase::Touching => false,
        };
        match gap {
            _ if agrees => now,
            gap if gap < 0.0 => SupportPhase::Open,
            gap if lack > 0.0 && gap < closure => SupportPhase::Seating,
            _ => SupportPhase::Closed,
        }
    }

    /// The lines of a time step with `g' = rate g + passing_speed`.
    #[inline]
    pub fn lines(&self, rate: f64, passing_speed: f64) -> SupportLines {
        let (lack, closure) = self.seating();
        SupportLines {
            stiffness: self.support_stiffness + rate * self.support_damping,
            offset: self.support_damping * passing_speed,
            lack,
            closure,
        }
    }
}

/// The lines of a carrying support within a time step: `R = stiffness g + offset - lack closure` closed and
/// `R = (stiffness - lack) g + offset` seating.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SupportLines {
    /// k + c r, N/m.
    pub stiffness: f64,
    /// c d, N.
    pub offset: f64,
    /// k - k_s, N/m; 0 without a seating.
    pub lack: f64,
    /// a, m; 0 without a seating.
    pub closure: f64,
}

impl SupportLines {
    /// N, at a gap coordinate (m).
    #[inline]
    pub fn closed(&self, gap: f64) -> f64 {
        self.stiffness * gap + self.offset - self.lack * self.closure
    }

    #[inline]
    pub fn seating(&self, gap: f64) -> f64 {
        (self.stiffness - self.lack) * gap + self.offset
    }

    /// The force in a phase at a gap coordinate (m); while touching, it is `correction` (N) below the closed line.
    #[inline]
    pub fn force(&self, phase: SupportPhase, gap: f64, correction: f64) -> f64 {
        match phase {
            SupportPhase::Closed => self.closed(gap),
            SupportPhase::Seating => self.seating(gap),
            SupportPhase::Touching => self.closed(0.0) - correction,
            SupportPhase::Open => 0.0,
        }
    }

    /// The phase of a carrying support at a gap coordinate (m).
    #[inline]
    fn carrying(&self, gap: f64) -> SupportPhase {
        if self.lack > 0.0 && gap < self.closure { SupportPhase::Seating } else { SupportPhase::Closed }
    }

    /// The phase after a trial, from the gap coordinate, m, and the force in the phase `now`, N.
    #[inline]
    pub fn phase_after(&self, now: SupportPhase, gap: f64, force: f64) -> SupportPhase {
        let force_tolerance = self.stiffness * GAP_TOLERANCE;
        let jumps = self.offset > 0.0;
        match now {
            SupportPhase::Closed if self.lack > 0.0 && gap < self.closure - GAP_TOLERANCE => SupportPhase::Seating,
            SupportPhase::Seating if gap > self.closure + GAP_TOLERANCE => SupportPhase::Closed,
            SupportPhase::Closed | SupportPhase::Seating if jumps && gap < -GAP_TOLERANCE => SupportPhase::Touching,
            SupportPhase::Closed | SupportPhase::Seating if !jumps && force < -force_tolerance => SupportPhase::Open,
            SupportPhase::Touching if !jumps => self.carrying(0.0),
            SupportPhase::Touching if force < -force_tolerance => SupportPhase::Open,
            SupportPhase::Touching if force > self.offset + force_tolerance => self.carrying(0.0),
            SupportPhase::Open if jumps && gap > GAP_TOLERANCE => SupportPhase::Touching,
            SupportPhase::Open if !jumps => {
                let carrying = self.carrying(gap);
                if self.force(carrying, gap, 0.0) > force_tolerance { carrying } else { now }
            }
            unchanged => unchanged,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sleeper(seating: Option<Seating>) -> SleeperSupport {
        SleeperSupport { seat: 0, unknown: 0, support_stiffness: 50e6, support_damping: 50e3, seating }
    }

    #[test]
    fn a_seating_closes() {
        let support = sleeper(Some(Seating { stiffness: 10e6, closure: 1e-3 }));
        for (gap, force) in [(0.5e-3, 5e3), (1e-3, 10e3), (1.2e-3, 20e3)] {
            let phase = support.phase_at_rest(SupportPhase::Open, gap);
            assert!((support.spring_force(phase, gap) - force).abs() < 1e-6);
        }
        assert_eq!(support.phase_at_rest(SupportPhase::Closed, -1e-3), SupportPhase::Open);
    }

    proptest! {
        /// One support on a spring, from any phase: the phases converge to the one solution, found by bisection.
        #[test]
        fn phases_settle(
            free in -2e-3..4e-3f64,
            passing in -0.5..0.5f64,
            seated in any::<bool>(),
            flexibility in 1e-10..1e-8f64,
            start in 0usize..4,
        ) {
            let support = sleeper(seated.then_some(Seating { stiffness: 10e6, closure: 1e-3 }));
            let lines = support.lines(100.0, passing);
            let mut phase = [SupportPhase::Closed, SupportPhase::Seating, SupportPhase::Touching, SupportPhase::Open][start];
            if phase == SupportPhase::Seating && !seated {
                phase = SupportPhase::Closed;
            }
            // The force that the spring behind the support gives at a gap: (free - gap)/flexibility.
            let gap = |phase: SupportPhase| match phase {
                SupportPhase::Closed => (free - flexibility * lines.closed(0.0)) / (1.0 + flexibility * lines.stiffness),
                SupportPhase::Seating => {
                    (free - flexibility * lines.offset) / (1.0 + flexibility * (lines.stiffness - lines.lack))
                }
                SupportPhase::Touching => 0.0,
                SupportPhase::Open => free,
            };
            let force = |phase: SupportPhase| (free - gap(phase)) / flexibility;
            let mut moves = 0;
            loop {
                let next = lines.phase_after(phase, gap(phase), force(phase));
                if next == phase {
                    break;
                }
                phase = next;
                moves += 1;
                prop_assert!(moves < 8);
            }
            // R(g) - (free - g)/flexibility grows with g.
            let law = |g: f64| {
                let carried = if g > 0.0 || passing <= 0.0 { lines.force(lines.carrying(g), g, 0.0).max(0.0) } else { 0.0 };
                carried - (free - g) / flexibility
            };
            let (mut low, mut high) = (-1.0, 1.0);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if law(middle) > 0.0 { high = middle } else { low = middle }
            }
            prop_assert!((gap(phase) - high).abs() < 1e-12, "{:?} {} {}", phase, gap(phase), high);
        }
    }
}
