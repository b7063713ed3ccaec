//! The support of each seat from the layers under it, and what stretches make of these.

use super::Checker;
use super::geometry::Places;
use super::tier::Asked;
use super::trackform::Built;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Layer, Material, SleeperBody};
use crate::solvers::foundation::{self, Bearing, Below};
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

/// Layers with a plate in them that displaces what it fills.
///
/// In the stress cone a plate spreads the load as its equivalent of the ground below would (Odemark 1949):
/// `h = 0.9 t (E / E_below)^(1/3)`. A hinge keeps its end in place. A stiff plate that turns about it moves by s / L of its far
/// end at a distance s, and a load there turns it by s / L of what it would at the far end: the compliance of the ground below
/// goes with `(s / L)^2`.
fn with_plate(layers: Vec<foundation::Layer>, plate: &ApproachSlab, x: f64) -> Vec<foundation::Layer> {
    let (top, bottom) = (*plate.depth, *plate.depth + *plate.thickness);
    let [structure, far] = plate.ends;
    let share = ((x - structure) / (far - structure)).abs().clamp(AT_HINGE, 1.0);
    let yields = if plate.hinged { share * share } else { 1.0 };
    let (mut above, mut below) = (Vec::new(), Vec::new());
    let mut z = 0.0;
    for layer in layers {
        let end = z + layer.thickness;
        let part = |from: f64, to: f64| foundation::Layer { thickness: (to - from).max(0.0), ..layer };
        if z < top {
            above.push(part(z, end.min(top)));
        }
        if end > bottom {
            let youngs_modulus = (layer.youngs_modulus / yields).min(layer.youngs_modulus.max(*plate.youngs_modulus));
            below.push(foundation::Layer { youngs_modulus, ..part(z.max(bottom), end) });
        }
        z = end;
    }
    let ratio = below.first().map_or(1.0, |ground| *plate.youngs_modulus * yields / ground.youngs_modulus);
    let rate = below.first().or(above.last()).map_or(0.0, |ground| ground.spread.tan());
    let equivalent = ODEMARK * ratio.max(1.0).cbrt();
    above.push(foundation::Layer {
        thickness: *plate.thickness,
        youngs_modulus: *plate.youngs_modulus,
        poisson_ratio: CONCRETE,
        density: *plate.density,
        spread: (equivalent.max(1.0) * rate).atan(),
    });
    above.extend(below);
    above
}

impl Asked {
    fn support(&self, bearing: &Bearing, stack: &[foundation::Layer]) -> Result<(f64, f64), foundation::FoundationError> {
        let below = match stack.last() {
            Some(ground) if self.quiet_base => Below::HalfSpace {
                youngs_modulus: ground.youngs_modulus,
                poisson_ratio: ground.poisson_ratio,
            },
            _ => Below::Rigid,
        };
        let support = foundation::support(bearing, stack, below, self.support_method)?;
        Ok((support.stiffness, support.pressures[stack.len() - 1]))
    }
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
        let unknown: Vec<&super::layers::Stratum> = strata.iter().filter(|s| s.modulus_unknown()).collect();
        if !unknown.is_empty() {
            if depends && !self.asked.layers_do {
                unknown.into_iter().for_each(|stratum| self.without_modulus(&built.name, stratum));
                return None;
            }
            return Some(Vec::new());
        }
        let layers = match under {
            Under::Section(None) if !depends => return Some(Vec::new()),
            Under::Section(layers) => Some(layers?.to_vec()),
            Under::Regraded(regrade) => self.lay_strata(built, places, section, seats.clone(), Some(regrade.before)),
        }?;
        let plate = regrade.and_then(|regrade| regrade.plate);
        let mut found: Vec<Carried> = Vec::with_capacity(seats.len());
        let mut last: Option<(Bearing, Vec<foundation::Layer>, Option<Vec<foundation::Layer>>)> = None;
        for seat in seats {
            let x = places.seats[seat].0;
            let bearing = bearing(&body, places.spacings(seat, built.spacing.map_or(0.6, |s| *s)));
            let mut stack_here = stack(&layers, x)?;
            if let Some(plate) = &plate {
                stack_here = with_plate(stack_here, plate, x);
            }
            let before = regrade.filter(|regrade| regrade.scales).and_then(|regrade| stack(regrade.before, x));
            let here = (bearing, stack_here, before);
            // most seats lie as their neighbour does
            if let Some(same) = found.last().copied().filter(|_| last.as_ref() == Some(&here)) {
                found.push(same);
                continue;
            }
            let (bearing, stack_here, before) = &here;
            let name = places.named(&(seat..seat + 1));
            let found_here = self.asked.support(bearing, stack_here);
            if found_here.is_err() && !depends {
                return Some(Vec::new());
            }
            let (stiffness, onto_subgrade) = self.bears_on(built, &name, found_here)?;
            let change = match before {
                Some(before) => stiffness / self.bears_on(built, &name, self.asked.support(bearing, before))?.0,
                None => 1.0,
            };
            found.push(Carried { stiffness, onto_subgrade, change });
            last = Some(here);
        }
        Some(found)
    }

    fn bears_on(
        &mut self,
        built: &Built,
        seat: &str,
        found: Result<(f64, f64), foundation::FoundationError>,
    ) -> Option<(f64, f64)> {
        match found {
            Ok(found) => Some(found),
            Err(wrong) => {
                let message = format!("the layers of trackform `{}` carry no sleeper at {seat}: {wrong}", built.name);
                self.report(
                    Diagnostic::new(Code::E0407, message)
                        .at(built.layers_span, "its support is computed from these")
                        .help("give every layer a thickness and a modulus there, and sleepers that do not lie on each other"),
                );
                None
            }
        }
    }

    fn without_modulus(&mut self, form: &str, stratum: &super::layers::Stratum) {
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
