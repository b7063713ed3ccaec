//! Cells of grains that check a settlement: they get the forces of a track that stands on something else, and nothing
//! returns to the track.

use super::on_cells::{CellGround, Checked, Parts};
use super::on_grains::{Following, Stage, Telling};
use super::{Load, NodeError, PassageOutcome, SeatForces, Substructure, Told};
use crate::graph::CellPlan;
use crate::solvers::settlement::Peak;

/// The cells that check a track.
pub struct CheckingCells<'a> {
    parts: Parts<'a>,
    ground: CellGround<'a>,
}

impl<'a> CheckingCells<'a> {
    /// Cells that are not built yet.
    pub fn new(parts: Parts<'a>) -> CheckingCells<'a> {
        CheckingCells { parts, ground: CellGround::new(parts) }
    }

    /// Builds the cells, or takes them from the store.
    pub fn prepare(&mut self, tell: &mut Telling<'_>) -> Result<(), NodeError> {
        self.ground.prepare(tell)
    }

    /// Lets the trains of a block pass. A block that is interrupted is computed again from its start.
    pub fn advance(&mut self, loads: &[Load<'_>], follow: &mut Following<'_>) -> Result<(), NodeError> {
        let passages: Vec<PassageOutcome> = loads.iter().map(|load| self.followed(load)).collect();
        let loads: Vec<Load<'_>> =
            passages.iter().zip(loads).map(|(passage, load)| Load { followed: None, passage, ..*load }).collect();
        let mut progress = |told: Told<'_>| match told {
            Told::Stage(Stage::Passage, share) => follow(Told::Stage(Stage::Check, share)),
            Told::Stage(stage, share) => follow(Told::Stage(stage, share)),
            Told::Beds(_) | Told::State(_) => std::ops::ControlFlow::Continue(()),
        };
        self.ground.advance_and_follow(&loads, &mut progress)
    }

    /// The seat of each cell.
    pub fn seats(&self) -> Vec<usize> {
        self.parts.cells.cells.iter().map(CellPlan::seat).collect()
    }

    /// Settlement that trains have added at these seats, of the settlement of every seat, m.
    pub fn added(&self, settlement: &[f64]) -> Vec<f64> {
        let start = &self.parts.cells.settlement;
        self.seats().into_iter().map(|seat| settlement[seat] - start[seat]).collect()
    }

    /// The settlement of each cell.
    pub fn settled(&self) -> Vec<Checked> {
        self.ground.checked()
    }

    /// The state as data.
    pub fn save(&self) -> Result<serde_json::Value, NodeError> {
        self.ground.save()
    }

    /// Takes up a state that was saved.
    pub fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        self.ground.restore(state)
    }

    /// A passage whose forces on the sleepers of the cells have followed the settlement as its peaks have.
    fn followed(&self, load: &Load<'_>) -> PassageOutcome {
        let mut passage = load.passage.clone();
        let sleepers = || self.parts.cells.cells.iter().flat_map(|cell| &cell.sleepers).map(|sleeper| sleeper.seat);
        if let (Some(peaks), Some(forces)) = (load.followed, &mut passage.forces) {
            let mut seats: Vec<usize> = sleepers().collect();
            seats.sort_unstable();
            seats.dedup();
            seats.iter().for_each(|seat| follow_peaks(forces, *seat, &load.passage.peaks[*seat], &peaks[*seat]));
        }
        passage
    }
}

/// Scales what a train adds to the force of a sleeper, so that its mean peak goes from one value to another.
fn follow_peaks(forces: &mut SeatForces, seat: usize, from: &[Peak], to: &[Peak]) {
    let mean = |peaks: &[Peak]| peaks.iter().map(|peak| peak.force).sum::<f64>() / peaks.len().max(1) as f64;
    let history = &mut forces.seats[seat];
    let rest = history.first().copied().unwrap_or(0.0);
    let added = mean(from) - rest;
    if added > 0.0 {
        let factor = (mean(to) - rest) / added;
        history.iter_mut().for_each(|force| *force = (rest + factor * (*force - rest)).max(0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peak(force: f64) -> Peak {
        Peak { force, ..Peak::default() }
    }

    #[test]
    fn forces_follow_the_mean_of_the_peaks_and_do_not_pull() {
        let mut forces = SeatForces { interval: 1e-3, seats: vec![vec![2.0, 12.0, 0.5, 10.0]] };
        follow_peaks(&mut forces, 0, &[peak(12.0), peak(10.0)], &[peak(21.0), peak(19.0)]);
        assert_eq!(forces.seats[0], vec![2.0, 22.0, 0.0, 18.0]);
    }

    #[test]
    fn a_sleeper_that_no_wheel_loads_stays_as_it_is() {
        let mut forces = SeatForces { interval: 1e-3, seats: vec![vec![2.0, 2.0]] };
        follow_peaks(&mut forces, 0, &[peak(2.0)], &[peak(3.0)]);
        assert_eq!(forces.seats[0], vec![2.0, 2.0]);
    }
}
