//! The largest and smallest values during a passage.

use super::view::{Observer, StepView};

/// An [`Observer`] that keeps extremes; it is empty until it has observed the start. Lists run over seats, wheels or
/// nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Envelope {
    /// Force of the rail on each pad, smallest and largest, N.
    pub seat_loads: Vec<(f64, f64)>,
    /// Largest force of each sleeper on its support, N; 0 for seats without a sleeper.
    pub contact_forces: Vec<f64>,
    /// Largest downward displacement of each sleeper or slab seat from the unloaded state, m.
    pub foot_displacements: Vec<f64>,
    /// Time in which the support of each sleeper carried no force, s.
    pub contact_losses: Vec<f64>,
    /// Row by row for each seat: the largest contact force while each wheel was the nearest wheel to the seat, N. The
    /// value is 0 for a wheel that was never the nearest, and for a seat without a sleeper.
    pub axle_peaks: Vec<f64>,
    /// Row by row for each seat, like `axle_peaks`: the largest displacement of the support under the sleeper below its
    /// unloaded level, m.
    pub axle_deflections: Vec<f64>,
    /// Smallest and largest force of each wheel, N.
    pub wheel_forces: Vec<(f64, f64)>,
    /// Sagging rail moment at each node, smallest and largest, N m.
    pub rail_moments: Vec<(f64, f64)>,
    /// Downward displacement of each rail node from the unloaded state, smallest and largest, m.
    pub rail_displacements: Vec<(f64, f64)>,
    moments: Vec<f64>,
    /// Wheels from left to right, and the wheel nearest to the seat that was evaluated last.
    along: Vec<usize>,
    near: usize,
}

const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

fn widen(range: &mut (f64, f64), value: f64) {
    range.0 = range.0.min(value);
    range.1 = range.1.max(value);
}

impl Envelope {
    /// The peak contact force of a seat for each wheel, N.
    pub fn axle_peaks_of(&self, seat: usize) -> &[f64] {
        let wheels = self.wheel_forces.len();
        &self.axle_peaks[seat * wheels..(seat + 1) * wheels]
    }

    /// The largest deflection of the support of a seat for each wheel, m.
    pub fn axle_deflections_of(&self, seat: usize) -> &[f64] {
        let wheels = self.wheel_forces.len();
        &self.axle_deflections[seat * wheels..(seat + 1) * wheels]
    }

    fn begin(&mut self, view: &StepView<'_>) {
        let (seats, wheels) = (view.track().model().seats.len(), view.wheel_forces().len());
        let nodes = view.track().nodes().len();
        *self = Self {
            seat_loads: vec![NOTHING; seats],
            contact_forces: vec![0.0; seats],
            foot_displacements: vec![f64::NEG_INFINITY; seats],
            contact_losses: vec![0.0; seats],
            axle_peaks: vec![0.0; seats * wheels],
            axle_deflections: vec![0.0; seats * wheels],
            wheel_forces: vec![NOTHING; wheels],
            rail_moments: vec![NOTHING; nodes],
            rail_displacements: vec![NOTHING; nodes],
            moments: vec![0.0; nodes],
            along: (0..wheels).collect(),
            near: 0,
        };
        let positions = view.wheel_positions();
        // If two wheels are equally near, the first of the train counts.
        self.along.sort_by(|a, b| positions[*a].total_cmp(&positions[*b]).then(b.cmp(a)));
    }
}

impl Observer for Envelope {
    fn observe(&mut self, view: &StepView<'_>) {
        if view.step() == 0 {
            self.begin(view);
        }
        let wheels = view.wheel_positions();
        self.near = 0;
        for (seat, model) in view.track().model().seats.iter().enumerate() {
            widen(&mut self.seat_loads[seat], view.seat_load(seat));
            let lowered = view.foot_displacement(seat) - view.unloaded().foot_displacements[seat];
            self.foot_displacements[seat] = self.foot_displacements[seat].max(lowered);
            let Some(force) = view.contact_force(seat) else { continue };
            self.contact_forces[seat] = self.contact_forces[seat].max(force);
            if force == 0.0 && view.step() > 0 {
                self.contact_losses[seat] += view.time_step();
            }
            while self.near + 1 < self.along.len() {
                let [here, next] = [self.near, self.near + 1].map(|rank| (wheels[self.along[rank]] - model.x).abs());
                let later = self.along[self.near + 1] > self.along[self.near];
                if next > here || (next == here && later) {
                    break;
                }
                self.near += 1;
            }
            let nearest = self.along.get(self.near).copied().unwrap_or(0);
            let place = seat * wheels.len() + nearest;
            if let Some(peak) = self.axle_peaks.get_mut(place) {
                *peak = peak.max(force);
            }
            if let (Some(most), Some(deflection)) =
                (self.axle_deflections.get_mut(place), view.support_deflection(seat))
            {
                *most = most.max(deflection);
            }
        }
        for (range, force) in self.wheel_forces.iter_mut().zip(view.wheel_forces()) {
            widen(range, *force);
        }
        for (node, range) in self.rail_displacements.iter_mut().enumerate() {
            widen(range, view.rail_deflection(node) - view.unloaded().rail_deflection[node]);
        }
        view.rail_moments(&mut self.moments);
        for (range, moment) in self.rail_moments.iter_mut().zip(&self.moments) {
            widen(range, *moment);
        }
    }
}
