//! The beds under a track that a run has reported so far, and their copies in the directory of a run that can be
//! resumed.

use super::under_track::{BedsAtCount, Part, Reference, beds_at_count, reference};
use super::{ResultsError, under_track_files};
use crate::nodes::BedUnderTrack;
use crate::store::{Directory, Piece, StoreError};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Beds of all counts that were told.
#[derive(Default)]
pub struct KeptBeds {
    pub told: Vec<BedsAtCount>,
    /// Places at the first count.
    reference: Option<Reference>,
    pieces: BedPieces,
}

/// Their copies, which a checkpoint names.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct BedPieces {
    reference: Option<Piece>,
    /// Grains and contacts of each count.
    counts: Vec<[Piece; 2]>,
}

impl KeptBeds {
    /// Stores the beds at a count, without a train or under a train.
    pub(super) fn take(&mut self, when: (u64, bool), beds: &[BedUnderTrack<'_>], part: Part) {
        let reference = self.reference.get_or_insert_with(|| reference(beds));
        self.told.push(beds_at_count(when, beds, reference, part));
    }

    /// Copies the beds that have no copy yet, and gives the names of all copies.
    pub(super) fn save(&mut self, directory: &Directory) -> Result<BedPieces, ResultsError> {
        if let (Some(reference), None) = (&self.reference, &self.pieces.reference) {
            let unwritable = |cause| ResultsError::unwritable(directory.path(), cause);
            let bytes = postcard::to_stdvec(reference).map_err(unwritable)?;
            self.pieces.reference = Some(directory.keep("places", &bytes)?);
        }
        for number in self.pieces.counts.len()..self.told.len() {
            let [grains, contacts] = under_track_files::encode(&self.told[number..=number], None, directory.path())?;
            let grains = directory.keep(&format!("grains-{number:04}"), &grains)?;
            self.pieces.counts.push([grains, directory.keep(&format!("contacts-{number:04}"), &contacts)?]);
        }
        Ok(self.pieces.clone())
    }

    /// The beds that a checkpoint names.
    pub(super) fn restore(pieces: BedPieces, directory: &Directory) -> Result<KeptBeds, ResultsError> {
        let told = pieces.read(directory.path(), |piece| directory.read_piece(piece))?;
        let damaged = |cause| ResultsError::malformed(directory.path(), cause);
        let bytes = pieces.reference.as_ref().map(|piece| directory.read_piece(piece)).transpose()?;
        let reference = bytes.map(|bytes| postcard::from_bytes(&bytes)).transpose().map_err(damaged)?;
        Ok(KeptBeds { told, reference, pieces })
    }
}

impl BedPieces {
    /// The beds that they hold; `path` stands in messages only.
    pub(super) fn read(
        &self,
        path: &Path,
        read: impl Fn(&Piece) -> Result<Vec<u8>, StoreError>,
    ) -> Result<Vec<BedsAtCount>, ResultsError> {
        let mut beds = Vec::new();
        for [grains, contacts] in &self.counts {
            beds.extend(under_track_files::decode([read(grains)?, read(contacts)?], path)?);
        }
        Ok(beds)
    }
}
