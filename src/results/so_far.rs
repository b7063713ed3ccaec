//! Results so far of an unfinished run: stored beside its checkpoints, and readable while the run goes on.

use super::files::json;
use super::kept_beds::BedPieces;
use super::{ResultsError, Run, RunRecorder, histories};
use crate::graph::Clock;
use crate::store::{Directory, Piece, Unfinished};
use serde::{Deserialize, Serialize};

/// Key of the piece beside the checkpoint.
const KEY: &str = "so-far";

/// A run under way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoFar {
    /// The run as if it had ended here, without its expectations.
    pub run: Run,
    /// Blocks that are done end here.
    pub clock: Clock,
    /// The present stage, and the share of this stage that is done.
    pub stage: Option<(String, f64)>,
    /// Seconds of computing up to here, over all parts of the run.
    pub seconds: f64,
    /// Histories of recorded passages: they are kept once, and are not in `run` while this is on a disk.
    recorded: Vec<Piece>,
    /// The same of beds under the track.
    #[serde(default)]
    beds: BedPieces,
}

impl SoFar {
    /// Stores the content of a recorder; these histories and beds are stored as pieces.
    pub(super) fn keep(
        recorder: &RunRecorder<'_>,
        clock: Clock,
        (recorded, beds): (&[Piece], BedPieces),
        directory: &Directory,
    ) -> Result<(), ResultsError> {
        // tests of beds are shown when they are over
        let Some(mut run) = recorder.gather().filter(|run| run.tests.is_none()) else { return Ok(()) };
        run.histories.clone_from(&recorder.tables.settlements);
        run.beds.clear();
        run.summary.expectations.clear();
        run.summary.scalars.retain(|_, scalar| scalar.value.is_finite());
        let (stage, seconds, recorded) = (recorder.stage().cloned(), recorder.seconds(), recorded.to_vec());
        let so_far = SoFar { run, clock, stage, seconds, recorded, beds };
        directory.keep(KEY, &json(&so_far, directory.path())?)?;
        Ok(())
    }

    /// The results so far of the run in a directory; `None` if it has stored nothing yet that can be shown.
    pub fn read(from: &Unfinished) -> Result<Option<SoFar>, ResultsError> {
        let Some(bytes) = from.kept(KEY)? else { return Ok(None) };
        let mut so_far: SoFar =
            serde_json::from_slice(&bytes).map_err(|cause| ResultsError::malformed(&from.path().join(KEY), cause))?;
        let mut recorded = Vec::new();
        for piece in &so_far.recorded {
            recorded.extend(histories::decode_bytes(from.read_piece(piece)?, &from.path().join(&piece.key))?);
        }
        let settlements = std::mem::take(&mut so_far.run.histories);
        so_far.run.histories = [recorded, settlements].concat();
        so_far.run.beds = so_far.beds.read(from.path(), |piece| from.read_piece(piece))?;
        Ok(Some(so_far))
    }
}
