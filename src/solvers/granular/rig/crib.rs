//! Grains between sleepers and beside their ends: the cribs and the shoulders of a track.
//!
//! They are poured loosely above the bed, fall and come to rest, under their own weight and with their friction, as often as it takes
//! to reach the height. What lies higher is taken away, as a plough does, and the rest comes to rest again. Sleepers bear on the bed
//! meanwhile, and may go down a little.

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

/// Pours at most, and the share of the space that may stay empty below the brim: so much lies between the grains of its surface.
const POURS: u32 = 4;
const EMPTY: f64 = 0.1;
/// Ratio of the dashpots meanwhile, in both directions.
const CALMING: f64 = 0.3;
/// At which grains begin to fall, m/s.
const FALL: f64 = 1.0;
/// First of the streams of chance that pours draw from; those of packing lie below.
const STREAM: u64 = 1 << 52;

/// Fills the space between and beside sleepers that stand on a bed. `tell` hears the share that is done, an estimate.
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

/// Gives contacts dashpots while grains are poured: spheres roll on and on without. Forces at rest do not know them.
fn damp(law: &mut ContactLaw) {
    if let ContactLaw::Linear(Linear { dashpot, .. }) = law {
        *dashpot = Dashpot::Ratio { normal: CALMING, shear: CALMING };
    }
}

/// Sets grains of a solid volume, m3, above the bed, and lets them go.
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
