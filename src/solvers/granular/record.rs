//! The data of a pebble that its contacts read: one record, in one or two cache lines.

use bytemuck::{Pod, Zeroable};

/// A pebble as its contacts read it. Positions are offsets in the cell of the pebble.
pub trait Record<R>: Pod + Send + Sync {
    /// A pebble at rest at the origin of its cell.
    fn new(radius: f64, mass: f64) -> Self;
    fn place(&mut self, position: [f64; 3]);
    fn move_with(&mut self, velocity: [R; 3], spin: [R; 3]);
    /// \[m\]
    fn position(&self) -> [f64; 3];
    /// \[m/s\]
    fn velocity(&self) -> [R; 3];
    /// \[rad/s\]
    fn spin(&self) -> [R; 3];
    /// \[m\]
    fn radius(&self) -> f64;
    /// Mass of the body of the pebble, without the mass added by mass scaling: damping ratios refer to it \[kg\].
    fn mass(&self) -> R;
    fn set_mass(&mut self, mass: R);
}

/// Motion in single precision: 64 bytes, one cache line.
///
/// Position and radius stay `f64`: the overlap of a contact is their difference, about a hundred thousandth of a
/// radius.
#[repr(C, align(64))]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Compact {
    position: [f64; 3],
    velocity: [f32; 3],
    spin: [f32; 3],
    radius: f64,
    mass: f32,
    spare: f32,
}

/// All in double precision: the reference.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Full {
    position: [f64; 3],
    velocity: [f64; 3],
    spin: [f64; 3],
    radius: f64,
    mass: f64,
}

macro_rules! record {
    ($type:ident, $real:ty) => {
        impl Record<$real> for $type {
            fn new(radius: f64, mass: f64) -> Self {
                $type { radius, mass: mass as $real, ..Zeroable::zeroed() }
            }
            #[inline(always)]
            fn place(&mut self, position: [f64; 3]) {
                self.position = position;
            }
            #[inline(always)]
            fn move_with(&mut self, velocity: [$real; 3], spin: [$real; 3]) {
                (self.velocity, self.spin) = (velocity, spin);
            }
            #[inline(always)]
            fn position(&self) -> [f64; 3] {
                self.position
            }
            #[inline(always)]
            fn velocity(&self) -> [$real; 3] {
                self.velocity
            }
            #[inline(always)]
            fn spin(&self) -> [$real; 3] {
                self.spin
            }
            #[inline(always)]
            fn radius(&self) -> f64 {
                self.radius
            }
            #[inline(always)]
            fn mass(&self) -> $real {
                self.mass
            }
            fn set_mass(&mut self, mass: $real) {
                self.mass = mass;
            }
        }
    };
}

record!(Compact, f32);
record!(Full, f64);
