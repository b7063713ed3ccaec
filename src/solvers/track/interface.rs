//! The contacts of one time step: wheel forces and the supports that are not closed, all else being linear.
//!
//! Unknowns are the wheel forces F and, for each support that is not closed, the force q by which it falls short of its
//! closed line. With the compliances A (track), B (vehicle) and L (rail within its element):
//!
//! ```text
//! wheel:      δ = δ_free - (A + B + L) F - A q,   F = F(δ)
//! open:       q = closed line at g                (R = 0)
//! touching:   g = 0,  R = closed line at 0 - q in [0, c d]
//! seating:    q = (k - k_s) (g - a)
//! every gap:  g = g_free + A F + A q
//! ```
//!
//! One Newton iteration linearises the wheels and moves the supports that contradict their phase. The matrix is symmetric and
//! quasi-definite. The step has one solution (see `support`); after [`FLIP_ALL`] iterations only the first contradiction is
//! moved, once the wheels are settled for the present phases, which ends by Murty's least-index argument.

use super::WheelContact;
use super::contact::WheelLaw;
use super::influence::Stepper;
use super::mesh::RailPoint;
use super::support::{SupportLines, SupportPhase};
use crate::linalg::dense::solve_symmetric;
use nalgebra::DMatrix;

/// The contacts of a passage: their state after the last step and scratch for the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Interface {
    // Per wheel.
    pub points: Vec<RailPoint>,
    /// N.
    pub forces: Vec<f64>,
    /// m.
    pub indentations: Vec<f64>,
    /// Change of the indentation over the last step, m: the first guess of the next.
    trends: Vec<f64>,
    contacts: Vec<WheelContact>,
    /// Of this step.
    laws: Vec<WheelLaw>,
    /// Index of its vehicle, and of its vehicle's first wheel.
    vehicle_of: Vec<(usize, usize)>,
    /// Indentation if this step's wheel forces were zero, m.
    pub free_indentations: Vec<f64>,
    /// Per vehicle: drop of its wheels per wheel force, m/N.
    vehicle_compliance: Vec<DMatrix<f64>>,
    compliance: Vec<f64>,
    /// Per wheel: first sleeper, and displacement of the sleepers from there per wheel force.
    at_sleepers: Vec<(usize, Vec<f64>)>,
    // Per sleeper.
    pub phases: Vec<SupportPhase>,
    /// q, N; 0 for closed supports.
    pub corrections: Vec<f64>,
    pub lines: Vec<SupportLines>,
    /// Gap if wheel forces and corrections were zero, m.
    pub free_gaps: Vec<f64>,
    pub gaps: Vec<f64>,
    // Of the linear system.
    unknowns: Vec<Contact>,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
}

/// What of an [`Interface`] the next step depends on.
#[derive(Debug, Clone, Default)]
pub(super) struct InterfaceState {
    points: Vec<RailPoint>,
    wheels: [Vec<f64>; 3],
    phases: Vec<SupportPhase>,
    supports: [Vec<f64>; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Contact {
    Wheel(usize),
    Support(usize),
}

/// What a solved step took.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Effort {
    pub iterations: usize,
    /// Supports that were not closed.
    pub active: usize,
}

/// Iterations that move every contradicting support at once and take full Newton steps.
const FLIP_ALL: usize = 12;
/// Wheel forces are converged to this part of their size.
const FORCE_TOLERANCE: f64 = 1e-11;
/// Indentations below this are none, m.
const INDENTATION_ROUNDING: f64 = 1e-16;

impl Interface {
    /// Contacts of wheels, vehicle by vehicle with the drop of its wheels per wheel force, and of `sleepers` supports.
    pub fn new(vehicles: &[(Vec<WheelContact>, DMatrix<f64>)], sleepers: usize) -> Self {
        let contacts: Vec<WheelContact> = vehicles.iter().flat_map(|(wheels, _)| wheels).copied().collect();
        let wheels = contacts.len();
        let mut vehicle_of = Vec::with_capacity(wheels);
        for (v, (contacts, _)) in vehicles.iter().enumerate() {
            vehicle_of.extend(vec![(v, vehicle_of.len()); contacts.len()]);
        }
        Self {
            points: vec![RailPoint::default(); wheels],
            forces: vec![0.0; wheels],
            indentations: vec![0.0; wheels],
            trends: vec![0.0; wheels],
            free_indentations: vec![0.0; wheels],
            compliance: vec![0.0; wheels * wheels],
            at_sleepers: vec![(0, Vec::new()); wheels],
            phases: vec![SupportPhase::Closed; sleepers],
            corrections: vec![0.0; sleepers],
            lines: vec![SupportLines::default(); sleepers],
            free_gaps: vec![0.0; sleepers],
            gaps: vec![0.0; sleepers],
            laws: contacts.iter().map(|contact| WheelLaw::at_rest(*contact)).collect(),
            contacts,
            vehicle_of,
            vehicle_compliance: vehicles.iter().map(|(_, compliance)| compliance.clone()).collect(),
            ..Self::default()
        }
    }

    pub fn save(&self, state: &mut InterfaceState) {
        state.points.clone_from(&self.points);
        for (kept, now) in state.wheels.iter_mut().zip([&self.forces, &self.indentations, &self.trends]) {
            kept.clone_from(now);
        }
        state.phases.clone_from(&self.phases);
        for (kept, now) in state.supports.iter_mut().zip([&self.corrections, &self.gaps]) {
            kept.clone_from(now);
        }
    }

    pub fn restore(&mut self, state: &InterfaceState) {
        self.points.clone_from(&state.points);
        let [forces, indentations, trends] = &state.wheels;
        self.forces.clone_from(forces);
        self.indentations.clone_from(indentations);
        self.trends.clone_from(trends);
        self.phases.clone_from(&state.phases);
        let [corrections, gaps] = &state.supports;
        self.corrections.clone_from(corrections);
        self.gaps.clone_from(gaps);
    }

    /// Goes on in steps `ratio` times as long.
    pub fn scale_trends(&mut self, ratio: f64) {
        self.trends.iter_mut().for_each(|trend| *trend *= ratio);
    }

    /// Sets the drop of a vehicle's wheels per wheel force, m/N.
    pub fn set_compliance(&mut self, vehicle: usize, compliance: DMatrix<f64>) {
        self.vehicle_compliance[vehicle] = compliance;
    }

    /// Solves the contacts of a step whose points, free indentations, lines and free gaps are set; fails with the contact
    /// that was last moved.
    pub fn solve(&mut self, stepper: &Stepper) -> Result<Effort, Contact> {
        self.gather(stepper);
        for j in 0..self.points.len() {
            let (indentation, trend) = (self.indentations[j], self.trends[j]);
            let law = WheelLaw::in_step(self.contacts[j], indentation, trend, stepper.time_step());
            self.laws[j] = law;
            self.forces[j] = law.given().unwrap_or(self.forces[j]);
            self.trends[j] = -indentation;
            if law.touches(indentation) && law.touches(indentation + trend) {
                self.indentations[j] += trend;
            }
        }
        let limit = 100 + 4 * self.phases.len();
        let mut moved = Contact::Support(0);
        for iteration in 1..=limit {
            let careful = iteration > FLIP_ALL;
            self.assemble(stepper);
            let order = self.unknowns.len();
            solve_symmetric(&mut self.matrix, order, &mut self.rhs).map_err(|row| self.unknowns[row])?;
            self.corrections.fill(0.0);
            for (unknown, value) in self.unknowns.iter().zip(&self.rhs) {
                match *unknown {
                    Contact::Wheel(j) => self.forces[j] = *value,
                    Contact::Support(s) => self.corrections[s] = *value,
                }
            }
            let wheels = self.move_wheels(if careful { 0.5 } else { 1.0 });
            if let Some(wheel) = wheels {
                moved = Contact::Wheel(wheel);
            }
            self.evaluate_gaps(stepper);
            let support = if careful && wheels.is_some() { None } else { self.move_supports(careful) };
            if let Some(sleeper) = support {
                moved = Contact::Support(sleeper);
            }
            if wheels.is_none() && support.is_none() {
                for (trend, indentation) in self.trends.iter_mut().zip(&self.indentations) {
                    *trend += indentation;
                }
                let active = self.unknowns.iter().filter(|u| matches!(u, Contact::Support(_))).count();
                return Ok(Effort { iterations: iteration, active });
            }
        }
        Err(moved)
    }

    /// Force of a support at the end of the step, N.
    #[inline]
    pub fn support_force(&self, sleeper: usize) -> f64 {
        let phase = self.phases[sleeper];
        self.lines[sleeper].force(phase, self.gaps[sleeper], self.corrections[sleeper]).max(0.0)
    }

    /// Compliances between the wheels at their present points, and from the wheels to the sleepers.
    fn gather(&mut self, stepper: &Stepper) {
        let wheels = self.points.len();
        for j in 0..wheels {
            let point = self.points[j];
            let columns = stepper.columns(point.element);
            for k in j..wheels {
                let other = self.points[k];
                let unknowns = stepper.track.element_unknowns(other.element);
                let mut sum = 0.0;
                for (column, shape) in columns.into_iter().zip(point.shape) {
                    for (unknown, other_shape) in unknowns.into_iter().zip(other.shape) {
                        sum += shape * other_shape * column.at(unknown);
                    }
                }
                if other.element == point.element {
                    let same = j == k;
                    sum += if same { point.local_compliance } else { stepper.track.local_deflection(&other, &point) };
                }
                let ((vehicle, first), (other_vehicle, _)) = (self.vehicle_of[j], self.vehicle_of[k]);
                if vehicle == other_vehicle {
                    sum += self.vehicle_compliance[vehicle][(j - first, k - first)];
                }
                self.compliance[j * wheels + k] = sum;
                self.compliance[k * wheels + j] = sum;
            }
            let columns = stepper.columns_at_sleepers(point.element);
            let reached = columns.iter().filter(|c| !c.values.is_empty());
            let start = reached.clone().map(|c| c.start).min().unwrap_or(0);
            let end = reached.clone().map(|c| c.end()).max().unwrap_or(start);
            let (first, values) = &mut self.at_sleepers[j];
            *first = start;
            values.clear();
            values.resize(end - start, 0.0);
            for (column, shape) in columns.into_iter().zip(point.shape).filter(|(c, _)| !c.values.is_empty()) {
                add_scaled(&mut values[column.start - start..], &column.values, shape);
            }
        }
    }

    fn assemble(&mut self, stepper: &Stepper) {
        let wheels = self.points.len();
        self.unknowns.clear();
        for j in 0..wheels {
            if self.laws[j].touches(self.indentations[j]) {
                self.unknowns.push(Contact::Wheel(j));
            } else {
                self.forces[j] = self.laws[j].given().unwrap_or(0.0);
            }
        }
        let closed = SupportPhase::Closed;
        self.unknowns.extend((0..self.phases.len()).filter(|s| self.phases[*s] != closed).map(Contact::Support));
        let order = self.unknowns.len();
        self.matrix.resize(order * order, 0.0);
        self.rhs.resize(order, 0.0);
        for (r, row) in self.unknowns.iter().enumerate() {
            for (c, column) in self.unknowns[..=r].iter().enumerate() {
                self.matrix[r * order + c] = match (*row, *column) {
                    (Contact::Wheel(j), Contact::Wheel(k)) => self.compliance[j * wheels + k],
                    (Contact::Support(s), Contact::Wheel(j)) => {
                        let (first, values) = &self.at_sleepers[j];
                        values.get(s.wrapping_sub(*first)).copied().unwrap_or(0.0)
                    }
                    (Contact::Support(s), Contact::Support(t)) => stepper.of_sleeper_at_sleepers[s].at(t),
                    (Contact::Wheel(_), Contact::Support(_)) => 0.0, // supports come last
                };
            }
            let diagonal = &mut self.matrix[r * order + r];
            self.rhs[r] = match *row {
                Contact::Wheel(j) => {
                    let (flexibility, rest) = self.laws[j].line(self.indentations[j]);
                    *diagonal += flexibility;
                    self.free_indentations[j] - rest
                }
                Contact::Support(s) if self.phases[s] == SupportPhase::Open => {
                    let line = &self.lines[s];
                    *diagonal -= 1.0 / line.stiffness;
                    -(self.free_gaps[s] + line.closed(0.0) / line.stiffness)
                }
                Contact::Support(s) if self.phases[s] == SupportPhase::Seating => {
                    let line = &self.lines[s];
                    *diagonal -= 1.0 / line.lack;
                    line.closure - self.free_gaps[s]
                }
                Contact::Support(s) => -self.free_gaps[s],
            };
        }
        for (k, law) in self.laws.iter().enumerate() {
            let Some(force) = law.given() else { continue };
            let (first, values) = &self.at_sleepers[k];
            for (r, row) in self.unknowns.iter().enumerate() {
                self.rhs[r] -= force
                    * match *row {
                        Contact::Wheel(j) => self.compliance[j * wheels + k],
                        Contact::Support(s) => values.get(s.wrapping_sub(*first)).copied().unwrap_or(0.0),
                    };
            }
        }
    }

    /// Indentations that follow from the forces; returns the worst wheel whose law is not met yet.
    fn move_wheels(&mut self, damping: f64) -> Option<usize> {
        let wheels = self.points.len();
        let mut worst = (0.0, None);
        for j in 0..wheels {
            let mut next = self.free_indentations[j];
            for k in 0..wheels {
                next -= self.compliance[j * wheels + k] * self.forces[k];
            }
            for unknown in &self.unknowns {
                if let Contact::Support(s) = *unknown {
                    let (first, values) = &self.at_sleepers[j];
                    next -= values.get(s.wrapping_sub(*first)).copied().unwrap_or(0.0) * self.corrections[s];
                }
            }
            let law = self.laws[j];
            let force = law.force(next);
            let rounding = INDENTATION_ROUNDING + f64::EPSILON * self.free_indentations[j].abs();
            let tolerance = FORCE_TOLERANCE * force.abs().max(1.0) + law.stiffness(next) * rounding;
            let error = (force - self.forces[j]).abs() - tolerance;
            if error > worst.0 {
                worst = (error, Some(j));
            }
            let now = self.indentations[j];
            let full = !matches!(law, WheelLaw::Hertz { .. }) || now <= 0.0 || next <= 0.0;
            self.indentations[j] = if full { next } else { now + damping * (next - now) };
        }
        worst.1
    }

    fn evaluate_gaps(&mut self, stepper: &Stepper) {
        self.gaps.copy_from_slice(&self.free_gaps);
        for (force, (first, values)) in self.forces.iter().zip(&self.at_sleepers) {
            if *force != 0.0 {
                add_scaled(&mut self.gaps[*first..], values, *force);
            }
        }
        for unknown in &self.unknowns {
            if let Contact::Support(s) = *unknown {
                let column = &stepper.of_sleeper_at_sleepers[s];
                add_scaled(&mut self.gaps[column.start..], &column.values, self.corrections[s]);
            }
        }
    }

    /// Moves the supports that contradict their phase, or the first of them; returns the last one moved.
    fn move_supports(&mut self, only_first: bool) -> Option<usize> {
        let mut moved = None;
        for s in 0..self.phases.len() {
            let (line, gap, now) = (self.lines[s], self.gaps[s], self.phases[s]);
            let force = line.force(now, gap, self.corrections[s]);
            let next = line.phase_after(now, gap, force);
            if next != now {
                self.phases[s] = next;
                moved = Some(s);
                if only_first {
                    break;
                }
            }
        }
        moved
    }
}

/// `y += factor x` over the length of x.
#[inline]
pub(super) fn add_scaled(y: &mut [f64], x: &[f64], factor: f64) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
