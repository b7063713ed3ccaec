//! The limit of the whole network of contacts, without a matrix.
//!
//! For a step dt the largest eigenvalue of dt^2 K + 2 dt C, inertia scaled to one, is computed by locally optimal
//! conjugate gradients (Knyazev 2001): one sweep over the contacts per iteration, three vectors stored. Its mode gives
//! the next step from above, as for one body. The remaining residual is subtracted, because the eigenvalue is larger by
//! at most the residual.

use super::limit::step;
use super::links::{Link, Roots};
use super::local::{Around, own};
use nalgebra::Matrix3;

type Motions = Vec<[f64; 6]>;

/// Largest number of sweeps; none of the tested beds needed half of them.
const MOST: usize = 400;
/// Largest number of trial steps.
const ROUNDS: usize = 8;

/// Springs and dashpots between bodies whose inertia is scaled to one.
pub struct Network<'a> {
    links: &'a [Link],
    roots: &'a [Roots],
}

/// The limit of a network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkLimit {
    /// \[s\]
    pub step: f64,
    /// The body with the largest motion in the mode.
    pub body: Option<u32>,
    pub residual: f64,
    pub sweeps: usize,
}

/// The present mode: a unit vector, its image by the network, and the last search direction.
struct Climb {
    mode: Motions,
    image: Motions,
    way: Motions,
    way_image: Motions,
    /// Rayleigh quotient.
    value: f64,
    residual: f64,
}

impl<'a> Network<'a> {
    pub fn new(links: &'a [Link], roots: &'a [Roots]) -> Self {
        Network { links, roots }
    }

    /// The limit, not shorter than a known `bound`, to a relative tolerance.
    pub fn limit(&self, around: &Around, bound: f64, tolerance: f64) -> NetworkLimit {
        let none = NetworkLimit { step: f64::INFINITY, body: None, residual: 0.0, sweeps: 0 };
        if !bound.is_finite() {
            return none;
        }
        let mut dt = bound;
        let mut sweeps = 1;
        let mode = self.sweep(&self.start(around), dt);
        let mut climb = Climb::new(mode);
        for round in 1.. {
            sweeps += climb.run(|mode| self.sweep(mode, dt), tolerance, MOST.saturating_sub(sweeps));
            let (a, b) = self.forms(&climb.mode);
            sweeps += 1;
            let next = step(a, b);
            if (next / dt - 1.0).abs() < 0.1 * tolerance || sweeps >= MOST || round == ROUNDS {
                break;
            }
            dt = next;
        }
        // at dt the largest eigenvalue is at most this; it decreases at least in proportion to the step, and increases
        // at most with its square
        let most = climb.value + climb.residual;
        let safe = if most > 4.0 { dt * 4.0 / most } else { dt * (4.0 / most).sqrt() };
        let body = largest(&climb.mode);
        NetworkLimit { step: safe.max(bound), body: Some(body), residual: climb.residual / climb.value, sweeps }
    }

    /// (dt^2 K + 2 dt C) on a motion, inertia scaled to one.
    pub fn sweep(&self, mode: &[[f64; 6]], dt: f64) -> Motions {
        let moved: Motions = mode.iter().zip(self.roots).map(|(y, root)| root.apply(*y)).collect();
        let mut forces = vec![[0.0; 6]; mode.len()];
        for link in self.links {
            let t = &link.tangent;
            let along = dt * dt * t.normal + 2.0 * dt * t.normal_dashpot;
            let across = dt * dt * t.shear + 2.0 * dt * t.shear_dashpot;
            link.push(link.stretch(link.apart(&moved), along, across), &mut forces);
        }
        forces.iter_mut().zip(self.roots).for_each(|(f, root)| *f = root.apply(*f));
        forces
    }

    /// Twice the energy in the springs, and the loss in the dashpots, for a mode.
    fn forms(&self, mode: &[[f64; 6]]) -> (f64, f64) {
        let moved: Motions = mode.iter().zip(self.roots).map(|(y, root)| root.apply(*y)).collect();
        let (mut a, mut b) = (0.0, 0.0);
        for link in self.links {
            let (apart, t) = (link.apart(&moved), &link.tangent);
            let along = super::super::vector::dot(apart, link.normal).powi(2);
            let across = super::super::vector::dot(apart, apart) - along;
            a += t.normal * along + t.shear * across;
            b += t.normal_dashpot * along + t.shear_dashpot * across;
        }
        (a, b)
    }

    /// Random motions, larger for bodies with a high stiffness, where the mode is likely to be.
    fn start(&self, around: &Around) -> Motions {
        let own = own(self.links, self.roots, around);
        let largest = own.iter().copied().fold(0.0, f64::max);
        let mut state = 0x9E37_79B9_7F4A_7C15u64;
        let mut chance = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        own.iter().map(|d| [(); 6].map(|()| chance() * (d / largest).powi(2))).collect()
    }
}

impl Climb {
    fn new(mode: Motions) -> Climb {
        let zero = vec![[0.0; 6]; mode.len()];
        Climb { image: zero.clone(), way: zero.clone(), way_image: zero, mode, value: 0.0, residual: f64::INFINITY }
    }

    /// Iterates until the residual is `tolerance` of the eigenvalue or `most` sweeps are done; returns the number of
    /// sweeps.
    fn run(&mut self, sweep: impl Fn(&[[f64; 6]]) -> Motions, tolerance: f64, most: usize) -> usize {
        let zero = vec![[0.0; 6]; self.mode.len()];
        (self.way, self.way_image) = (zero.clone(), zero);
        let length = norm(&self.mode);
        scale(&mut self.mode, 1.0 / length);
        self.image = sweep(&self.mode);
        for sweeps in 1.. {
            self.value = dot(&self.mode, &self.image);
            let mut rest = self.image.clone();
            add(&mut rest, -self.value, &self.mode);
            self.residual = norm(&rest);
            if self.residual <= tolerance * self.value || sweeps >= most {
                return sweeps;
            }
            scale(&mut rest, 1.0 / self.residual);
            let rest_image = sweep(&rest);
            self.improve(rest, rest_image);
        }
        unreachable!("the loop returns")
    }

    /// The best vector in the space of mode, residual and last direction.
    fn improve(&mut self, mut rest: Motions, mut rest_image: Motions) {
        // an orthonormal basis; by rounding the residual still contains a little of the mode
        let left = dot(&rest, &self.mode);
        add(&mut rest, -left, &self.mode);
        add(&mut rest_image, -left, &self.image);
        let length = norm(&rest);
        scale(&mut rest, 1.0 / length);
        scale(&mut rest_image, 1.0 / length);
        let had = norm(&self.way);
        for (base, image) in [(&self.mode, &self.image), (&rest, &rest_image)] {
            let part = dot(&self.way, base);
            add(&mut self.way, -part, base);
            add(&mut self.way_image, -part, image);
        }
        let way = norm(&self.way);
        let has_way = way > 1e-8 * had;
        let inverse = if has_way { 1.0 / way } else { 0.0 };
        scale(&mut self.way, inverse);
        scale(&mut self.way_image, inverse);
        let (b, c) = (dot(&self.mode, &rest_image), dot(&rest, &rest_image));
        let (d, e) = (dot(&self.mode, &self.way_image), dot(&rest, &self.way_image));
        let f = if has_way { dot(&self.way, &self.way_image) } else { -1.0 };
        let eigen = Matrix3::new(self.value, b, d, b, c, e, d, e, f).symmetric_eigen();
        let best = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
        for k in 0..self.mode.len() {
            for c in 0..6 {
                let (way, image) = (
                    best[1] * rest[k][c] + best[2] * self.way[k][c],
                    best[1] * rest_image[k][c] + best[2] * self.way_image[k][c],
                );
                (self.way[k][c], self.way_image[k][c]) = (way, image);
                self.mode[k][c] = best[0] * self.mode[k][c] + way;
                self.image[k][c] = best[0] * self.image[k][c] + image;
            }
        }
        let length = norm(&self.mode);
        scale(&mut self.mode, 1.0 / length);
        scale(&mut self.image, 1.0 / length);
    }
}

fn dot(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (0..6).map(|c| a[c] * b[c]).sum::<f64>()).sum()
}

fn norm(a: &[[f64; 6]]) -> f64 {
    dot(a, a).sqrt()
}

fn scale(a: &mut [[f64; 6]], factor: f64) {
    a.iter_mut().flatten().for_each(|x| *x *= factor);
}

fn add(a: &mut [[f64; 6]], factor: f64, b: &[[f64; 6]]) {
    a.iter_mut().flatten().zip(b.iter().flatten()).for_each(|(a, b)| *a += factor * b);
}

fn largest(mode: &[[f64; 6]]) -> u32 {
    let size = |m: &[f64; 6]| m.iter().map(|x| x * x).sum::<f64>();
    let mut best = (0, -1.0);
    for (place, motion) in mode.iter().enumerate() {
        if size(motion) > best.1 {
            best = (place as u32, size(motion));
        }
    }
    best.0
}
