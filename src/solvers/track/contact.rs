//! How a wheel presses on the rail: Hertz's law, a spring and damper, or a given force.

use super::WheelContact;

/// Newton steps after which an indentation is exact to rounding.
const NEWTON_LIMIT: usize = 30;

/// The force of a wheel as a function of its indentation of the rail, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WheelLaw {
    /// `constant max(0, δ)^1.5`.
    Hertz { constant: f64 },
    /// `stiffness δ + offset`, in both directions.
    Line { stiffness: f64, offset: f64 },
    /// A given force, N.
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

    /// The law at the end of a step of `time_step` (s). The step begins at `indentation` (m); `change` (m) is the
    /// change of the indentation in the step before. A damper uses the second-order speed from the last two
    /// indentations and the new one, `δ' = (3 δ_n+1 - 4 δ_n + δ_n-1)/(2 Δt)`, so slope and unevenness of the wheel path
    /// are included.
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

    /// The force, if it is given, N.
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

    /// The tangent at an indentation in contact, as `δ = flexibility F + rest`, m/N and m.
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

    /// The indentation of a wheel that approaches the rail by `approach` (m) if the rail yields by `compliance` (m/N)
    /// under it: `δ + compliance F(δ) = approach`.
    #[inline]
    pub fn behind(&self, approach: f64, compliance: f64) -> f64 {
        match *self {
            WheelLaw::Hertz { .. } if approach > 0.0 => {
                // The function is convex and growing: Newton's method converges to the root from above.
                let mut indentation = approach;
                for _ in 0..NEWTON_LIMIT {
                    let excess = indentation + compliance * self.force(indentation) - approach;
                    let change = excess / (1.0 + compliance * self.stiffness(indentation));
                    indentation -= change;
                    if change <= f64::EPSILON * approach {
                        break;
                    }
                }
                indentation
            }
            WheelLaw::Hertz { .. } => approach,
            WheelLaw::Line { stiffness, offset } => (approach - compliance * offset) / (1.0 + compliance * stiffness),
            WheelLaw::Given { force } => approach - compliance * force,
        }
    }

    /// The indentation under `force` (N), m; 0 if the force is given.
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

    #[test]
    fn a_rail_that_yields_takes_its_share() {
        let laws = [WheelLaw::Hertz { constant: 100e9 }, WheelLaw::Line { stiffness: 3e6, offset: 50.0 }];
        for law in laws {
            for (approach, compliance) in [(1e-4, 0.0), (1e-4, 1e-9), (3e-4, 1e-7)] {
                let indentation = law.behind(approach, compliance);
                let sum = indentation + compliance * law.force(indentation);
                assert!((sum / approach - 1.0).abs() < 1e-14, "{law:?} {sum}");
            }
        }
        assert_eq!(laws[0].behind(-1e-3, 1e-9), -1e-3);
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
