//! The support of each seat from the layers under it, and what stretches make of these.

use super::Checker;
use super::geometry::Places;
use super::layers::Stratum;
use super::tier::Asked;
use super::trackform::Built;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Layer, Material, SleeperBody};
use crate::solvers::foundation::{self, Bearing, Below, Footing};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

/// Poisson's ratio of concrete.
const CONCRETE: f64 = 0.2;
/// Odemark's correction for a plate on softer ground.
const ODEMARK: f64 = 0.9;
/// Nearer to its hinge than this share of its length a plate is as stiff as there: the ground must keep a modulus.
const AT_HINGE: f64 = 0.05;

/// The ground of some seats.
#[derive(Clone, Copy)]
pub(super) enum Under<'a> {
    /// That of their section; `None` where it is not understood.
    Section(Option<&'a [Layer]>),
    Regraded(&'a Regrade<'a>),
}

/// What a stretch changes of the layers under some seats.
pub(super) struct Regrade<'a> {
    /// The layers of the section.
    pub before: &'a [Layer],
    pub plate: Option<ApproachSlab>,
    /// Whether the stretch changes what carries and leaves the stated `support` as it is: the support changes as the layers do.
    pub scales: bool,
}

/// What layers are to one seat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    /// N/m.
    pub stiffness: f64,
    /// Pressure on the lowest layer for each newton on the seat, 1/m^2.
    pub onto_subgrade: f64,
    /// Stiffness over that without the stretch.
    pub change: f64,
}

/// Stiffness, N/m, and pressure on the lowest layer for each newton, 1/m^2.
type Found = Result<(f64, f64), foundation::FoundationError>;

/// A sleeper's half on a stack of layers.
type Stacked = (Bearing, Vec<foundation::Layer>);

/// A question that has no answer yet, under its key.
type Question<'a> = (&'a Vec<u64>, &'a Stacked);

/// What has been asked of the ground in a check; seats under several stretches are asked for again.
#[derive(Default)]
pub(super) struct Supports {
    /// Answers by the bits of what was asked.
    found: HashMap<Vec<u64>, Found>,
    footings: HashMap<Vec<u64>, Footing>,
}

/// How half a sleeper lies: its bearing area under the seat as far as the sleeper reaches.
fn bearing(body: &SleeperBody, spacings: [f64; 2]) -> Bearing {
    let half = 0.5 * body.length;
    let length = (0.5 * body.base_area / body.base_width).min(half);
    let to_centre = (0.5 * (body.seat_distance - length)).clamp(0.0, half - length);
    Bearing { width: body.base_width, length, spacings, to_centre: Some(to_centre) }
}

/// Layers at a chainage as continua; `None` where a modulus is not known.
fn stack(layers: &[Layer], x: f64) -> Option<Vec<foundation::Layer>> {
    let continuum = |layer: &Layer| {
        let (poisson_ratio, density, spread) = match &layer.material {
            Material::Granular(granular) => (granular.poisson_ratio, granular.density, granular.spread),
            Material::Soil(soil) => (soil.poisson_ratio, soil.density, soil.spread),
        };
        Some(foundation::Layer {
            thickness: layer.thickness.at(x).max(0.0),
            youngs_modulus: layer.youngs_modulus()?.at(x),
            poisson_ratio: *poisson_ratio,
            density: *density,
            spread: *spread,
        })
    };
    layers.iter().map(continuum).collect()
}

/// Thickness of the ground that spreads a load as a plate on it does, m: `0.9 t (E / E_ground)^(1/3)` (Odemark 1949).
fn equivalent(plate: &ApproachSlab, ground: f64) -> f64 {
    *plate.thickness * (ODEMARK * (*plate.youngs_modulus / ground).cbrt()).max(1.0)
}

/// How far a load is from the hinge of a plate, as share of its length: by the lever, what of the load the ground bears.
fn lever(plate: &ApproachSlab, x: f64) -> f64 {
    let [structure, far] = plate.ends;
    if plate.hinged { ((x - structure) / (far - structure)).abs().clamp(AT_HINGE, 1.0) } else { 1.0 }
}

/// Layers with a plate in them that displaces what it fills. Of its own compliance the ground below keeps the share `yields`.
///
/// In the stress cone it spreads the load as its [`equivalent`] of the ground below. A hinge keeps its end in place. A stiff
/// plate that turns about it moves by s / L of its far end at a distance s, and a load there turns it by s / L of what it
/// would at the far end: the compliance of the ground below goes with `(s / L)^2`.
fn with_plate(layers: Vec<foundation::Layer>, plate: &ApproachSlab, yields: f64) -> Vec<foundation::Layer> {
    let (top, bottom) = (*plate.depth, *plate.depth + *plate.thickness);
    let (mut above, mut below) = (Vec::new(), Vec::new());
    let mut ground = None;
    let mut z = 0.0;
    for layer in layers {
        let end = z + layer.thickness;
        let part = |from: f64, to: f64| foundation::Layer { thickness: (to - from).max(0.0), ..layer };
        if z < top {
            above.push(part(z, end.min(top)));
        }
        if end > bottom {
            ground = ground.or(Some(layer));
            let youngs_modulus = (layer.youngs_modulus / yields).min(layer.youngs_modulus.max(*plate.youngs_modulus));
            below.push(foundation::Layer { youngs_modulus, ..part(z.max(bottom), end) });
        }
        z = end;
    }
    let spread = match ground.or(above.last().copied()) {
        Some(ground) => (equivalent(plate, ground.youngs_modulus) / *plate.thickness * ground.spread.tan()).atan(),
        None => 0.0,
    };
    above.push(foundation::Layer {
        thickness: *plate.thickness,
        youngs_modulus: *plate.youngs_modulus,
        poisson_ratio: CONCRETE,
        density: *plate.density,
        spread,
    });
    above.extend(below);
    above
}

fn key(bearing: &Bearing, stack: &[foundation::Layer]) -> Vec<u64> {
    let plan = [bearing.width, bearing.length, bearing.spacings[0], bearing.spacings[1]];
    let layer = |l: &foundation::Layer| [l.thickness, l.youngs_modulus, l.poisson_ratio, l.spread];
    plan.into_iter().chain(bearing.to_centre).chain(stack.iter().flat_map(layer)).map(f64::to_bits).collect()
}

/// The answer for one stack under a bearing.
fn solve(asked: &Asked, footing: &mut Footing, stack: &[foundation::Layer]) -> Found {
    let below = match stack.last() {
        Some(ground) if asked.quiet_base => {
            Below::HalfSpace { youngs_modulus: ground.youngs_modulus, poisson_ratio: ground.poisson_ratio }
        }
        _ => Below::Rigid,
    };
    let support = footing.support(stack, below)?;
    Ok((support.stiffness, support.pressures[stack.len() - 1]))
}

impl Checker<'_> {
    /// What the layers are to some seats of a section; empty where there are none, or where a modulus is not known and nothing
    /// depends on it.
    pub(super) fn carried(
        &mut self,
        built: &Built,
        places: &Places,
        section: usize,
        seats: Range<usize>,
        under: Under<'_>,
    ) -> Option<Vec<Carried>> {
        let strata = built.layers.as_ref()?;
        let regrade = if let Under::Regraded(regrade) = under { Some(regrade) } else { None };
        let depends = built.stands_on_layers() || regrade.is_some_and(|regrade| regrade.scales);
        let (Some(body), false) = (built.sleeper_body(), strata.is_empty()) else { return Some(Vec::new()) };
        if !self.knows_moduli(built, strata, regrade, depends)? {
            return Some(Vec::new());
        }
        let layers = match under {
            Under::Section(None) if !depends => return Some(Vec::new()),
            Under::Section(layers) => Some(layers?.to_vec()),
            Under::Regraded(regrade) => self.lay_strata(built, places, section, seats.clone(), Some(regrade.before)),
        }?;
        let plate = regrade.and_then(|regrade| regrade.plate);
        let mut asked = Vec::with_capacity(seats.len());
        let (mut pressed, mut before) = (Vec::new(), Vec::new());
        for seat in seats.clone() {
            let x = places.seats[seat].0;
            let bearing = bearing(&body, places.spacings(seat, built.spacing.map_or(0.6, |s| *s)));
            let stack_here = stack(&layers, x)?;
            let stack_here = match &plate {
                Some(plate) => {
                    let share = lever(plate, x);
                    pressed.push((bearing, with_plate(stack_here.clone(), plate, 1.0)));
                    with_plate(stack_here, plate, share * share)
                }
                None => stack_here,
            };
            asked.push((bearing, stack_here));
            let scaled = regrade.filter(|regrade| regrade.scales && !built.stands_on_layers());
            before.extend(scaled.and_then(|regrade| stack(regrade.before, x)).map(|stack| (bearing, stack)));
        }
        let (found, pressed, before) = (self.supports(&asked), self.supports(&pressed), self.supports(&before));
        let mut carried = Vec::with_capacity(seats.len());
        for (i, seat) in seats.enumerate() {
            if found[i].is_err() && !depends {
                return Some(Vec::new());
            }
            let (stiffness, onto_subgrade) = self.held_up(built, places, seat, found[i])?;
            let change = match before.get(i) {
                Some(plain) => stiffness / self.held_up(built, places, seat, *plain)?.0,
                None => 1.0,
            };
            // of the load on a hinged plate the structure bears what the ground does not
            let onto_subgrade = match (&plate, pressed.get(i)) {
                (Some(plate), Some(Ok((_, pressure)))) => lever(plate, places.seats[seat].0) * pressure,
                _ => onto_subgrade,
            };
            carried.push(Carried { stiffness, onto_subgrade, change });
        }
        Some(carried)
    }

    /// Answers in the order of what is asked; each is computed once in a check, and those under different bearings side by
    /// side.
    fn supports(&mut self, asked: &[Stacked]) -> Vec<Found> {
        let settings = self.asked;
        let Supports { found, footings } = &mut self.supports;
        let keys: Vec<Vec<u64>> = asked.iter().map(|(bearing, stack)| key(bearing, stack)).collect();
        let missing: BTreeMap<&Vec<u64>, &Stacked> =
            keys.iter().zip(asked).filter(|(key, _)| !found.contains_key(*key)).collect();
        // keys begin with the bearing, so stacks under the same one stand together
        let missing: Vec<Question<'_>> = missing.into_iter().collect();
        let groups = missing.chunk_by(|(_, (a, _)), (_, (b, _))| a == b).map(|group| {
            let bearing = group[0].1.0;
            let footing = footings.remove(&key(&bearing, &[]));
            (footing.unwrap_or_else(|| Footing::new(bearing, settings.support_method)), group)
        });
        let mut groups: Vec<(Footing, &[Question<'_>])> = groups.collect();
        let answers: Vec<Vec<Found>> = groups
            .par_iter_mut()
            .map(|(footing, group)| group.iter().map(|(_, (_, stack))| solve(&settings, footing, stack)).collect())
            .collect();
        found.extend(missing.iter().map(|(key, _)| (*key).clone()).zip(answers.into_iter().flatten()));
        footings.extend(groups.into_iter().map(|(footing, group)| (key(&group[0].1.0, &[]), footing)));
        keys.iter().map(|key| found[key]).collect()
    }

    fn held_up(&mut self, built: &Built, places: &Places, seat: usize, found: Found) -> Option<(f64, f64)> {
        match found {
            Ok(found) => Some(found),
            Err(wrong) => {
                let seat = places.named(&(seat..seat + 1));
                let message = format!("the layers of trackform `{}` carry no sleeper at {seat}: {wrong}", built.name);
                self.report(
                    Diagnostic::new(Code::E0407, message)
                        .at(built.layers_span, "its support is computed from these")
                        .help(
                            "give every layer a thickness and a modulus there, and sleepers that do not lie on each other",
                        ),
                );
                None
            }
        }
    }

    /// Whether every layer has a modulus; `None` where one has none and something depends on it.
    fn knows_moduli(
        &mut self,
        built: &Built,
        strata: &[Stratum],
        regrade: Option<&Regrade<'_>>,
        depends: bool,
    ) -> Option<bool> {
        let scaled = regrade.filter(|regrade| regrade.scales && !built.stands_on_layers());
        let before = scaled.and_then(|regrade| regrade.before.iter().find(|layer| layer.youngs_modulus().is_none()));
        let unknown: Vec<&Stratum> = strata.iter().filter(|stratum| stratum.modulus_unknown()).collect();
        if unknown.is_empty() && before.is_none() {
            return Some(true);
        }
        if !depends || self.asked.layers_do {
            return Some(false);
        }
        if unknown.is_empty() {
            let name = before.map_or("", |layer| layer.name.as_str());
            let message = format!(
                "granular `{name}` under the stretch needs its `youngs_modulus`: the support changes as the layers do"
            );
            self.report(Diagnostic::new(Code::E0419, message).at(built.layers_span, "compared with the layers under them").help(
                "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or let the stretch state its `support`",
            ));
        }
        unknown.into_iter().for_each(|stratum| self.without_modulus(&built.name, stratum));
        None
    }

    fn without_modulus(&mut self, form: &str, stratum: &Stratum) {
        let (name, at, used): (&str, Span, Span) = stratum.places();
        self.report(
            Diagnostic::new(
                Code::E0419,
                format!("granular `{name}` needs its `youngs_modulus`: the layers of trackform `{form}` carry its sleepers"),
            )
            .at(at, "grains know contacts, not a modulus")
            .at(used, "computed from here down")
            .help(
                "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or state the trackform's `support`",
            ),
        );
    }
}

impl Places {
    /// Distances to the seats on the left and on the right, m; beyond an end of the track as on the other side.
    fn spacings(&self, seat: usize, alone: f64) -> [f64; 2] {
        let x = self.seats[seat].0;
        // without the last digits of differences, so that equal neighbours lie equally
        let apart = |other: f64| ((x - other).abs() * 1e9).round() / 1e9;
        let left = seat.checked_sub(1).map(|i| apart(self.seats[i].0));
        let right = self.seats.get(seat + 1).map(|next| apart(next.0));
        let own = left.or(right).unwrap_or(alone);
        [left.unwrap_or(right.unwrap_or(own)), right.unwrap_or(own)]
    }
}
