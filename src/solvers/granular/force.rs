//! The force of a contact (methods 1.1), lane by lane.

use super::lanes::{Columns, Fine, Lanes, Num, Real, Row, Vector};
use super::law::{ContactLaw, Dashpot, FrictionLimit, HertzMindlin, Linear};

/// Two surfaces that may be in contact.
#[derive(Clone, Copy)]
pub struct Meeting<L: Lanes> {
    /// \[m\], positive if they touch.
    pub overlap: Num<L>,
    /// Unit vector from the second body to the first.
    pub normal: Vector<L>,
    /// From the centres to the contact point, which is in the middle of the overlap \[m\].
    pub arms: [Num<L>; 2],
    /// Velocity of the first body relative to the second, at the contact point \[m/s\].
    pub velocity: Vector<L>,
    /// Mean spin about the normal \[rad/s\].
    pub twist: Num<L>,
    /// `m1 m2 / (m1 + m2)` \[kg\].
    pub mass: Num<L>,
    /// `r1 r2 / (r1 + r2)` \[m\].
    pub curvature_radius: Num<L>,
}

/// Forces of a contact on the first of its two bodies; the forces on the second are opposite.
#[derive(Clone, Copy)]
pub struct ContactForces<L: Lanes> {
    pub force: Vector<L>,
    /// Force of the shear spring: the history of the contact.
    pub shear: Vector<L>,
    /// Force of the dashpots.
    pub damping: Vector<L>,
    /// Energy in the springs \[J\].
    pub strain: Num<L>,
    /// Energy lost in this step by slip \[J\].
    pub slip: Num<L>,
}

impl<L: Lanes> Meeting<L> {
    /// Two pebbles; `image` is the shift of the first if they are in contact across cells.
    ///
    /// Swapping the two pebbles changes only signs, no other bit. The distance is an `f64`: a root in the precision of
    /// the contact, and one step of Newton's iteration.
    #[inline(always)]
    pub fn between(lanes: L, a: &Columns<L>, b: &Columns<L>, image: Option<[Fine<L>; 3]>) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (a.position, b.position);
        let (mut x, mut y, mut z) = (ax - bx, ay - by, az - bz);
        if let Some([sx, sy, sz]) = image {
            (x, y, z) = (x + sx, y + sy, z + sz);
        }
        let zero = Fine::splat(lanes, 0.0);
        let square = z.fma(z, y.fma(y, x.fma(x, zero)));
        let root = square.narrow().max(Num::splat(lanes, 1e-30)).sqrt();
        let inverse = Num::splat(lanes, 1.0) / root;
        let rest = (-root).widen().fma(root.widen(), square).narrow();
        let half = Num::splat(lanes, 0.5);
        let overlap = (a.radius + b.radius - root.widen()).narrow() - rest * (half * inverse);
        let normal = Vector([x.narrow(), y.narrow(), z.narrow()]).scale(inverse);
        let (first, second) = (a.radius.narrow(), b.radius.narrow());
        let arms = [first - half * overlap, second - half * overlap];
        // both products are rounded, so that the order of the two pebbles has no effect
        let rolling = a.spin.scale(arms[0]) + b.spin.scale(arms[1]);
        Meeting {
            overlap,
            normal,
            arms,
            velocity: a.velocity - b.velocity - rolling.cross(normal),
            twist: half * (a.spin + b.spin).dot(normal),
            mass: a.mass * b.mass / (a.mass + b.mass),
            curvature_radius: first * second / (first + second),
        }
    }
}

/// A law prepared for one time step.
#[derive(Debug, Clone, Copy)]
pub enum Prepared {
    Linear(LinearStep),
    Hertz(HertzStep),
}

#[derive(Debug, Clone, Copy)]
pub struct LinearStep {
    law: Linear,
    /// Dashpots divided by the root of the mass, if they are given as ratios.
    per_root: [f64; 2],
    dt: f64,
}

#[derive(Debug, Clone, Copy)]
pub struct HertzStep {
    law: HertzMindlin,
    ratio: f64,
    dt: f64,
}

/// A law that is evaluated in lanes.
pub trait ForceRule: Copy {
    fn force<L: Lanes>(&self, lanes: L, meeting: &Meeting<L>, shear: Vector<L>) -> ContactForces<L>;
}

impl Prepared {
    pub fn new(law: &ContactLaw, dt: f64) -> Prepared {
        match law {
            ContactLaw::Linear(law) => {
                let per_root = match law.dashpot {
                    Dashpot::Constant { .. } => [0.0; 2],
                    Dashpot::Ratio { normal, shear } => {
                        [2.0 * normal * law.normal_stiffness.sqrt(), 2.0 * shear * law.shear_stiffness.sqrt()]
                    }
                };
                Prepared::Linear(LinearStep { law: *law, per_root, dt })
            }
            ContactLaw::HertzMindlin(law) => Prepared::Hertz(HertzStep { law: *law, ratio: law.damping_ratio(), dt }),
        }
    }

    /// One meeting per lane, for any lane type.
    #[inline(always)]
    pub fn force<L: Lanes>(&self, lanes: L, meeting: &Meeting<L>, shear: Vector<L>) -> ContactForces<L> {
        match self {
            Prepared::Linear(rule) => rule.force(lanes, meeting, shear),
            Prepared::Hertz(rule) => rule.force(lanes, meeting, shear),
        }
    }
}

/// Stiffness and dashpots of a contact at this instant, and its friction limit.
struct Springs<L: Lanes> {
    normal: Num<L>,
    shear_stiffness: Num<L>,
    normal_dashpot: Num<L>,
    shear_dashpot: Num<L>,
    friction: Num<L>,
    pulls: bool,
    rests_in_slip: bool,
    limit: FrictionLimit,
    /// Energy of the normal spring divided by its force times overlap.
    share: f64,
}

impl ForceRule for LinearStep {
    #[inline(always)]
    fn force<L: Lanes>(&self, lanes: L, meeting: &Meeting<L>, shear: Vector<L>) -> ContactForces<L> {
        let law = &self.law;
        let (normal_dashpot, shear_dashpot) = match law.dashpot {
            Dashpot::Constant { normal, shear } => (Num::splat(lanes, normal), Num::splat(lanes, shear)),
            Dashpot::Ratio { .. } => {
                let root = meeting.mass.sqrt();
                (Num::splat(lanes, self.per_root[0]) * root, Num::splat(lanes, self.per_root[1]) * root)
            }
        };
        let springs = Springs {
            normal: Num::splat(lanes, law.normal_stiffness) * meeting.overlap,
            shear_stiffness: Num::splat(lanes, law.shear_stiffness),
            normal_dashpot,
            shear_dashpot,
            friction: Num::splat(lanes, law.friction),
            pulls: law.mode.pulls(),
            rests_in_slip: law.mode.rests_in_slip(),
            limit: law.limit,
            share: 0.5,
        };
        springs.act(lanes, meeting, shear, self.dt)
    }
}

impl ForceRule for HertzStep {
    #[inline(always)]
    fn force<L: Lanes>(&self, lanes: L, meeting: &Meeting<L>, shear: Vector<L>) -> ContactForces<L> {
        let law = &self.law;
        let contact_radius = (meeting.curvature_radius * meeting.overlap.max(Num::splat(lanes, 0.0))).sqrt();
        let tangent = Num::splat(lanes, 2.0 * law.effective_modulus) * contact_radius;
        let shear_stiffness = Num::splat(lanes, 8.0 * law.effective_shear_modulus) * contact_radius;
        // c = 2 sqrt(5/6) beta sqrt(S m) (Tsuji 1992)
        let scale = Num::splat(lanes, 2.0 * (5.0f64 / 6.0).sqrt() * self.ratio);
        let springs = Springs {
            normal: Num::splat(lanes, 2.0 / 3.0) * tangent * meeting.overlap,
            shear_stiffness,
            normal_dashpot: scale * (tangent * meeting.mass).sqrt(),
            shear_dashpot: if law.shear_dashpot {
                scale * (shear_stiffness * meeting.mass).sqrt()
            } else {
                Num::splat(lanes, 0.0)
            },
            friction: Num::splat(lanes, law.friction),
            pulls: law.mode.pulls(),
            rests_in_slip: law.mode.rests_in_slip(),
            limit: law.limit,
            share: 0.4,
        };
        springs.act(lanes, meeting, shear, self.dt)
    }
}

impl<L: Lanes> Springs<L> {
    #[inline(always)]
    fn act(self, lanes: L, meeting: &Meeting<L>, shear: Vector<L>, dt: f64) -> ContactForces<L> {
        let (zero, one, two) = (Num::splat(lanes, 0.0), Num::splat(lanes, 1.0), Num::splat(lanes, 2.0));
        let (tiny, dt) = (Num::splat(lanes, 1e-30), Num::splat(lanes, dt));
        let touching = zero.less(meeting.overlap);
        let normal = meeting.normal;

        let opening = meeting.velocity.dot(normal);
        let pushed = self.normal - self.normal_dashpot * opening;
        let pushed = if self.pulls { pushed } else { pushed.max(zero) };

        // in the step of first contact only the part of the step in contact counts
        let sliding = meeting.velocity - normal.scale(opening);
        let closing = -(opening * dt);
        let part = (meeting.overlap / closing).where_or(meeting.overlap.less(closing), one);
        let carried = carry(shear, normal, meeting.twist * dt, tiny);
        let trial = sliding.fma(-(self.shear_stiffness * dt * part), carried);
        let base = match self.limit {
            FrictionLimit::Spring => self.normal,
            FrictionLimit::Total => pushed.max(-pushed),
        };
        let (limit, size) = (self.friction * base, trial.dot(trial).sqrt());
        let slipping = limit.less(size);
        let held = trial.scale((limit / size.max(tiny)).where_or(slipping, one));
        let rubbing = if self.rests_in_slip { zero.where_or(slipping, self.shear_dashpot) } else { self.shear_dashpot };

        let damping = (normal.scale(pushed - self.normal) - sliding.scale(rubbing)).only(touching);
        let held = held.only(touching);
        let spring = self.normal.where_or(touching, zero);
        // work of the mean force of the shear spring over the slip; 0 without a shear spring
        let slipped = (carried + held).dot(trial - held) / (two * self.shear_stiffness.max(tiny));
        ContactForces {
            force: normal.fma(spring, damping + held),
            shear: held,
            damping,
            strain: Num::splat(lanes, self.share) * spring * meeting.overlap
                + held.dot(held) / (two * self.shear_stiffness.max(tiny)),
            slip: slipped.where_or(touching, zero),
        }
    }
}

/// Shear force moved with the rotating contact plane: into the new plane with equal magnitude, and rotated about its
/// normal.
#[inline(always)]
pub fn carry<L: Lanes>(shear: Vector<L>, normal: Vector<L>, angle: Num<L>, tiny: Num<L>) -> Vector<L> {
    let flat = normal.fma(-shear.dot(normal), shear);
    let stretch = (shear.dot(shear) / flat.dot(flat).max(tiny)).sqrt();
    let flat = flat.scale(stretch);
    normal.cross(flat).fma(angle, flat)
}

/// Tangent stiffness and dashpots of a law at a state, for critical time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangent {
    /// \[N/m\]
    pub normal: f64,
    pub shear: f64,
    /// \[N s/m\]
    pub normal_dashpot: f64,
    pub shear_dashpot: f64,
}

impl Tangent {
    /// At `overlap` \[m\] between bodies of effective `mass` \[kg\] and curvature `radius` \[m\].
    pub fn from_law(law: &ContactLaw, overlap: f64, mass: f64, radius: f64) -> Tangent {
        match law {
            ContactLaw::Linear(law) => {
                let (normal, shear) = (law.normal_stiffness, law.shear_stiffness);
                let (normal_dashpot, shear_dashpot) = match law.dashpot {
                    Dashpot::Constant { normal, shear } => (normal, shear),
                    Dashpot::Ratio { normal: a, shear: b } => {
                        (2.0 * a * (mass * normal).sqrt(), 2.0 * b * (mass * shear).sqrt())
                    }
                };
                Tangent { normal, shear, normal_dashpot, shear_dashpot }
            }
            ContactLaw::HertzMindlin(law) => {
                let contact_radius = (radius * overlap.max(0.0)).sqrt();
                let (normal, shear) =
                    (2.0 * law.effective_modulus * contact_radius, 8.0 * law.effective_shear_modulus * contact_radius);
                let scale = 2.0 * (5.0f64 / 6.0).sqrt() * law.damping_ratio();
                let shear_dashpot = if law.shear_dashpot { scale * (shear * mass).sqrt() } else { 0.0 };
                Tangent { normal, shear, normal_dashpot: scale * (normal * mass).sqrt(), shear_dashpot }
            }
        }
    }
}

/// Result of a contact for its two bodies: force, `normal x force`, and both arms.
#[inline(always)]
pub fn outcome<L: Lanes>(meeting: &Meeting<L>, contact: &ContactForces<L>) -> [Num<L>; 8] {
    let [fx, fy, fz] = contact.force.0;
    let [qx, qy, qz] = meeting.normal.cross(contact.force).0;
    [fx, fy, fz, qx, qy, qz, meeting.arms[0], meeting.arms[1]]
}

/// [`outcome`] stored: force on the first, `normal x force`, arms.
pub type Outcome<R> = Row<R>;

/// Force on the first of two by an [`Outcome`].
pub fn force_of<R: Real>(outcome: &Outcome<R>) -> [f64; 3] {
    [outcome[0].to_f64(), outcome[1].to_f64(), outcome[2].to_f64()]
}
