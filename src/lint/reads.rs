//! Fields that only physics rules read.

use crate::graph::{Graph, Work};
use crate::schema::{Reader, Reads};

/// Limits of rule L1022 for a plan.
const BUDGET: Reads = Reads { fields: &["solve.budget"], acts_where: "where this version can run the plan" };
const MEMORY: Reads =
    Reads { fields: &["solve.memory"], acts_where: "where there are rails and this version can run the plan" };
/// The step that rule L1020 checks; a test rig chooses its own step.
const GRAIN_STEP: Reads = Reads {
    fields: &["solve.grain_step"],
    acts_where: "where grains lie under a track: `substructure = cells`, `zone` or `full`",
};

/// Fields of a scene that physics rules read, and whether a rule applies to the plan.
pub fn readers(graph: &Graph) -> Vec<Reader> {
    let passages = matches!(graph.cost.work, Work::Passages(_));
    let grains_under_track = graph.has_grains_under_track();
    vec![
        Reader { reads: &BUDGET, acted: graph.runs },
        Reader { reads: &MEMORY, acted: graph.runs && passages },
        Reader { reads: &GRAIN_STEP, acted: grains_under_track },
    ]
}
