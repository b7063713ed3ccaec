//! The contacts of one time step: wheel forces and the supports that are not closed. Everything else is linear.
//!
//! Unknowns are the wheel forces F and, for each support that is not closed, the difference q between its closed line
//! and its force. A (track), B (vehicle) and L (rail within its element) are compliances:
//!
//! ```text
//! wheel:      δ = δ_free - (A + B + L) F - A q,   F = F(δ)
//! open:       q = closed line at g                (R = 0)
//! touching:   g = 0,  R = closed line at 0 - q in [0, c d]
//! seating:    q = (k - k_s) (g - a)
//! every gap:  g = g_free + A F + A q
//! ```
//!
//! One Newton iteration linearises the wheels and moves the supports that contradict their phase. The matrix is
//! symmetric and quasi-definite; ordered along the track it is a skyline matrix whose rows reach back as far as a force
//! has an effect. The step has one solution (see `support`). After [`FLIP_ALL`] iterations only the first contradiction
//! is moved, after the wheels have converged for the present phases; this ends by Murty's least-index argument.

use super::WheelContact;
use super::contact::WheelLaw;
use super::error::Unsettled;
use super::influence::Stepper;
use super::mesh::RailPoint;
use super::reach::Reach;
use super::support::{SupportLines, SupportPhase};
use crate::linalg::skyline::Skyline;
use crate::linalg::vector::add_scaled;
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
    /// Laws of the wheels in this step.
    laws: Vec<WheelLaw>,
    /// Indentation if this step's wheel forces were zero, m.
    pub free_indentations: Vec<f64>,
    reach: Reach,
    // Per rank.
    /// Forces that depend on the motion, N; 0 for given ones.
    answers: Vec<f64>,
    next: Vec<f64>,
    /// Row of the linear system at which a wheel stands or would stand.
    row_of: Vec<usize>,
    // Per sleeper.
    pub phases: Vec<SupportPhase>,
    /// q, N; 0 for closed supports.
    pub corrections: Vec<f64>,
    pub lines: Vec<SupportLines>,
    /// Gap if wheel forces and corrections were zero, m.
    pub free_gaps: Vec<f64>,
    pub gaps: Vec<f64>,
    // Of the linear system.
    unknowns: Vec<ContactIndex>,
    /// Last unknown of the track that a contact touches, per row.
    ends: Vec<usize>,
    matrix: Skyline,
    rhs: Vec<f64>,
}

/// The part of an [`Interface`] on which the next step depends.
#[derive(Debug, Clone, Default)]
pub(super) struct InterfaceState {
    points: Vec<RailPoint>,
    wheels: [Vec<f64>; 3],
    phases: Vec<SupportPhase>,
    supports: [Vec<f64>; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ContactIndex {
    /// By rank from left to right.
    Wheel(usize),
    Support(usize),
}

/// The effort of a solved step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Effort {
    pub iterations: usize,
    /// Supports that were not closed.
    pub active: usize,
}

/// Iterations that move all contradicting supports at once and take full Newton steps.
const FLIP_ALL: usize = 12;
/// Wheel forces are converged to this share of their value.
const FORCE_TOLERANCE: f64 = 1e-11;
/// Indentations below this count as zero, m.
const INDENTATION_ROUNDING: f64 = 1e-16;

impl Interface {
    /// Contacts of wheels at `positions` (m), and of `sleepers` supports. `vehicles` gives, for each vehicle, its
    /// wheels and the drop of its wheels per wheel force.
    pub fn new(vehicles: Vec<(Vec<WheelContact>, DMatrix<f64>)>, positions: &[f64], sleepers: usize) -> Self {
        let (contacts, compliances): (Vec<_>, Vec<_>) = vehicles.into_iter().unzip();
        let contacts: Vec<WheelContact> = contacts.into_iter().flatten().collect();
        let wheels = contacts.len();
        Self {
            points: vec![RailPoint::default(); wheels],
            forces: vec![0.0; wheels],
            indentations: vec![0.0; wheels],
            trends: vec![0.0; wheels],
            free_indentations: vec![0.0; wheels],
            reach: Reach::new(compliances, positions),
            answers: vec![0.0; wheels],
            next: vec![0.0; wheels],
            row_of: vec![0; wheels],
            phases: vec![SupportPhase::Closed; sleepers],
            corrections: vec![0.0; sleepers],
            lines: vec![SupportLines::default(); sleepers],
            free_gaps: vec![0.0; sleepers],
            gaps: vec![0.0; sleepers],
            laws: contacts.iter().map(|contact| WheelLaw::at_rest(*contact)).collect(),
            contacts,
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

    /// Continues in steps `ratio` times as long.
    pub fn scale_trends(&mut self, ratio: f64) {
        self.trends.iter_mut().for_each(|trend| *trend *= ratio);
    }

    /// Sets the drop of a vehicle's wheels per wheel force, m/N.
    pub fn set_compliance(&mut self, vehicle: usize, compliance: DMatrix<f64>) {
        self.reach.set_vehicle(vehicle, compliance);
    }

    /// Solves the contacts of a step whose points, free indentations, lines and free gaps are set. The error is the
    /// contact that was moved last.
    pub fn solve(&mut self, stepper: &Stepper) -> Result<Effort, ContactIndex> {
        self.reach.gather(stepper, &self.points);
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
        self.take_given();
        let limit = 100 + 4 * self.phases.len();
        let mut moved = ContactIndex::Support(0);
        for iteration in 1..=limit {
            let careful = iteration > FLIP_ALL;
            self.assemble(stepper);
            self.matrix.solve_in_place(&mut self.rhs).map_err(|row| self.unknowns[row])?;
            self.corrections.fill(0.0);
            for (unknown, value) in self.unknowns.iter().zip(&self.rhs) {
                match *unknown {
                    ContactIndex::Wheel(rank) => {
                        self.answers[rank] = *value;
                        self.forces[self.reach.wheels[rank].wheel] = *value;
                    }
                    ContactIndex::Support(s) => self.corrections[s] = *value,
                }
            }
            let wheels = self.move_wheels(if careful { 0.5 } else { 1.0 });
            if let Some(wheel) = wheels {
                moved = ContactIndex::Wheel(wheel);
            }
            self.evaluate_gaps(stepper);
            let support = if careful && wheels.is_some() { None } else { self.move_supports(careful) };
            if let Some(sleeper) = support {
                moved = ContactIndex::Support(sleeper);
            }
            if wheels.is_none() && support.is_none() {
                for (trend, indentation) in self.trends.iter_mut().zip(&self.indentations) {
                    *trend += indentation;
                }
                let active = self.unknowns.iter().filter(|u| matches!(u, ContactIndex::Support(_))).count();
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

    /// A contact and its present state.
    pub fn describe(&self, contact: ContactIndex) -> Unsettled {
        match contact {
            ContactIndex::Wheel(rank) => {
                let wheel = self.wheel_of(rank);
                let (force, indentation) = (self.forces[wheel], self.indentations[wheel]);
                Unsettled::Wheel { number: wheel + 1, force, indentation }
            }
            ContactIndex::Support(sleeper) => match (self.phases.get(sleeper), self.gaps.get(sleeper)) {
                (Some(&phase), Some(&gap)) => Unsettled::Support { sleeper: sleeper + 1, phase, gap },
                _ => Unsettled::Nothing,
            },
        }
    }

    /// The wheel of a rank, in the order of the train.
    pub fn wheel_of(&self, rank: usize) -> usize {
        self.reach.wheels[rank].wheel
    }

    /// Adds the displacements by given forces to the free indentations and gaps.
    fn take_given(&mut self) {
        let mut any = false;
        for (ranked, answer) in self.reach.wheels.iter().zip(&mut self.answers) {
            *answer = self.laws[ranked.wheel].given().unwrap_or(0.0);
            any |= *answer != 0.0;
        }
        if any {
            self.next.fill(0.0);
            self.reach.compliance.subtract_product(&self.answers, &mut self.next);
            for (ranked, drop) in self.reach.wheels.iter().zip(&self.next) {
                self.free_indentations[ranked.wheel] += drop;
            }
            for (ranked, force) in self.reach.wheels.iter().zip(&self.answers) {
                add_scaled(&mut self.free_gaps[ranked.at_sleepers.0..], &ranked.at_sleepers.1, *force);
            }
            self.answers.fill(0.0);
        }
    }

    /// The contacts with an unknown, from left to right.
    fn list_unknowns(&mut self, stepper: &Stepper) {
        self.unknowns.clear();
        self.ends.clear();
        let mut next_sleeper = 0;
        for rank in 0..=self.reach.wheels.len() {
            let ranked = self.reach.wheels.get(rank);
            let until = ranked.map_or(self.phases.len(), |wheel| wheel.sleepers_left);
            for s in next_sleeper..until {
                if self.phases[s] != SupportPhase::Closed {
                    self.unknowns.push(ContactIndex::Support(s));
                    self.ends.push(stepper.track.sleepers[s].unknown);
                }
            }
            next_sleeper = next_sleeper.max(until);
            let Some(wheel) = ranked else { continue };
            self.row_of[rank] = self.unknowns.len();
            let law = self.laws[wheel.wheel];
            if law.touches(self.indentations[wheel.wheel]) {
                self.unknowns.push(ContactIndex::Wheel(rank));
                self.ends.push(wheel.end);
            } else {
                self.answers[rank] = 0.0;
                self.forces[wheel.wheel] = law.given().unwrap_or(0.0);
            }
        }
    }

    fn assemble(&mut self, stepper: &Stepper) {
        self.list_unknowns(stepper);
        let Self { reach, unknowns, matrix, rhs, .. } = self;
        matrix.clear();
        rhs.clear();
        for (r, contact) in unknowns.iter().enumerate() {
            let (from, coupled) = match *contact {
                ContactIndex::Wheel(rank) => (reach.wheels[rank].from, self.row_of[reach.wheels[rank].vehicle_first]),
                ContactIndex::Support(s) => (stepper.of_sleeper[s].start, r),
            };
            let felt = self.ends[..r].iter().rev().take_while(|end| **end >= from).count();
            let row = matrix.push_row((r - felt).min(coupled));
            let first = r + 1 - row.len();
            for (entry, other) in row.iter_mut().zip(&unknowns[first..]) {
                *entry = match (*contact, *other) {
                    (ContactIndex::Wheel(p), ContactIndex::Wheel(q)) => reach.compliance.get(p, q),
                    (ContactIndex::Support(s), ContactIndex::Wheel(p))
                    | (ContactIndex::Wheel(p), ContactIndex::Support(s)) => reach.wheels[p].at_sleeper(s),
                    (ContactIndex::Support(s), ContactIndex::Support(t)) => stepper.of_sleeper_at_sleepers[s].entry(t),
                };
            }
            let diagonal = &mut row[r - first];
            rhs.push(match *contact {
                ContactIndex::Wheel(rank) => {
                    let j = reach.wheels[rank].wheel;
                    let (flexibility, rest) = self.laws[j].line(self.indentations[j]);
                    *diagonal += flexibility;
                    self.free_indentations[j] - rest
                }
                ContactIndex::Support(s) if self.phases[s] == SupportPhase::Open => {
                    let line = &self.lines[s];
                    *diagonal -= 1.0 / line.stiffness;
                    -(self.free_gaps[s] + line.closed(0.0) / line.stiffness)
                }
                ContactIndex::Support(s) if self.phases[s] == SupportPhase::Seating => {
                    let line = &self.lines[s];
                    *diagonal -= 1.0 / line.lack;
                    line.closure - self.free_gaps[s]
                }
                ContactIndex::Support(s) => -self.free_gaps[s],
            });
        }
    }

    /// Moves the indentations to those that follow from the forces; returns the wheel farthest from its law, if any
    /// wheel does not meet its law.
    fn move_wheels(&mut self, damping: f64) -> Option<usize> {
        for (next, ranked) in self.next.iter_mut().zip(&self.reach.wheels) {
            *next = self.free_indentations[ranked.wheel];
        }
        self.reach.compliance.subtract_product(&self.answers, &mut self.next);
        let any_support = self.unknowns.iter().any(|u| matches!(u, ContactIndex::Support(_)));
        let mut worst = (0.0, None);
        for (rank, ranked) in self.reach.wheels.iter().enumerate() {
            let (j, mut next) = (ranked.wheel, self.next[rank]);
            if any_support {
                let (first, values) = &ranked.at_sleepers;
                next -= values.iter().zip(&self.corrections[*first..]).map(|(a, q)| a * q).sum::<f64>();
            }
            let law = self.laws[j];
            let force = law.force(next);
            let rounding = INDENTATION_ROUNDING + f64::EPSILON * self.free_indentations[j].abs();
            let tolerance = FORCE_TOLERANCE * force.abs().max(1.0) + law.stiffness(next) * rounding;
            let error = (force - self.forces[j]).abs() - tolerance;
            if error > worst.0 {
                worst = (error, Some(rank));
            }
            let now = self.indentations[j];
            let full = !matches!(law, WheelLaw::Hertz { .. }) || now <= 0.0 || next <= 0.0;
            self.indentations[j] = if full { next } else { now + damping * (next - now) };
        }
        worst.1
    }

    fn evaluate_gaps(&mut self, stepper: &Stepper) {
        self.gaps.copy_from_slice(&self.free_gaps);
        for (force, ranked) in self.answers.iter().zip(&self.reach.wheels) {
            if *force != 0.0 {
                add_scaled(&mut self.gaps[ranked.at_sleepers.0..], &ranked.at_sleepers.1, *force);
            }
        }
        for unknown in &self.unknowns {
            if let ContactIndex::Support(s) = *unknown {
                let column = &stepper.of_sleeper_at_sleepers[s];
                add_scaled(&mut self.gaps[column.start..], &column.values, self.corrections[s]);
            }
        }
    }

    /// Moves all supports that contradict their phase, or only the first; returns the support that was moved last.
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
