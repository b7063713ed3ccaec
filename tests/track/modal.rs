//! Linear tracks by their modes: matrices assembled here from the model, a dense generalised eigenproblem, and
//! solutions that are exact in time.
//!
//! Unknowns are deflection and slope of every rail node and then the sleepers, all supports closed, held unknowns taken
//! out.

use nalgebra::{DMatrix, DVector, Matrix4, RowVector4, SymmetricEigen};
use trackbed::solvers::track::*;

pub struct Modes {
    pub nodes: Vec<f64>,
    elements: Vec<Element>,
    /// Of all unknowns, held ones as zero rows.
    pub stiffness: DMatrix<f64>,
    /// rad/s, ascending.
    pub frequencies: Vec<f64>,
    /// Mass-normalised, over all unknowns.
    shapes: DMatrix<f64>,
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    free: Vec<usize>,
}

/// An element of length h: the polynomials of the unloaded beam for unit displacements of its ends.
///
/// `w = a0 + a1 x + a2 x² + a3 x³` and, as the shear force is `κGA (w' - θ) = -EI θ''`, `θ = w' + EI/κGA w'''`.
pub struct Element {
    h: f64,
    /// Column by column the coefficients of w for each unknown.
    deflection: Matrix4<f64>,
    rotation: Matrix4<f64>,
}

impl Element {
    pub fn of(section: &RailSection, h: f64) -> Self {
        let g = section.shear.map_or(0.0, |shear| section.bending_stiffness / shear.stiffness);
        let turn = Matrix4::new(0., 1., 0., 6. * g, 0., 0., 2., 0., 0., 0., 0., 3., 0., 0., 0., 0.);
        let at = |x: f64| RowVector4::new(1.0, x, x * x, x * x * x);
        let ends = Matrix4::from_rows(&[at(0.0), at(0.0) * turn, at(h), at(h) * turn]);
        let deflection = ends.try_inverse().unwrap();
        Self { h, deflection, rotation: turn * deflection }
    }

    /// Deflection at distance a per unknown.
    pub fn shape(&self, a: f64) -> [f64; 4] {
        let row = RowVector4::new(1.0, a, a * a, a * a * a) * self.deflection;
        [row[0], row[1], row[2], row[3]]
    }

    /// Integral of the products of polynomials with these coefficients.
    fn products(&self, of: Matrix4<f64>) -> Matrix4<f64> {
        let powers = Matrix4::from_fn(|i, j| self.h.powi((i + j + 1) as i32) / (i + j + 1) as f64);
        of.transpose() * powers * of
    }

    fn stiffness(&self, section: &RailSection) -> Matrix4<f64> {
        let slope = Matrix4::new(0., 1., 0., 0., 0., 0., 2., 0., 0., 0., 0., 3., 0., 0., 0., 0.);
        let bending = section.bending_stiffness * self.products(slope * self.rotation);
        let strain = slope * self.deflection - self.rotation;
        bending + section.shear.map_or(0.0, |shear| shear.stiffness) * self.products(strain)
    }

    fn mass(&self, section: &RailSection) -> Matrix4<f64> {
        let rotary = section.shear.map_or(0.0, |shear| shear.rotary_inertia);
        section.mass * self.products(self.deflection) + rotary * self.products(self.rotation)
    }
}

impl Modes {
    pub fn of(track: &Track) -> Self {
        let (model, nodes) = (track.model(), track.nodes().to_vec());
        let rail = 2 * nodes.len();
        let order = rail + model.seats.iter().filter(|seat| matches!(seat.foot, Foot::Sleeper { .. })).count();
        let (mut mass, mut stiffness, mut damping) =
            (DMatrix::zeros(order, order), DMatrix::zeros(order, order), DMatrix::zeros(order, order));
        let mut elements = Vec::new();
        for (e, pair) in nodes.windows(2).enumerate() {
            let (h, middle) = (pair[1] - pair[0], 0.5 * (pair[0] + pair[1]));
            let section = model.rail.iter().find(|section| middle <= section.end).unwrap();
            let element = Element::of(section, h);
            let mut m = mass.view_mut((2 * e, 2 * e), (4, 4));
            m += element.mass(section);
            let mut k = stiffness.view_mut((2 * e, 2 * e), (4, 4));
            k += element.stiffness(section);
            elements.push(element);
        }
        let mut foot = rail;
        for seat in &model.seats {
            let node = 2 * nodes.iter().position(|x| (x - seat.x).abs() < 1e-6).unwrap();
            stiffness[(node, node)] += seat.pad_stiffness;
            damping[(node, node)] += seat.pad_damping;
            if let Foot::Sleeper { mass: sleeper, support_stiffness, support_damping, .. } = seat.foot {
                for (matrix, pad, support) in [
                    (&mut stiffness, seat.pad_stiffness, support_stiffness),
                    (&mut damping, seat.pad_damping, support_damping),
                ] {
                    matrix[(foot, foot)] += pad + support;
                    matrix[(node, foot)] -= pad;
                    matrix[(foot, node)] -= pad;
                }
                mass[(foot, foot)] += sleeper;
                foot += 1;
            }
        }
        let held: &[usize] = match model.rail_ends {
            RailEnds::Clamped => &[0, 1, rail - 2, rail - 1],
            RailEnds::Pinned => &[0, rail - 2],
            _ => &[],
        };
        let free: Vec<usize> = (0..order).filter(|i| !held.contains(i)).collect();
        let reduced = |matrix: &DMatrix<f64>| matrix.select_rows(&free).select_columns(&free);
        let lower = reduced(&mass).cholesky().unwrap().l();
        let half = lower.solve_lower_triangular(&reduced(&stiffness)).unwrap();
        let symmetric = lower.solve_lower_triangular(&half.transpose()).unwrap();
        let eigen = SymmetricEigen::new(0.5 * (&symmetric + symmetric.transpose()));
        let mut ascending: Vec<usize> = (0..free.len()).collect();
        ascending.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let vectors = lower.transpose().solve_upper_triangular(&eigen.eigenvectors.select_columns(&ascending)).unwrap();
        let mut shapes = DMatrix::zeros(order, free.len());
        for (row, unknown) in free.iter().enumerate() {
            shapes.row_mut(*unknown).copy_from(&vectors.row(row));
        }
        let frequencies = ascending.iter().map(|i| eigen.eigenvalues[*i].max(0.0).sqrt()).collect();
        Self { nodes, elements, stiffness, frequencies, shapes, mass, damping, free }
    }

    pub fn order(&self) -> usize {
        self.mass.nrows()
    }

    /// Nodal forces of a force on the rail.
    pub fn force(&self, x: f64, force: f64) -> DVector<f64> {
        let e = self.nodes.partition_point(|node| *node <= x).clamp(1, self.nodes.len() - 1) - 1;
        let mut forces = DVector::zeros(self.order());
        let shape = self.elements[e].shape(x - self.nodes[e]);
        for (i, n) in shape.into_iter().enumerate() {
            forces[2 * e + i] += force * n;
        }
        forces
    }

    /// Static displacements.
    pub fn at_rest(&self, forces: &DVector<f64>) -> DVector<f64> {
        let reduced = self.stiffness.select_rows(&self.free).select_columns(&self.free);
        let found = reduced.cholesky().unwrap().solve(&forces.select_rows(&self.free));
        let mut all = DVector::zeros(self.order());
        for (value, unknown) in found.iter().zip(&self.free) {
            all[*unknown] = *value;
        }
        all
    }

    fn amplitudes(&self, displacement: &DVector<f64>) -> DVector<f64> {
        self.shapes.transpose() * (&self.mass * displacement)
    }

    /// Displacements at `time` of the undamped track let go at `start`, from its equilibrium.
    pub fn released(&self, start: &DVector<f64>, time: f64) -> DVector<f64> {
        let mut amplitudes = self.amplitudes(start);
        for (q, frequency) in amplitudes.iter_mut().zip(&self.frequencies) {
            *q *= (frequency * time).cos();
        }
        &self.shapes * amplitudes
    }

    /// The same with damping of any kind, by the exponential of the first-order system in `(ω q, q')`.
    pub fn released_damped(&self, start: &DVector<f64>, time: f64) -> DVector<f64> {
        let count = self.free.len();
        let damping = self.shapes.transpose() * &self.damping * &self.shapes;
        let mut system = DMatrix::zeros(2 * count, 2 * count);
        for (i, frequency) in self.frequencies.iter().enumerate() {
            system[(i, count + i)] = frequency * time;
            system[(count + i, i)] = -frequency * time;
        }
        system.view_mut((count, count), (count, count)).copy_from(&(-time * damping));
        let amplitudes = self.amplitudes(start);
        let scaled =
            DVector::from_fn(2 * count, |i, _| if i < count { self.frequencies[i] * amplitudes[i] } else { 0.0 });
        let end = system.exp() * scaled;
        let q = DVector::from_fn(count, |i, _| end[i] / self.frequencies[i]);
        &self.shapes * q
    }

    /// Displacements of the undamped track, at rest at first, once a force has gone from `from` to `to` at `speed`.
    /// Within an element the force on a mode is a cubic in time, and the motion under a cubic is known.
    pub fn under_moving_force(&self, force: f64, from: f64, to: f64, speed: f64) -> DVector<f64> {
        let count = self.free.len();
        let start = self.at_rest(&self.force(from, force));
        let (mut q, mut rate) = (self.amplitudes(&start), DVector::<f64>::zeros(count));
        let mut x = from;
        while x < to {
            let e = self.nodes.partition_point(|node| *node <= x).clamp(1, self.nodes.len() - 1) - 1;
            let left = self.nodes[e];
            let end = if e + 2 == self.nodes.len() { to } else { to.min(self.nodes[e + 1]) };
            let duration = (end - x) / speed;
            // Four samples of a cubic in time give its coefficients.
            let samples = [0.0, 1.0, 2.0, 3.0].map(|k| self.elements[e].shape(x - left + (end - x) * k / 3.0));
            for i in 0..count {
                let p = samples.map(|n| (0..4).map(|k| force * n[k] * self.shapes[(2 * e + k, i)]).sum::<f64>());
                let step = duration / 3.0;
                let f3 = (p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0]) / (6.0 * step.powi(3));
                let f2 = (p[2] - 2.0 * p[1] + p[0]) / (2.0 * step.powi(2)) - 3.0 * f3 * step;
                let f1 = (p[1] - p[0]) / step - f2 * step - f3 * step * step;
                let w = self.frequencies[i];
                let (a3, a2) = (f3 / (w * w), f2 / (w * w));
                let (a1, a0) = ((f1 - 6.0 * a3) / (w * w), (p[0] - 2.0 * a2) / (w * w));
                let (c, s) = ((q[i] - a0), (rate[i] - a1) / w);
                let (cos, sin) = ((w * duration).cos(), (w * duration).sin());
                let t = duration;
                q[i] = c * cos + s * sin + a0 + t * (a1 + t * (a2 + t * a3));
                rate[i] = w * (s * cos - c * sin) + a1 + t * (2.0 * a2 + t * 3.0 * a3);
            }
            x = end;
        }
        &self.shapes * q
    }
}
