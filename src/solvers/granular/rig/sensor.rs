//! Sensors: a region of the bed, and its readings.

use super::super::bed::Bed;
use super::super::domain::Domain;
use super::super::lanes::Real;
use super::super::measure::{Ball, Contact, Region, neighbours, stress};
use super::super::snapshot::Snapshot;
use serde::{Deserialize, Serialize};

/// A fixed region, inside the bed along its period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    pub region: Region,
}

/// The readings of a sensor at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorReading {
    /// Index into [`super::Rig::sensors`].
    pub sensor: usize,
    pub cycle: u64,
    /// Elapsed share of the cycle, 0 .. 1.
    pub phase: f64,
    /// Vertical, positive in compression, Pa.
    pub stress: f64,
    /// Mass-weighted mean over the grains whose middle lies inside, downwards, m/s.
    pub velocity: f64,
    /// Mean number of neighbours of these grains.
    pub coordination: f64,
    /// Only at the end of a cycle.
    pub porosity: Option<f64>,
}

impl Sensor {
    /// Reads the bed without its porosity, because the porosity costs more than all other readings.
    pub fn read<R: Real>(&self, bed: &Bed<R>, snapshot: &Snapshot) -> SensorReading {
        let domain = bed.domain();
        let contacts = snapshot.contacts.iter().map(|contact| Contact {
            force: contact.force,
            branch: contact.branch,
            point: into_period(domain, contact.point),
        });
        let pairs: Vec<(u32, u32)> = snapshot
            .contacts
            .iter()
            .filter_map(|contact| Some((contact.first.body()?.0, contact.second.body()?.0)))
            .collect();
        let neighbours = neighbours(bed.len(), &pairs);
        let (mut mass, mut momentum, mut count, mut touching) = (0.0, 0.0, 0usize, 0u32);
        for (state, neighbours) in bed.states().zip(neighbours) {
            if self.region.holds(&into_period(domain, state.place)) {
                mass += state.mass;
                momentum -= state.mass * state.velocity[2];
                count += 1;
                touching += neighbours;
            }
        }
        let per = |sum: f64, of: f64| if of > 0.0 { sum / of } else { 0.0 };
        SensorReading {
            sensor: 0,
            cycle: 0,
            phase: 0.0,
            stress: -stress(&self.region, contacts)[(2, 2)],
            velocity: per(momentum, mass),
            coordination: per(f64::from(touching), count as f64),
            porosity: None,
        }
    }

    /// Porosity; `densities` are the densities of the grains of each surface, kg/m3.
    pub(super) fn porosity<R: Real>(&self, bed: &Bed<R>, densities: &[f64]) -> f64 {
        let pebbles: Vec<_> = bed.pebbles().collect();
        let shares = pebbles.chunk_by(|a, b| a.body == b.body).map(|body| {
            let state = bed.body_state(body[0].body);
            let middle = into_period(bed.domain(), state.place);
            let shift = [0, 1, 2].map(|c| middle[c] - state.place[c]);
            let balls: Vec<Ball> =
                body.iter().map(|pebble| ([0, 1, 2].map(|c| pebble.place[c] + shift[c]), pebble.radius)).collect();
            self.region.share_of_clump(&balls, state.mass / densities[usize::from(state.surface)])
        });
        self.region.porosity(shares)
    }
}

/// A position, moved back into the period.
fn into_period(domain: &Domain, place: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| match domain.period(axis) {
        Some(period) => place[axis] - period * (place[axis] / period).floor(),
        None => place[axis],
    })
}
