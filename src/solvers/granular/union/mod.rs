//! Integrals over unions of overlapping balls, by planes: on every plane a union of circles, integrated exactly.
//!
//! Gauss's theorem turns the integral over the union into an integral over its surface, which consists of patches of
//! the spheres. A plane across the z axis cuts a patch in arcs of one circle, for which the integral has a closed form
//! (Green's theorem). The remaining integral is along z. It is smooth between the heights at which arcs begin, end or
//! meet; at these heights it has roots at worst. The sine map removes the roots, so that Gauss-Legendre points converge
//! exponentially.

mod arcs;
mod moments;
mod patch;
mod pebble;
mod quadrature;

pub use arcs::{Arcs, Trig};
pub use moments::moments;
pub use patch::{Cap, Patch};
pub use pebble::Pebble;
