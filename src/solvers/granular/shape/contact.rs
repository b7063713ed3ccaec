//! Contacts of a sphere with a mesh: local minima of the distance, each counted once.
//!
//! With c the centre, an edge point q is a minimum if (c - q).t <= 0 for the directions t into the adjacent facets; a
//! corner is a minimum if (c - q).u <= 0 along all edges from the corner. Each test has a slack above rounding, so that
//! no point falls between two tests. If two tests find the same contact it counts once, face before edge before corner.

use super::mesh::Mesh;
use super::topology::{Facet, NONE};
use super::touch::Touch;
use super::triangles::MeshKind;
use nalgebra::Vector3;

/// Slack of a test, as a share of the largest coordinate.
const SLACK: f64 = 1e-12;

/// Centres nearer than this, in units of the slack, lie on the surface: the direction from the surface to the centre is
/// only rounding.
const ON_SURFACE: f64 = 1e3;

/// Contacts whose normals differ by less than this angle (as cosine; 2.6 degrees) are one contact. In a valley with an
/// angle a, the second face comes into contact with the overlap d - r a^2/2 at once, if d is the overlap of the first
/// face. This is a jump if a < sqrt(2 d/r); the angle here is this limit for d = r/1000.
const ONE_DIRECTION: f64 = 0.999;

/// Largest distance between two borders that still count as joined, as a share of the largest coordinate: above the
/// rounding of files in single precision.
const JOINED: f64 = 1e-6;

impl Mesh {
    pub(super) fn near(&self, centre: &Vector3<f64>, reach: f64, facets: &mut Vec<u32>) -> bool {
        let reach = reach + self.slack(centre);
        let square = reach * reach;
        let enter = |low: &Vector3<f64>, high: &Vector3<f64>| {
            let outside = (low - centre).sup(&(centre - high)).sup(&Vector3::zeros());
            outside.norm_squared() <= square
        };
        self.tree.search(enter, |facet| {
            if distance_squared(&self.surface.facets[facet as usize], centre) <= square {
                facets.push(facet);
            }
        });
        !facets.is_empty()
    }

    pub(super) fn touches(&self, centre: &Vector3<f64>, reach: f64, facets: &[u32], out: &mut Vec<Touch>) {
        let slack = self.slack(centre);
        self.faces(centre, reach, slack, facets, out);
        self.edges(centre, reach, slack, facets, out);
        self.corners(centre, reach, slack, facets, out);
        distinct(out, ON_SURFACE * slack);
    }

    fn slack(&self, centre: &Vector3<f64>) -> f64 {
        SLACK * (self.extent + centre.amax())
    }

    fn faces(&self, centre: &Vector3<f64>, reach: f64, slack: f64, facets: &[u32], out: &mut Vec<Touch>) {
        for &feature in facets {
            let facet = &self.surface.facets[feature as usize];
            let height = facet.height(centre);
            if height.abs() < reach && facet.sides(centre).iter().all(|s| *s >= -slack) && !has(out, feature) {
                let side = if self.kind == MeshKind::TwoSided { 1.0f64.copysign(height) } else { 1.0 };
                out.push(Touch { normal: facet.normal * side, distance: height * side, feature });
            }
        }
    }

    fn edges(&self, centre: &Vector3<f64>, reach: f64, slack: f64, facets: &[u32], out: &mut Vec<Touch>) {
        for &number in facets {
            let facet = &self.surface.facets[number as usize];
            if facet.height(centre).abs() >= reach || has(out, number) {
                continue;
            }
            for &edge_number in &facet.edges {
                let edge = &self.surface.edges[edge_number as usize];
                if edge.flat {
                    continue;
                }
                let from_first = centre - edge.ends[0];
                let along = from_first.dot(&edge.direction);
                let between = along > -slack && (centre - edge.ends[1]).dot(&edge.direction) < slack;
                let minimum = edge.inward.iter().all(|t| from_first.dot(t) <= slack);
                let feature = self.surface.edge_feature(edge_number);
                let known = || has(out, feature) || edge.facets.iter().any(|f| has(out, *f));
                if !between || !minimum || known() {
                    continue;
                }
                let away = from_first - edge.direction * along;
                let border = edge.facets[1] == NONE;
                if !(border && self.goes_on(centre, &away, facets)) {
                    out.extend(self.sharp(away, reach, &edge.normal, border, feature));
                }
            }
        }
    }

    fn corners(&self, centre: &Vector3<f64>, reach: f64, slack: f64, facets: &[u32], out: &mut Vec<Touch>) {
        for &number in facets {
            let facet = &self.surface.facets[number as usize];
            if facet.height(centre).abs() >= reach || has(out, number) {
                continue;
            }
            for &corner_number in &facet.corners {
                let corner = &self.surface.corners[corner_number as usize];
                let away = centre - corner.place;
                let feature = self.surface.corner_feature(corner_number);
                if corner.flat || away.norm_squared() >= reach * reach || has(out, feature) {
                    continue;
                }
                let spokes = &self.surface.spokes[corner.spokes[0] as usize..corner.spokes[1] as usize];
                let minimum = spokes.iter().all(|spoke| away.dot(&spoke.direction) <= slack);
                let known = || {
                    spokes.iter().any(|spoke| {
                        let beside = self.surface.edges[spoke.edge as usize].facets;
                        has(out, self.surface.edge_feature(spoke.edge)) || beside.iter().any(|f| has(out, *f))
                    })
                };
                if minimum && !known() && !(corner.border && self.goes_on(centre, &away, facets)) {
                    out.extend(self.sharp(away, reach, &corner.normal, corner.border, feature));
                }
            }
        }
    }

    /// Whether the surface continues from a point of its border, `away` from the centre, to points nearer to the
    /// centre: by a facet that does not share the corners there, but divides the common line in another way.
    fn goes_on(&self, centre: &Vector3<f64>, away: &Vector3<f64>, facets: &[u32]) -> bool {
        let (place, joined) = (centre - away, JOINED * self.extent);
        let nearer = away.norm_squared() - self.slack(centre).powi(2);
        facets
            .iter()
            .map(|facet| &self.surface.facets[*facet as usize])
            .any(|facet| distance_squared(facet, &place) <= joined * joined && distance_squared(facet, centre) < nearer)
    }

    /// Contact with an edge or corner; `away` is the vector from there to the centre.
    fn sharp(
        &self,
        away: Vector3<f64>,
        reach: f64,
        normal: &Vector3<f64>,
        border: bool,
        feature: u32,
    ) -> Option<Touch> {
        let distance = away.norm();
        if distance >= reach {
            return None;
        }
        let both_sides = border || self.kind == MeshKind::TwoSided;
        let side = if both_sides || away.dot(normal) >= 0.0 { 1.0 } else { -1.0 };
        let direction = if distance > 0.0 { away * (side / distance) } else { normal.normalize() };
        Some(Touch { normal: direction, distance: distance * side, feature })
    }
}

impl Facet {
    /// Height of a point above the plane.
    fn height(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(&(point - self.places[0]))
    }

    /// Distance of a point inward from each edge.
    fn sides(&self, point: &Vector3<f64>) -> [f64; 3] {
        [0, 1, 2].map(|k| self.inward[k].dot(&(point - self.places[k])))
    }
}

fn has(touches: &[Touch], feature: u32) -> bool {
    touches.iter().any(|touch| touch.feature == feature)
}

/// If the centre lies inside or on the surface, keeps the contact towards the outside. Otherwise keeps the contacts in
/// front, nearest first, one per direction.
fn distinct(out: &mut Vec<Touch>, on_surface: f64) {
    out.sort_unstable_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()).then(a.feature.cmp(&b.feature)));
    if out.first().is_some_and(|nearest| nearest.distance <= on_surface) {
        out.truncate(1);
    }
    let mut kept = 0;
    for at in 0..out.len() {
        let touch = out[at];
        let in_front = at == 0 || touch.distance > 0.0;
        if in_front && out[..kept].iter().all(|other| other.normal.dot(&touch.normal) <= ONE_DIRECTION) {
            out[kept] = touch;
            kept += 1;
        }
    }
    out.truncate(kept);
}

/// Squared distance from a point to the nearest point of a facet, m2.
fn distance_squared(facet: &Facet, point: &Vector3<f64>) -> f64 {
    let sides = facet.sides(point);
    if sides.iter().all(|s| *s >= 0.0) {
        return facet.height(point).powi(2);
    }
    // the nearest point lies on an edge that faces the point
    let mut least = f64::INFINITY;
    for k in (0..3).filter(|k| sides[*k] < 0.0) {
        let (start, along) = (facet.places[k], facet.places[(k + 1) % 3] - facet.places[k]);
        let share = ((point - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        least = least.min((point - start - along * share).norm_squared());
    }
    least
}
