//! Coordination and stress, from the contacts of a bed.

use super::Region;
use nalgebra::{Matrix3, Vector3};

/// Coordination: number of neighbours of the bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordination {
    /// Mean number of neighbours of all bodies.
    pub mean: f64,
    /// Mean number of neighbours of bodies that are not rattlers: the mechanical coordination number of Thornton
    /// (2000), Géotechnique 50, 43-53, `(2 C - N₁)/(N - N₀ - N₁)`. 0 if all are rattlers.
    pub without_rattlers: f64,
    /// Bodies with fewer than two neighbours.
    pub rattlers: usize,
    /// Number of pairs of bodies in contact, each counted once; for a part of the bodies, half of their contacts.
    pub pairs: usize,
}

/// Number of neighbours of each of `bodies` bodies. `pairs` are the touching pairs, in any order; a pair may occur
/// several times, once per pebble contact. A body is not its own neighbour. Walls do not count: pairs that name a body
/// beyond the last are left out.
pub fn neighbours(bodies: usize, pairs: &[(u32, u32)]) -> Vec<u32> {
    let inside = |(i, j): &(u32, u32)| i != j && (*i as usize) < bodies && (*j as usize) < bodies;
    let mut distinct: Vec<_> = pairs.iter().filter(|p| inside(p)).map(|(i, j)| (*i.min(j), *i.max(j))).collect();
    distinct.sort_unstable();
    distinct.dedup();
    let mut neighbours = vec![0u32; bodies];
    for (i, j) in &distinct {
        neighbours[*i as usize] += 1;
        neighbours[*j as usize] += 1;
    }
    neighbours
}

/// Coordination of `bodies` bodies with these touching pairs, see [`neighbours`]. 0 if there are no bodies.
pub fn coordination(bodies: usize, pairs: &[(u32, u32)]) -> Coordination {
    Coordination::from_neighbours(&neighbours(bodies, pairs))
}

impl Coordination {
    /// Coordination of bodies from their numbers of neighbours, for all bodies or for a part, whose neighbours may be
    /// outside the part.
    pub fn from_neighbours(neighbours: &[u32]) -> Coordination {
        let held: Vec<_> = neighbours.iter().filter(|n| **n >= 2).collect();
        let [all, links] = [neighbours.iter().sum::<u32>(), held.iter().copied().sum()];
        Coordination {
            mean: f64::from(all) / neighbours.len().max(1) as f64,
            without_rattlers: f64::from(links) / held.len().max(1) as f64,
            rattlers: neighbours.len() - held.len(),
            pairs: all as usize / 2,
        }
    }
}

/// A contact of body i with body j or with a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// On body i, N.
    pub force: [f64; 3],
    /// From the centroid of j, or from the contact point at a wall, to the centroid of i, m.
    pub branch: [f64; 3],
    /// m.
    pub point: [f64; 3],
}

/// Mean stress of a region, Pa, tension positive: `σ = -(1/V) Σ F ⊗ L` with F on body i and L from j to i, over the
/// contacts whose point lies inside (Christoffersen, Mehrabadi, Nemat-Nasser 1981, J. Appl. Mech. 48, 339-344). Row:
/// component of the force.
///
/// It is exact for a region that holds whole bodies in equilibrium and the contacts between them. At a border that cuts
/// through bodies, a contact counts completely or not at all.
pub fn stress(region: &Region, contacts: impl IntoIterator<Item = Contact>) -> Matrix3<f64> {
    let inside = contacts.into_iter().filter(|c| region.holds(&c.point));
    let sum: Matrix3<f64> = inside.map(|c| Vector3::from(c.force) * Vector3::from(c.branch).transpose()).sum();
    sum / -region.volume()
}
