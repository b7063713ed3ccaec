//! The law of a sleeper's support, which pushes and never pulls.
//!
//! At gap coordinate g (sleeper below support level: g > 0) the spring carries `E(g) = k g`, or with a seating of stiffness
//! `k_s <= k` and closure a, `E(g) = k_s g` up to a and `k_s a + k (g - a)` beyond: ballast that first has to come together. One
//! damper acts along both: `R = max(0, E(g) + c g')` while g > 0, nothing while g < 0.
//!
//! Within one time step `g' = r g + d`, with r > 0 given by the integrator and d the speed at which the sleeper would pass
//! g = 0. For d > 0 the force jumps from 0 to c d at g = 0. Filled in there, the graph of R over g is maximal monotone in every
//! case, as E has slopes above zero:
//!
//! ```text
//! d > 0:   R = 0 (g <= 0),   0 <= R <= c d (g = 0),   R = E(g) + c r g + c d (g >= 0)
//! d <= 0:  R = max(0, E(g) + c r g + c d)
//! ```
//!
//! The rest of the step answers forces by a positive definite compliance, and so do the wheels with monotone laws: the sum of
//! both is strongly monotone, and a time step has exactly one solution.

use serde::{Deserialize, Serialize};

/// Which branch of its graph a support is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SupportPhase {
    /// It carries by its full stiffness.
    #[default]
    Closed,
    /// It carries by its seating.
    Seating,
    /// The sleeper arrives: its gap is zero and the support carries part of the damper force.
    Touching,
    /// It carries nothing.
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

/// What a sleeper feels under it: plain numbers of one seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spring {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// Stiffness, N/m, of the first compression, and how far that reaches, m.
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

/// A support whose stiffness grows once: before `closure` it is less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seating {
    /// N/m, above 0 and at most that of the support.
    pub stiffness: f64,
    /// Displacement over which the seating acts alone, m, above 0.
    pub closure: f64,
}

/// A sleeper of the mesh, and the support that it stands on.
#[derive(Debug, Clone, Copy)]
pub(super) struct SleeperSupport {
    pub seat: usize,
    pub unknown: usize,
    pub support_stiffness: f64,
    pub support_damping: f64,
    pub seating: Option<Seating>,
}

/// Gaps below this are none, m.
const GAP_TOLERANCE: f64 = 1e-14;

impl SleeperSupport {
    /// What the seating lacks of the full stiffness, N/m, and its closure, m; both 0 where there is none.
    #[inline]
    fn seating(&self) -> (f64, f64) {
        match self.seating {
            Some(seating) if seating.stiffness < self.support_stiffness => {
                (self.support_stiffness - seating.stiffness, seating.closure)
            }
            _ => (0.0, 0.0),
        }
    }

    /// What a closed support carries less than one without seating, N.
    #[inline]
    pub fn seating_loss(&self) -> f64 {
        let (lack, closure) = self.seating();
        lack * closure
    }

    /// What a support in a phase lacks of the full stiffness, N/m.
    pub fn lacking_stiffness(&self, phase: SupportPhase) -> f64 {
        match phase {
            SupportPhase::Closed => 0.0,
            SupportPhase::Seating => self.seating().0,
            SupportPhase::Touching | SupportPhase::Open => self.support_stiffness,
        }
    }

    /// Force of a resting support at gap coordinate 0 if its phase went on to there, N.
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

    /// The phase at rest at a gap coordinate (m); the phase `now` unless that contradicts it.
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

    /// The force in a phase at a gap coordinate (m) where it falls short of the closed line by `correction`, N.
    #[inline]
    pub fn force(&self, phase: SupportPhase, gap: f64, correction: f64) -> f64 {
        match phase {
            SupportPhase::Closed => self.closed(gap),
            SupportPhase::Seating => self.seating(gap),
            SupportPhase::Touching => self.closed(0.0) - correction,
            SupportPhase::Open => 0.0,
        }
    }

    /// The phase that carries at a gap coordinate (m).
    #[inline]
    fn carrying(&self, gap: f64) -> SupportPhase {
        if self.lack > 0.0 && gap < self.closure { SupportPhase::Seating } else { SupportPhase::Closed }
    }

    /// The phase that follows from a trial: the gap coordinate, m, and the force that the phase `now` gave, N.
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
        /// One support on a spring, whatever its phase before: the phases settle on the one solution, found by bisection.
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
