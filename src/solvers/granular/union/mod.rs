//! Integrals over unions of overlapping balls, by planes: on every plane a union of circles, taken exactly.
//!
//! Gauss's theorem turns the integral over the union into one over its surface, which is made of patches of the spheres. A
//! plane across the z axis cuts a patch in arcs of one circle, on which the integrand is closed (Green's theorem). What is left
//! is an integral along z, smooth between the heights where arcs begin, end or meet; there it has roots at worst, which the
//! sine map takes out, so that Gauss-Legendre points converge exponentially.

mod arcs;
mod moments;
mod patch;
mod pebble;
mod quadrature;

pub use arcs::{Arcs, Trig};
pub use moments::moments;
pub use patch::{Cap, Patch};
pub use pebble::Pebble;
