//! Limits by the contacts of one body at a time.
//!
//! For a spring between two bodies and any share s > 0, |u1 - u2|^2 <= (1 + s) |u1|^2 + (1 + 1/s) |u2|^2. So take each
//! body with its neighbours fixed and its contacts counted (1 + s) times: the smallest limit of all bodies is a step
//! that is never too long. s = 1 is the row sum. s = D2/D1, with the stiffness of each body over its inertia, is
//! sharper, and exact for an isolated pair of bodies (Merris 1998, for the largest eigenvalue of a graph).

use super::super::vector::dot;
use super::limit::{Pencil, step};
use super::links::{Link, Roots};
use nalgebra::{SVector, Vector3};
use rayon::prelude::*;

/// Bodies of one task. The number is fixed, so that the number of threads does not change the results.
const CHUNK: usize = 512;

/// Links of each body.
#[derive(Debug, Clone)]
pub struct Around {
    start: Vec<u32>,
    links: Vec<u32>,
}

impl Around {
    pub fn new(links: &[Link], bodies: usize) -> Around {
        let mut start = vec![0u32; bodies + 1];
        links.iter().flat_map(Link::ends).for_each(|(_, body)| start[body as usize + 1] += 1);
        (0..bodies).for_each(|b| start[b + 1] += start[b]);
        let mut next = start.clone();
        let mut list = vec![0; start[bodies] as usize];
        for (number, link) in links.iter().enumerate() {
            for (_, body) in link.ends() {
                list[next[body as usize] as usize] = number as u32;
                next[body as usize] += 1;
            }
        }
        Around { start, links: list }
    }

    pub fn links_of(&self, body: usize) -> &[u32] {
        &self.links[self.start[body] as usize..self.start[body + 1] as usize]
    }

    /// The links of a body among all.
    pub fn pick<'a>(&'a self, body: usize, links: &'a [Link]) -> impl Iterator<Item = &'a Link> {
        self.links_of(body).iter().map(|&number| &links[number as usize])
    }
}

/// How many times a contact between bodies counts for each of them.
#[derive(Debug, Clone, Copy)]
pub enum Weight<'a> {
    /// Equally for both.
    Even(f64),
    /// By the stiffness over inertia of each body.
    Shared(&'a [f64]),
}

impl Weight<'_> {
    fn count(&self, body: usize, other: u32) -> f64 {
        match self {
            _ if other == super::links::GROUND => 1.0,
            Weight::Even(weight) => *weight,
            Weight::Shared(own) if own[body] > 0.0 => 1.0 + own[other as usize] / own[body],
            Weight::Shared(_) => 2.0,
        }
    }
}

/// Stiffness and dashpots of a body with fixed neighbours; `links` are all links of the body.
pub fn pencil<'a>(body: usize, root: &Roots, links: impl IntoIterator<Item = &'a Link>, weight: Weight) -> Pencil {
    let mut sum = Pencil::zero();
    for link in links {
        // a body may touch its own image in a small period
        for (end, _) in link.ends().filter(|&(_, b)| b as usize == body) {
            let share = weight.count(body, link.bodies[1 - end]);
            let arm = Vector3::from(link.arms[end]);
            let row = |direction: Vector3<f64>| {
                let turn = root.rotation * arm.cross(&direction);
                let go = direction * root.translation;
                SVector::<f64, 6>::new(go.x, go.y, go.z, turn.x, turn.y, turn.z)
            };
            let t = &link.tangent;
            let mut put = |direction: Vector3<f64>, stiffness: f64, dashpot: f64| {
                let row = row(direction);
                sum.stiffness.ger(share * stiffness, &row, &row, 1.0);
                sum.dashpots.ger(share * dashpot, &row, &row, 1.0);
            };
            let normal = Vector3::from(link.normal);
            put(normal, t.normal - t.shear, t.normal_dashpot - t.shear_dashpot);
            [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().for_each(|d| put(d, t.shear, t.shear_dashpot));
        }
    }
    sum
}

/// Whether the traces alone show that a step is stable for a body with fixed neighbours: no eigenvalue exceeds the
/// trace. It costs a tenth of [`pencil`], and is sufficient for most grains of a bed.
pub fn surely_allows<'a>(
    body: usize,
    root: &Roots,
    links: impl IntoIterator<Item = &'a Link>,
    weight: Weight,
    step: f64,
) -> bool {
    let (go, turn) = (root.translation * root.translation, root.widest_turn().powi(2));
    let (mut stiffness, mut dashpots) = (0.0, 0.0);
    for link in links {
        for (end, _) in link.ends().filter(|&(_, b)| b as usize == body) {
            let share = weight.count(body, link.bodies[1 - end]);
            let lever = turn * dot(link.arms[end], link.arms[end]);
            // shear stiffness in three directions, the rest of the normal stiffness in one; an arm turns about two axes
            let all = |normal: f64, shear: f64| {
                share * ((normal - shear).max(0.0) * (go + lever) + shear * (3.0 * go + 2.0 * lever))
            };
            stiffness += all(link.tangent.normal, link.tangent.shear);
            dashpots += all(link.tangent.normal_dashpot, link.tangent.shear_dashpot);
        }
    }
    // slightly less than 4, for rounding
    step * (step * stiffness + 2.0 * dashpots) < 3.999
}

/// Stiffness of every body by its own contacts, divided by its inertia: a scale from the traces at one step for all
/// bodies.
pub fn own(links: &[Link], roots: &[Roots], around: &Around) -> Vec<f64> {
    let traces = |body| {
        let pencil = pencil(body, &roots[body], around.pick(body, links), Weight::Even(1.0));
        (pencil.stiffness.trace(), pencil.dashpots.trace())
    };
    let all: Vec<_> = (0..roots.len()).into_par_iter().with_min_len(CHUNK).map(traces).collect();
    let dt = all.iter().map(|&(a, b)| step(a, b)).fold(f64::INFINITY, f64::min);
    if !dt.is_finite() {
        return vec![0.0; roots.len()];
    }
    all.into_iter().map(|(a, b)| dt * dt * a + 2.0 * dt * b).collect()
}

/// The bound: the smallest limit of a body, and the index of this body.
pub fn bound(links: &[Link], roots: &[Roots], around: &Around) -> (f64, Option<u32>) {
    let own = own(links, roots, around);
    let worst = |chunk: usize| {
        let mut worst = (f64::INFINITY, None);
        for (body, root) in roots.iter().enumerate().skip(chunk * CHUNK).take(CHUNK) {
            let pencil = pencil(body, root, around.pick(body, links), Weight::Shared(&own));
            if worst.1.is_none() || !pencil.allows(worst.0) {
                let limit = pencil.limit();
                if limit < worst.0 {
                    worst = (limit, Some(body as u32));
                }
            }
        }
        worst
    };
    least((0..roots.len().div_ceil(CHUNK)).into_par_iter().map(worst).collect())
}

/// PFC's estimate without its safety factor, and the index of the body that sets it.
pub fn estimate(links: &[Link], roots: &[Roots], around: &Around) -> (f64, Option<u32>) {
    let of = |body: usize| {
        let root = &roots[body];
        let mut stiffness = SVector::<f64, 6>::zeros();
        for link in around.pick(body, links) {
            let t = &link.tangent;
            let [along, across] = [(t.normal, t.normal_dashpot), (t.shear, t.shear_dashpot)].map(|(k, c)| {
                if k == 0.0 {
                    return 0.0;
                }
                let ratio = c / (2.0 * (link.mass * k).sqrt());
                k / ((1.0 + ratio * ratio).sqrt() - ratio).powi(2)
            });
            for (end, _) in link.ends().filter(|&(_, b)| b as usize == body) {
                let (normal, arm) = (Vector3::from(link.normal), Vector3::from(link.arms[end]));
                let turn = |d: Vector3<f64>| root.rotation * arm.cross(&d);
                let add = |d: Vector3<f64>, k: f64, sum: &mut SVector<f64, 6>| {
                    let (go, turn) = (d * root.translation, turn(d));
                    (0..3).for_each(|c| {
                        sum[c] += k * go[c] * go[c];
                        sum[3 + c] += k * turn[c] * turn[c];
                    });
                };
                add(normal, along - across, &mut stiffness);
                [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().for_each(|d| add(d, across, &mut stiffness));
            }
        }
        1.0 / stiffness.max().sqrt()
    };
    let each: Vec<f64> = (0..roots.len()).into_par_iter().with_min_len(CHUNK).map(of).collect();
    least(each.into_iter().zip(0..).map(|(step, body)| (step, Some(body))).collect())
}

fn least(steps: Vec<(f64, Option<u32>)>) -> (f64, Option<u32>) {
    steps.into_iter().filter(|s| s.0.is_finite()).fold((f64::INFINITY, None), |a, b| if b.0 < a.0 { b } else { a })
}
