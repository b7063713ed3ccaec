//! A track on grains as data, to go on with in another process, bit by bit.
//!
//! Beds are large: what is kept are bytes, which stand in the checkpoint as text.

use super::build::Parts;
use super::soil::SoilBelow;
use super::step::{Coupled, Spent, StandingBed};
use super::underway::Underway;
use super::{Books, Live};
use crate::nodes::NodeError;
use crate::solvers::continuum::State;
use crate::solvers::granular::{Bed, Checkpoint, WallId};
use crate::solvers::track::LeapfrogState;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Content of [`Live`].
#[derive(Serialize, Deserialize)]
struct Stored {
    time_step: f64,
    rail: LeapfrogState,
    /// Level of the supports beyond the grains, m.
    settlement_of_supports: Vec<f64>,
    beds: Vec<StoredBed>,
    pushes: Vec<f64>,
    books: Books,
    underway: Option<Underway>,
}

#[derive(Serialize, Deserialize)]
struct StoredBed {
    bed: Checkpoint<f32>,
    sleepers: Vec<(WallId, usize)>,
    soil: Option<State>,
}

impl Live {
    /// The state as data.
    pub fn save(&self) -> Result<serde_json::Value, NodeError> {
        let Coupled { rail, beds, pushes, .. } = &self.coupled;
        let bed = |standing: &StandingBed| StoredBed {
            bed: standing.bed.checkpoint(),
            sleepers: standing.sleepers.clone(),
            soil: standing.soil.as_ref().map(SoilBelow::store),
        };
        let stored = Stored {
            time_step: rail.time_step(),
            rail: rail.state().clone(),
            settlement_of_supports: rail.level().settlements.clone(),
            beds: beds.iter().map(bed).collect(),
            pushes: pushes.clone(),
            books: self.books.clone(),
            underway: self.underway.clone(),
        };
        let bytes = postcard::to_stdvec(&stored).map_err(foreign)?;
        Ok(serde_json::Value::String(STANDARD.encode(bytes)))
    }

    /// The track on these parts that was saved.
    pub fn restore(parts: Parts<'_>, state: &serde_json::Value) -> Result<Live, NodeError> {
        let text = state.as_str().ok_or_else(|| foreign("it holds no grains"))?;
        let bytes = STANDARD.decode(text).map_err(foreign)?;
        let Stored { time_step, rail: motion, settlement_of_supports, beds, pushes, books, mut underway } =
            postcard::from_bytes(&bytes).map_err(foreign)?;
        let seats = parts.track.seats.len();
        if books.beyond.len() != seats
            || settlement_of_supports.len() != seats
            || beds.len() != parts.grains.stretches.len()
        {
            return Err(foreign("it holds another number of seats or beds"));
        }
        let mut rail = parts.rail(&books.beyond, time_step)?;
        let mut level = rail.level().clone();
        level.settlements = settlement_of_supports;
        rail.set_level(&level)?;
        match underway.as_mut().and_then(|underway| underway.ride.as_mut()) {
            Some(ride) if ride.on_rail => ride.motion = Some(motion),
            _ => rail.restore(&motion)?,
        }
        let standing = |(number, stored): (usize, StoredBed)| -> Result<StandingBed, NodeError> {
            let bed = Bed::restore(stored.bed).map_err(foreign)?;
            let soil = match (stored.soil, parts.soil) {
                (Some(state), Some(node)) => {
                    Some(SoilBelow::restore(&bed, parts.floor(number), parts.lies(number), node, state)?)
                }
                (None, None) => None,
                _ => return Err(foreign("it holds soil that the scene does not have, or lacks the soil of the scene")),
            };
            Ok(StandingBed { bed, sleepers: stored.sleepers, soil })
        };
        let beds: Vec<StandingBed> = beds.into_iter().enumerate().map(standing).collect::<Result<_, _>>()?;
        if pushes.len() != rail.carried().len() || books.stiffness.len() != pushes.len() {
            return Err(foreign("it holds another number of sleepers"));
        }
        Ok(Live { coupled: Coupled { rail, beds, pushes, added: 0.0, spent: Spent::default() }, books, underway })
    }
}

fn foreign(why: impl ToString) -> NodeError {
    NodeError::Foreign { node: "grains under the track", why: why.to_string() }
}
