//! Bubble-pack: a few of the largest balls that fit into a surface, so that their union approximates the surface.
//!
//! Taghavi (2011) takes the maximal inscribed balls of a surface, largest first. He keeps a ball if its radius is at
//! least ρ times the largest radius and if its distance to all kept balls leaves the union no smoother than required.
//! His balls are circumspheres of Delaunay tetrahedra. Here the balls touch the surface at points distributed over it
//! and are shrunk until no other part of the surface is inside them (Ma, Bae and Choi 2012, The Visual Computer 28).
//! Both sets are samples of the medial axis. The largest ball is moved to its place by ascent on the distance to the
//! surface.
//!
//! Smoothness is the angle φ at which two balls meet: with θ the angle between their radii at the common circle, φ =
//! 180° - θ and `d² = r₁² + r₂² + 2 r₁ r₂ cos φ`. Touching balls have 0°; equal balls at φ = 110° are 1.147 r apart. A
//! larger φ allows them to be closer.

use super::super::clump::Pebble;
use super::super::shape::Mesh;
use super::points::{SurfacePoint, on_facets};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Points of the surface at which balls are grown.
const POINTS: usize = 1500;
/// A ball has converged if its radius changes by less than this share.
const AT_REST: f64 = 1e-6;
/// Balls that overlap by less than this share of the smaller radius count as not connected.
const HOLD: f64 = 0.05;
/// Relaxation of the rule until there are enough pebbles: number of steps, and change of ratio and angle per step.
const STEPS: usize = 40;
const NARROWER: f64 = 0.95;
const CLOSER: f64 = 2.0 * PI / 180.0;
/// Balls closer than this angle are practically the same.
const CLOSEST: f64 = 165.0 * PI / 180.0;

/// The rule of bubble-pack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rule {
    /// Smallest and largest number of pebbles.
    pub pebbles: [usize; 2],
    /// Smallest pebble over largest pebble, above 0 to 1.
    pub ratio: f64,
    /// φ, rad, 0 to π: larger is smoother and has more pebbles.
    pub distance: f64,
}

/// Pebbles that fill a surface, largest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Bubbles {
    pub pebbles: Vec<Pebble>,
    /// The ratio and the angle that gave this number: the values of the rule, or relaxed values if the rule gave too
    /// few pebbles.
    pub ratio: f64,
    pub distance: f64,
    /// Number of pebbles by the rule alone, before the limits on the number are applied.
    pub by_rule: usize,
}

impl Bubbles {
    /// Fills a closed surface. Pebbles above the largest number are cut off, smallest first. If the rule gives fewer
    /// pebbles than the smallest number, ratio and angle are relaxed together until there are enough. A surface that is
    /// nearly a ball may still have fewer.
    pub fn fill(surface: &Mesh, rule: &Rule) -> Self {
        let balls = maximal_balls(surface);
        let [fewest, most] = rule.pebbles;
        let (mut ratio, mut distance) = (rule.ratio, rule.distance);
        let mut pebbles = keep(&balls, ratio, distance, usize::MAX);
        let by_rule = pebbles.len();
        for _ in 0..STEPS {
            if pebbles.len() >= fewest {
                break;
            }
            ratio *= NARROWER;
            distance = (distance + CLOSER).min(CLOSEST.max(rule.distance));
            let more = keep(&balls, ratio, distance, fewest);
            if more.len() > pebbles.len() {
                pebbles = more;
            }
        }
        pebbles.truncate(most.max(1));
        Self { pebbles, ratio, distance, by_rule }
    }
}

/// Balls, largest first, that the rule allows together, and that are connected.
fn keep(balls: &[Pebble], ratio: f64, distance: f64, enough: usize) -> Vec<Pebble> {
    let Some(largest) = balls.first() else { return Vec::new() };
    let mut kept = vec![*largest];
    let candidates: Vec<&Pebble> = balls.iter().take_while(|b| b.radius >= ratio * largest.radius).collect();
    // a ball without connection may be connected to a later ball
    loop {
        let before = kept.len();
        for ball in &candidates {
            let clear = kept.iter().all(|other| smoothness(ball, other) <= distance);
            if clear && kept.len() < enough && kept.iter().any(|other| hang_together(ball, other)) {
                kept.push(**ball);
            }
        }
        if kept.len() == before {
            return kept;
        }
    }
}

fn hang_together(a: &Pebble, b: &Pebble) -> bool {
    (a.centre - b.centre).norm() <= a.radius + b.radius - HOLD * a.radius.min(b.radius)
}

/// φ of two balls, rad: 0 if they touch or are apart, π if one is inside the other.
fn smoothness(a: &Pebble, b: &Pebble) -> f64 {
    let square = (a.centre - b.centre).norm_squared();
    let cosine = (square - a.radius.powi(2) - b.radius.powi(2)) / (2.0 * a.radius * b.radius);
    cosine.clamp(-1.0, 1.0).acos()
}

/// Maximal inscribed balls of a surface, largest first.
fn maximal_balls(surface: &Mesh) -> Vec<Pebble> {
    // no ball inside is larger than the surface
    let [low, high] = surface.bounds();
    let widest = 0.5 * (high - low).min();
    let grow = |point: &SurfacePoint| shrunk(surface, &point.at, &-point.normal, widest);
    let mut balls: Vec<Pebble> = on_facets(surface, POINTS).iter().filter_map(grow).collect();
    let order = |a: &Pebble, b: &Pebble| b.radius.total_cmp(&a.radius);
    balls.sort_by(order);
    if let Some(largest) = balls.first().map(|ball| ascended(surface, ball)) {
        balls.insert(0, largest);
    }
    balls
}

/// The largest ball that touches the surface from inside at a point. While another part of the surface is inside the
/// ball, the ball is shrunk until it touches that part. A ball that also touches q has the radius |q - p|²/2n·(q - p).
fn shrunk(surface: &Mesh, point: &Vector3<f64>, inward: &Vector3<f64>, start: f64) -> Option<Pebble> {
    let mut radius = start;
    loop {
        let centre = point + inward * radius;
        let Some(nearest) = surface.nearest(&centre, radius * (1.0 - AT_REST)) else {
            return Some(Pebble { centre, radius });
        };
        let apart = nearest.at - point;
        let smaller = apart.norm_squared() / (2.0 * inward.dot(&apart));
        if !(smaller > 0.0 && smaller < radius * (1.0 - AT_REST)) {
            // the point itself is nearest, or lies in a fold
            return (nearest.distance > 0.0 && surface.contains(&centre))
                .then_some(Pebble { centre, radius: nearest.distance });
        }
        radius = smaller;
    }
}

/// A ball moved to the place where the nearest surface is as far away as possible: steps along the axes and the
/// diagonals, halved if no step increases the distance.
fn ascended(surface: &Mesh, ball: &Pebble) -> Pebble {
    let mut best = *ball;
    let mut step = 0.25 * ball.radius;
    while step > AT_REST * ball.radius {
        let directions =
            (0..27).filter(|k| *k != 13).map(|k| Vector3::new(k % 3, k / 3 % 3, k / 9).map(|c| f64::from(c) - 1.0));
        let better = directions.map(|d| best.centre + d.normalize() * step).find_map(|centre| {
            let radius = surface.nearest(&centre, f64::MAX.sqrt())?.distance;
            (radius > best.radius && surface.contains(&centre)).then_some(Pebble { centre, radius })
        });
        match better {
            Some(larger) => best = larger,
            None => step *= 0.5,
        }
    }
    best
}
