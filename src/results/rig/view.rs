//! A rig with its last bed as it ended: what its page is made of, kept beside its tables (`rig.json`).

use super::super::files::read_json;
use super::super::{Grain, Link, ResultsError, grains, links};
use super::RigRun;
use crate::solvers::granular::{Bed, Domain, Failure, Real, Wall};
use serde::{Deserialize, Serialize};
use std::path::Path;

pub(super) const VIEW: &str = "rig.json";

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RigView {
    pub run: RigRun,
    pub grains: Vec<Grain>,
    pub links: Vec<Link>,
    pub walls: Vec<Wall>,
    pub domain: Domain,
}

impl RigView {
    pub fn of<R: Real>(run: RigRun, bed: &mut Bed<R>) -> Result<RigView, Failure> {
        let snapshot = bed.snapshot()?;
        let (grains, links) = (grains(bed, &snapshot, None), links(bed, &snapshot));
        Ok(RigView { run, grains, links, walls: bed.walls().to_vec(), domain: *bed.domain() })
    }
}

/// The rig of a directory; `None` where it is of no rig.
pub fn read_rig(directory: &Path) -> Result<Option<RigView>, ResultsError> {
    let path = directory.join(VIEW);
    path.exists().then(|| read_json(&path)).transpose()
}
