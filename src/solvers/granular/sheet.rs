//! A deformable floor: bilinear facets of a regular grid; its corners move with the soil below.
//!
//! A grain touches the facet under it. The contact point lies on the facet, with the weights N of the corners. So
//! `v = sum N_i v_i` is the velocity of the floor at the grain and `f_i = N_i F` are the forces on the corners: force,
//! moment and power are equal on both sides (methods 3). Weights are computed from the initial positions of the
//! corners: displacements are small compared with a facet.

use super::shape::Touch;
use super::vector::{Vec3, add, dot, norm, scale, sub};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The corners of a floor, in the order of their grid: along x first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// Lines of the grid along x and y, from the origin of the wall, increasing, m.
    lines: [Vec<f64>; 2],
    corners: Vec<Corner>,
    /// Forces of the contacts at the start of the last step, N, and sums of their normal stiffnesses by `N^2`, N/m.
    forces: Vec<Vec3>,
    stiffnesses: Vec<f64>,
    /// Displacements when the lists were made, m.
    listed: Vec<Vec3>,
}

/// A corner of a deformable floor.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Corner {
    /// Displacement from the initial position, m.
    pub displacement: Vec3,
    /// Velocity in the next step, m/s.
    pub velocity: Vec3,
}

/// A facet, and the weights of its corners at a position.
type Weights = [(usize, f64); 4];

impl Sheet {
    /// A flat floor at rest over a grid; `None` if the grid has no facet.
    pub fn flat(x: Vec<f64>, y: Vec<f64>) -> Option<Sheet> {
        let grows = |lines: &[f64]| lines.len() > 1 && lines.windows(2).all(|pair| pair[0] < pair[1]);
        if !(grows(&x) && grows(&y)) {
            return None;
        }
        let count = x.len() * y.len();
        Some(Sheet {
            lines: [x, y],
            corners: vec![Corner::default(); count],
            forces: vec![[0.0; 3]; count],
            stiffnesses: vec![0.0; count],
            listed: vec![[0.0; 3]; count],
        })
    }

    /// Its corners, along x first.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Its corners, for moving them.
    pub fn corners_mut(&mut self) -> &mut [Corner] {
        &mut self.corners
    }

    /// Force of the grains on each corner at the start of the last step, N.
    pub fn forces(&self) -> &[[f64; 3]] {
        &self.forces
    }

    /// Stiffness that the contacts of the last step add to each corner, N/m.
    pub fn stiffnesses(&self) -> &[f64] {
        &self.stiffnesses
    }

    /// Position of a corner in the plan, from the origin of the wall, m.
    pub fn place(&self, corner: usize) -> [f64; 2] {
        let columns = self.lines[0].len();
        [self.lines[0][corner % columns], self.lines[1][corner / columns]]
    }

    // No closures from here to `velocity_at`: they would be called as functions where lanes are in use.

    /// The facet over which a position lies, and the share of the position along x and y, from 0 to 1; beyond the
    /// border the nearest facet.
    #[inline(always)]
    fn facet(&self, place: Vec3) -> ([usize; 2], [f64; 2], [f64; 2]) {
        let (mut cells, mut shares, mut sizes) = ([0; 2], [0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let lines = &self.lines[axis];
            let cell = interval(lines, place[axis]);
            let size = lines[cell + 1] - lines[cell];
            cells[axis] = cell;
            shares[axis] = ((place[axis] - lines[cell]) / size).clamp(0.0, 1.0);
            sizes[axis] = size;
        }
        (cells, shares, sizes)
    }

    #[inline(always)]
    fn corner_numbers(&self, [i, j]: [usize; 2]) -> [usize; 4] {
        let first = j * self.lines[0].len() + i;
        [first, first + 1, first + self.lines[0].len(), first + self.lines[0].len() + 1]
    }

    #[inline(always)]
    fn weights(&self, place: Vec3) -> Weights {
        let (cell, [u, v], _) = self.facet(place);
        let [a, b, c, d] = self.corner_numbers(cell);
        [(a, (1.0 - u) * (1.0 - v)), (b, u * (1.0 - v)), (c, (1.0 - u) * v), (d, u * v)]
    }

    /// Contact point of a sphere of radius `reach` with the facet under its centre, m from the origin of the wall.
    #[inline(always)]
    pub(super) fn touch(&self, centre: Vec3, reach: f64) -> Option<Touch> {
        let (cell, [u, v], [along, across]) = self.facet(centre);
        let corners = self.corner_numbers(cell);
        let mut levels = [0.0; 4];
        for (level, corner) in levels.iter_mut().zip(corners) {
            *level = self.corners[corner].displacement[2];
        }
        let [a, b, c, d] = levels;
        let level = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
        let slope_x = ((1.0 - v) * (b - a) + v * (d - c)) / along;
        let slope_y = ((1.0 - u) * (c - a) + u * (d - b)) / across;
        let upward = Vector3::new(-slope_x, -slope_y, 1.0).normalize();
        let distance = (centre[2] - level) * upward.z;
        if distance < reach { Some(Touch { normal: upward, distance, feature: 0 }) } else { None }
    }

    /// Velocity of the floor at a position, m/s.
    #[inline(always)]
    pub(super) fn velocity_at(&self, place: Vec3) -> Vec3 {
        let mut velocity = [0.0; 3];
        for (corner, weight) in self.weights(place) {
            velocity = add(velocity, scale(self.corners[corner].velocity, weight));
        }
        velocity
    }

    /// Clears the forces of the step before.
    pub(super) fn unload(&mut self) {
        self.forces.fill([0.0; 3]);
        self.stiffnesses.fill(0.0);
    }

    /// Adds the force (N) of a contact with a stiffness (N/m) at a position.
    pub(super) fn load(&mut self, place: Vec3, force: Vec3, stiffness: f64) {
        for (corner, weight) in self.weights(place) {
            self.forces[corner] = add(self.forces[corner], scale(force, weight));
            self.stiffnesses[corner] += weight * weight * stiffness;
        }
    }

    /// Stores the present displacements, from which the reach of the lists counts.
    pub(super) fn remember(&mut self) {
        self.listed = self.corners.iter().map(|corner| corner.displacement).collect();
    }

    /// The largest displacement of a corner since the lists were made, m.
    pub(super) fn moved(&self) -> f64 {
        let moves =
            self.corners.iter().zip(&self.listed).map(|(corner, before)| norm(sub(corner.displacement, *before)));
        moves.fold(0.0, f64::max)
    }

    /// Largest speed of a corner, m/s.
    pub(super) fn fastest(&self) -> f64 {
        self.corners.iter().map(|corner| norm(corner.velocity)).fold(0.0, f64::max)
    }

    /// Work of the floor on the grains in a step of `dt` (s), by the mean of the present forces and the forces `before`
    /// (N), J.
    pub(super) fn work(&self, before: &[Vec3], dt: f64) -> f64 {
        let parts = self.corners.iter().zip(self.forces.iter().zip(before));
        let power = parts.map(|(corner, (now, before))| dot(add(*now, *before), corner.velocity));
        -0.5 * dt * power.fold(0.0, |sum, part| sum + part)
    }
}

/// The interval between increasing lines that contains `x`; beyond the lines, the first or the last. Lines of a mesh
/// are nearly even, so the search starts at the interval for even lines.
#[inline(always)]
fn interval(lines: &[f64], x: f64) -> usize {
    let last = lines.len() - 2;
    let share = (x - lines[0]) / (lines[last + 1] - lines[0]);
    let mut cell = ((share * (last + 1) as f64) as usize).min(last);
    while cell < last && lines[cell + 1] <= x {
        cell += 1;
    }
    while cell > 0 && lines[cell] > x {
        cell -= 1;
    }
    cell
}

#[cfg(test)]
mod tests {
    use super::super::law::{ContactLaw, Dashpot, DashpotMode, FrictionLimit, Linear};
    use super::super::{Bed, ContactLaws, Domain, Failure, Gravity, Sphere, WallId};
    use super::*;

    const STIFFNESS: f64 = 5e6;

    #[test]
    fn an_interval_is_found_wherever_lines_are() {
        for lines in [vec![0.0, 1.0], vec![-1.0, -0.9, 0.0, 5.0, 5.1], (0..50).map(|k| 0.2 * f64::from(k)).collect()] {
            let mut places: Vec<f64> = lines.iter().flat_map(|x| [x - 1e-9, *x, x + 1e-9]).collect();
            places.extend([f64::NEG_INFINITY, -3.0, 0.33, 7.7, 1e9, f64::INFINITY]);
            for x in places {
                let sought = lines.partition_point(|line| *line <= x).clamp(1, lines.len() - 1) - 1;
                assert_eq!(interval(&lines, x), sought, "{x} in {lines:?}");
            }
        }
    }

    fn lines(count: usize, size: f64) -> Vec<f64> {
        (0..=count).map(|line| line as f64 * size).collect()
    }

    /// Some spheres over a floor of four facets, each with a mass at every corner on a spring.
    fn bed(damping: f64) -> (Bed<f64>, WallId) {
        let law = ContactLaw::Linear(Linear {
            normal_stiffness: STIFFNESS,
            shear_stiffness: STIFFNESS,
            friction: 0.5,
            dashpot: Dashpot::Ratio { normal: damping, shear: 0.0 },
            mode: DashpotMode::default(),
            limit: FrictionLimit::default(),
        });
        let mut bed = Bed::new(Domain::open(), ContactLaws::single(law));
        let floor = bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.soften(floor, Sheet::flat(lines(2, 0.1), lines(2, 0.1)).unwrap());
        for (k, x) in [0.03, 0.08, 0.14].into_iter().enumerate() {
            let centre = [x, 0.05 + 0.03 * k as f64, 0.025];
            let body = bed.add_sphere(&Sphere { centre, radius: 0.025, density: 2700.0, surface: 0 });
            bed.set_velocity(body, [0.3, -0.1, -0.5], [0.0, 3.0, 0.0]);
        }
        bed.set_time_step(1e-5);
        (bed, floor)
    }

    /// Nodes of mass (kg) under the corners, on springs (N/m) to the ground.
    fn ride(bed: &mut Bed<f64>, floor: WallId, [mass, spring]: [f64; 2]) -> Result<(), Failure> {
        bed.guided_step(|guided| {
            let dt = guided.dt;
            let sheet = guided.sheet(floor).expect("a floor that moves");
            let forces = sheet.forces().to_vec();
            for (corner, force) in sheet.corners_mut().iter_mut().zip(forces) {
                let Corner { displacement, velocity } = corner;
                for ((u, v), f) in displacement.iter_mut().zip(velocity).zip(force) {
                    *v += dt * (f - spring * *u) / mass;
                    *u += dt * *v;
                }
            }
            Ok(())
        })
    }

    /// The momentum of grains and corners is constant to rounding, and so is the angular momentum about an axis; the
    /// energy of both to second order.
    #[test]
    fn force_moment_and_power_are_the_same_on_both_sides() {
        let run = |dt: f64| {
            let (mut bed, floor) = bed(0.0);
            bed.watch_energy(true);
            bed.set_time_step(dt);
            let steps = (0.02 / dt).round() as usize;
            let mut work = 0.0;
            let mut last = vec![[0.0; 3]; 9];
            for _ in 0..steps {
                let before = bed.energy().walls;
                ride(&mut bed, floor, [0.4, 0.0]).unwrap();
                work += bed.energy().walls - before;
                last.copy_from_slice(bed.wall(floor).sheet().unwrap().forces());
            }
            let corners = bed.wall(floor).sheet().unwrap().corners().to_vec();
            let grains: Vec<_> = bed.states().collect();
            let momentum = |axis: usize| {
                grains.iter().map(|g| g.mass * g.velocity[axis]).sum::<f64>()
                    + corners.iter().map(|c| 0.4 * c.velocity[axis]).sum::<f64>()
            };
            let mass: f64 = grains.iter().map(|g| g.mass).sum();
            for (axis, start) in [0.3, -0.1, -0.5].into_iter().enumerate() {
                assert!((momentum(axis) / (mass * start) - 1.0).abs() < 1e-11, "{axis}: {}", momentum(axis));
            }
            let kinetic: f64 = corners.iter().map(|c| 0.5 * 0.4 * dot(c.velocity, c.velocity)).sum();
            (bed.energy().residual().abs(), (kinetic + work).abs(), kinetic)
        };
        let ((coarse, _, kinetic), (fine, gap, _)) = (run(2e-5), run(1e-5));
        assert!(kinetic > 1e-4, "the floor moves: {kinetic} J");
        assert!(coarse / fine > 3.0, "of second order: {coarse} and {fine} J");
        assert!(gap < 1e-3 * kinetic, "{gap} of {kinetic} J");
    }

    /// The weight of a grain at rest is carried by the corners of its facet, by their weights.
    #[test]
    fn a_grain_at_rest_presses_on_the_corners_around_it() {
        let (mut bed, floor) = bed(0.5);
        (0..3).for_each(|body| bed.set_velocity(super::super::BodyId(body), [0.0; 3], [0.0; 3]));
        bed.set_gravity(Gravity::EARTH);
        bed.set_damping(0.3);
        for _ in 0..40_000 {
            ride(&mut bed, floor, [0.4, 1e6]).unwrap();
        }
        let weight: f64 = bed.states().map(|state| state.mass * 9.81).sum();
        let sheet = bed.wall(floor).sheet().unwrap();
        let carried: f64 = sheet.forces().iter().map(|force| -force[2]).sum();
        assert!((carried / weight - 1.0).abs() < 1e-3, "{carried} of {weight} N");
        // moments about both axes of the plan
        for axis in 0..2 {
            let moment: f64 = (0..9).map(|c| -sheet.forces()[c][2] * sheet.place(c)[axis]).sum();
            let of_grains: f64 = bed.states().map(|state| state.mass * 9.81 * state.place[axis]).sum();
            assert!((moment / of_grains - 1.0).abs() < 2e-3, "{moment} of {of_grains} N m");
        }
    }

    #[test]
    fn a_grid_without_a_facet_is_no_floor() {
        assert!(Sheet::flat(vec![0.0], vec![0.0, 1.0]).is_none());
        assert!(Sheet::flat(vec![0.0, 0.0], vec![0.0, 1.0]).is_none());
        assert!(Sheet::flat(vec![0.0, 1.0], vec![0.0, 1.0]).is_some());
    }
}
