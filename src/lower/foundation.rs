//! Supports of seats from their layers: a function of plain data; each result is computed once.

use crate::scenario::{ApproachSlab, Stack};
use crate::solvers::foundation::{Bearing, Below, Footing, FoundationError, Layer, Method};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// Poisson's ratio of concrete.
const CONCRETE: f64 = 0.2;
/// Odemark's correction for a plate on softer ground.
const ODEMARK: f64 = 0.9;

/// Support of one seat from its layers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Pressure on the lowest layer for each newton on the seat, 1/m^2.
    pub onto_subgrade: f64,
    /// Stiffness / stiffness of the layers before the stretch.
    pub change: f64,
}

/// Stiffness, N/m, and pressure on the lowest layer for each newton, 1/m^2.
type Found = Result<(f64, f64), FoundationError>;

/// A sleeper's half on a stack of layers.
type Stacked = (Bearing, Vec<Layer>);

/// A stack that is not computed yet, with its key.
type Question<'a> = (&'a Vec<u64>, &'a Stacked);

/// The method for layers, and the results so far.
pub(super) struct Foundations {
    method: Method,
    /// Whether the lowest layer is infinitely deep.
    quiet_base: bool,
    /// Results by the bits of the input.
    found: HashMap<Vec<u64>, Found>,
    footings: HashMap<Vec<u64>, Footing>,
}

/// Thickness of ground that spreads a load like a plate on it, m: `0.9 t (E / E_ground)^(1/3)` (Odemark 1949).
fn equivalent(plate: &ApproachSlab, ground: f64) -> f64 {
    *plate.thickness * (ODEMARK * (*plate.youngs_modulus / ground).cbrt()).max(1.0)
}

/// Layers with a plate that replaces the layers at its depth. The compliance of the ground below is multiplied by
/// `yields`.
///
/// In the stress cone the plate spreads the load like its [`equivalent`] thickness of the ground below. A hinge holds
/// the end of the plate. The plate rotates about the hinge as a rigid body: at a distance s from the hinge it moves by
/// s / L of the far end, and a load at s rotates it by s / L of the rotation under the same load at the far end. The
/// compliance of the ground below is therefore multiplied by `(s / L)^2`.
fn with_plate(layers: Vec<Layer>, plate: &ApproachSlab, yields: f64) -> Vec<Layer> {
    let (top, bottom) = (*plate.depth, *plate.depth + *plate.thickness);
    let (mut above, mut below) = (Vec::new(), Vec::new());
    let mut ground = None;
    let mut z = 0.0;
    for layer in layers {
        let end = z + layer.thickness;
        let part = |from: f64, to: f64| Layer { thickness: (to - from).max(0.0), ..layer };
        if z < top {
            above.push(part(z, end.min(top)));
        }
        if end > bottom {
            ground = ground.or(Some(layer));
            let youngs_modulus = (layer.youngs_modulus / yields).min(layer.youngs_modulus.max(*plate.youngs_modulus));
            below.push(Layer { youngs_modulus, ..part(z.max(bottom), end) });
        }
        z = end;
    }
    let spread = match ground.or(above.last().copied()) {
        Some(ground) => (equivalent(plate, ground.youngs_modulus) / *plate.thickness * ground.spread.tan()).atan(),
        None => 0.0,
    };
    above.push(Layer {
        thickness: *plate.thickness,
        youngs_modulus: *plate.youngs_modulus,
        poisson_ratio: CONCRETE,
        density: *plate.density,
        spread,
    });
    above.extend(below);
    above
}

fn key(bearing: &Bearing, stack: &[Layer]) -> Vec<u64> {
    let plan = [bearing.width, bearing.length, bearing.spacings[0], bearing.spacings[1]];
    let layer = |l: &Layer| [l.thickness, l.youngs_modulus, l.poisson_ratio, l.spread];
    plan.into_iter().chain(bearing.to_centre).chain(stack.iter().flat_map(layer)).map(f64::to_bits).collect()
}

/// The result for one stack under a bearing.
fn solve(footing: &mut Footing, stack: &[Layer], quiet_base: bool) -> Found {
    let below = match stack.last() {
        Some(ground) if quiet_base => {
            Below::HalfSpace { youngs_modulus: ground.youngs_modulus, poisson_ratio: ground.poisson_ratio }
        }
        _ => Below::Rigid,
    };
    let support = footing.support(stack, below)?;
    Ok((support.stiffness, support.pressures[stack.len() - 1]))
}

impl Foundations {
    /// Starts without results.
    pub fn new(method: Method, quiet_base: bool) -> Foundations {
        Foundations { method, quiet_base, found: HashMap::new(), footings: HashMap::new() }
    }

    /// The supports from stacks of layers, in their order.
    ///
    /// # Errors
    ///
    /// If the layers of a seat, or the layers before a stretch, cannot carry a sleeper.
    pub fn carried(&mut self, stacks: &[&Stack]) -> Vec<Result<Carried, FoundationError>> {
        let with = |stack: &&Stack, plate: &ApproachSlab, yields: f64| {
            (stack.bearing, with_plate(stack.layers.clone(), plate, yields))
        };
        let whole = |stack: &&Stack| match &stack.plate {
            Some((plate, lever)) => with(stack, plate, lever * lever),
            None => (stack.bearing, stack.layers.clone()),
        };
        let pressed = |stack: &&Stack| stack.plate.as_ref().map(|(plate, _)| with(stack, plate, 1.0));
        let before = |stack: &&Stack| stack.before.as_ref().map(|layers| (stack.bearing, layers.clone()));
        let found = self.answers(&stacks.iter().map(whole).collect::<Vec<_>>());
        let mut pressed = self.answers(&stacks.iter().filter_map(pressed).collect::<Vec<_>>()).into_iter();
        let mut before = self.answers(&stacks.iter().filter_map(before).collect::<Vec<_>>()).into_iter();
        let carried = |(stack, found): (&&Stack, Found)| {
            let pressed = stack.plate.as_ref().and_then(|(_, lever)| Some((*lever, pressed.next()?)));
            let before = stack.before.as_ref().and_then(|_| before.next());
            let (stiffness, onto_subgrade) = found?;
            // the structure carries the part of the load on a hinged plate that the ground does not carry
            let onto_subgrade = match pressed {
                Some((lever, Ok((_, pressure)))) => lever * pressure,
                _ => onto_subgrade,
            };
            let change = before.transpose()?.map_or(1.0, |(before, _)| stiffness / before);
            Ok(Carried { stiffness, onto_subgrade, change })
        };
        stacks.iter().zip(found).map(carried).collect()
    }

    /// Results in the order of the input; each is computed once, and different bearings are computed in parallel.
    fn answers(&mut self, asked: &[Stacked]) -> Vec<Found> {
        let Foundations { method, quiet_base, found, footings } = self;
        let keys: Vec<Vec<u64>> = asked.iter().map(|(bearing, stack)| key(bearing, stack)).collect();
        let missing: BTreeMap<&Vec<u64>, &Stacked> =
            keys.iter().zip(asked).filter(|(key, _)| !found.contains_key(*key)).collect();
        // most scenes state their supports: without a thread pool a check takes a tenth less time
        if missing.is_empty() {
            return keys.iter().map(|key| found[key]).collect();
        }
        // keys begin with the bearing, so stacks under the same bearing are adjacent
        let missing: Vec<Question<'_>> = missing.into_iter().collect();
        let groups = missing.chunk_by(|(_, (a, _)), (_, (b, _))| a == b).map(|group| {
            let bearing = group[0].1.0;
            let footing = footings.remove(&key(&bearing, &[]));
            (footing.unwrap_or_else(|| Footing::new(bearing, *method)), group)
        });
        let mut groups: Vec<(Footing, &[Question<'_>])> = groups.collect();
        let answers: Vec<Vec<Found>> = groups
            .par_iter_mut()
            .map(|(footing, group)| group.iter().map(|(_, (_, stack))| solve(footing, stack, *quiet_base)).collect())
            .collect();
        found.extend(missing.iter().map(|(key, _)| (*key).clone()).zip(answers.into_iter().flatten()));
        footings.extend(groups.into_iter().map(|(footing, group)| (key(&group[0].1.0, &[]), footing)));
        keys.iter().map(|key| found[key]).collect()
    }
}
