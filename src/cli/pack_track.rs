//! `trackbed pack --bays`: packed cells side by side, as the bed of a whole track.

use super::{Format, progress, terminal};
use crate::diag::{Code, Diagnostic};
use crate::graph::BedRecipe;
use crate::results;
use crate::solvers::granular::packing::{Order, Packed, Recipe, TrackBed, lay};
use crate::store::Directory;
use std::num::NonZeroU32;
use std::path::Path;

/// How many cells, and of how many kinds
#[derive(clap::Args)]
pub(super) struct TrackArguments {
    /// Lay this many cells side by side, with held grains at the ends, and bring them to rest
    #[arg(long, value_name = "N")]
    bays: Option<NonZeroU32>,
    /// Pack so many cells, each from a seed of its own, and mix them by chance
    #[arg(long, value_name = "N", default_value = "1", requires = "bays")]
    cells: NonZeroU32,
}

impl TrackArguments {
    /// Plans of the further cells: the same but for their seeds.
    pub fn further(&self, plan: &BedRecipe) -> Vec<BedRecipe> {
        let cells = if self.bays.is_some() { u64::from(self.cells.get()) } else { 1 };
        let with = |seed: u64| BedRecipe { recipe: Recipe { seed, ..plan.recipe.clone() }, ..plan.clone() };
        (1..cells).map(|more| with(plan.recipe.seed.wrapping_add(more))).collect()
    }

    /// The bed of the track; `None` where only the cell is wanted.
    pub fn lay(&self, cells: &[Packed<f32>], plan: &BedRecipe) -> Option<Result<TrackBed<f32>, Diagnostic>> {
        let bays = self.bays?.get() as usize;
        let order = Order::mixed(cells.len(), bays, plan.recipe.seed);
        let mut bar = progress::Patient::new("the bed of the track");
        let laid = lay(cells, &order, &plan.recipe, |progress| bar.show((1e4 * progress.share) as u64, 10_000));
        Some(laid.map_err(|error| {
            Diagnostic::new(Code::E0810, error.to_string())
                .help("mix fewer cells: copies of one fit each other grain by grain")
        }))
    }
}

/// Says what became of it, and writes it beside the cell.
pub(super) fn tell(laid: &mut TrackBed<f32>, out: Option<&Path>, format: Format) -> Result<(), String> {
    let account = &laid.account;
    let mut ends = format!("{} more are held at its ends", account.held_at_ends);
    if account.removed_at_seams > 0 {
        let (removed, mass) = (account.removed_at_seams, 100.0 * account.removed_mass);
        ends += &format!("; {removed} were in the way where unlike cells meet ({mass:.2} % of the mass)");
    }
    // JSON is that of the cell; the track has its own file
    let say = if format == Format::Json { terminal::note } else { terminal::summary };
    say(&format!(
        "\ntrack of {} bays: {:.1} m, {} grains; {ends}; at rest after {:.3} s ({} steps), forces \
         out of balance by {:.1e}\n",
        account.order.len(),
        account.length,
        account.bodies,
        account.time,
        account.steps,
        account.unbalance
    ));
    let Some(out) = out else { return Ok(()) };
    let failure = |error: &dyn std::fmt::Display| format!("cannot write the bed: {error}");
    let snapshot = laid.bed.snapshot().map_err(|error| failure(&error))?;
    let mut bodies = Vec::new();
    results::bodies_vtk(&results::grains(&laid.bed, &snapshot, None), &mut bodies).map_err(|error| failure(&error))?;
    let json = serde_json::to_vec_pretty(&laid.account).map_err(|error| failure(&error))?;
    // the cell lies there already
    let mut directory = Directory::amend(out).map_err(|error| failure(&error))?;
    directory
        .stage("track.vtp", &bodies)
        .and_then(|()| directory.stage("track.json", &json))
        .and_then(|()| directory.commit().map(drop))
        .map_err(|error| failure(&error))
}
