//! Grains between sleepers and beside their ends: the cribs and the shoulders of a track.
//!
//! Grains are poured loosely above the bed, fall and come to rest under their own weight and with their friction; pours
//! are repeated until the height is reached. Grains above the height are removed, like by a ballast plough, and the
//! rest comes to rest again. During this the sleepers stand on the bed, and may settle a little.

use super::super::bed::Bed;
use super::super::body::BodyId;
use super::super::grains::{Random, grains};
use super::super::lanes::Real;
use super::super::law::{ContactLaw, Dashpot, Linear};
use super::super::listen::Answer;
use super::super::packing::{Room, put, set_loose};
use super::super::walls::WallId;
use super::calm::{AT_REST, POURED};
use super::description::Sleeper;
use super::error::{Resting, RigError, in_cycle};
use super::filling::{Filling, SOLID};
use super::pocket::Pocket;
use super::set_down::until_rest;

/// Largest number of pours, and share of the space below the top level that may stay empty: the voids between the
/// grains of the surface.
const POURS: u32 = 4;
const EMPTY: f64 = 0.1;
/// Ratio of the dashpots during pouring, in both directions.
const CALMING: f64 = 0.3;
/// Speed at which grains begin to fall, m/s.
const FALL: f64 = 1.0;
/// First random stream for pours; the streams for packing are below it.
const STREAM: u64 = 1 << 52;

/// Fills the space between and beside sleepers that stand on a bed. `tell` receives the estimated share that is done.
pub fn fill<R: Real, A: Answer>(
    bed: &mut Bed<R>,
    (sleepers, walls): (&[Sleeper], &[WallId]),
    filling: &Filling,
    mut tell: impl FnMut(f64) -> A,
) -> Result<(), RigError> {
    let laws = bed.laws().clone();
    bed.change_laws(damp);
    let first = bed.len() as u32;
    // a grain fills half of its own height above its centre
    let brim = filling.crib.height + 0.5 * filling.layer.curve.ends()[1];
    let share = |stage: u32, of_it: f64| (f64::from(stage) + of_it) / f64::from(POURS + 1);
    for pour in 0..POURS {
        let pocket = Pocket::around(bed, sleepers, walls, filling);
        let empty = pocket.empty(bed, brim);
        if empty < EMPTY * pocket.area * brim || SOLID * empty < filling.layer.curve.mean_volume() {
            break;
        }
        pour_in(bed, &pocket, filling, (SOLID * empty, pour))?;
        until_rest(bed, walls, (Resting::Crib, &POURED), |of_it| tell(share(pour, of_it)).flow())?;
    }
    let level = Pocket::around(bed, sleepers, walls, filling).underside + filling.crib.height;
    let higher = |body: u32| body >= first && bed.body_state(BodyId(body)).place[2] > level;
    let higher: Vec<bool> = (0..bed.len() as u32).map(higher).collect();
    bed.remove(|body| higher[body.0 as usize]).map_err(in_cycle(0))?;
    until_rest(bed, walls, (Resting::Crib, &AT_REST), |of_it| tell(share(POURS, of_it)).flow())?;
    bed.set_laws(laws);
    tell(1.0);
    Ok(())
}

/// Adds dashpots to contacts while grains are poured: without them spheres roll for a very long time. Forces at rest do
/// not depend on dashpots.
fn damp(law: &mut ContactLaw) {
    if let ContactLaw::Linear(Linear { dashpot, .. }) = law {
        *dashpot = Dashpot::Ratio { normal: CALMING, shear: CALMING };
    }
}

/// Places grains of a solid volume, m3, above the bed, and lets them fall.
fn pour_in<R: Real>(
    bed: &mut Bed<R>,
    pocket: &Pocket,
    filling: &Filling,
    (volume, pour): (f64, u32),
) -> Result<(), RigError> {
    let layer = &filling.layer;
    let mut random = Random::new(filling.seed, STREAM | u64::from(pour));
    let seed = filling.seed.wrapping_add(STREAM | u64::from(pour));
    let sample = layer.curve.sample(volume, seed).map_err(RigError::Grading)?;
    let copies = grains(&sample, layer.templates.len(), seed);
    let room = Room {
        plan: filling.plan,
        periodic: [0, 1].map(|axis| bed.domain().period(axis).is_some()),
        base: bed.pebbles().map(|pebble| pebble.place[2] + pebble.radius).fold(0.0, f64::max),
        area: pocket.area,
        free: &|place, radius| pocket.holds([place[0], place[1]], radius),
    };
    let Some((loose, _)) = set_loose(&copies, &layer.templates, &room, &mut random) else {
        return Err(RigError::NoRoom { layer: layer.name.clone() });
    };
    put(bed, &loose, layer, filling.surface, FALL);
    Ok(())
}
