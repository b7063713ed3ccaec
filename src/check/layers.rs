//! The layers under the sleepers of a trackform, laid along its section, and the bed that holds them.

use super::Checker;
use super::geometry::Places;
use super::material::Ground;
use super::seats::{Along, Cover, Laid};
use super::track::given;
use super::trackform::Built;
use super::value::{Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Base, Bed, BedEnds, Given, Layer, Material, Soil, Varying};
use crate::units::number;

/// Grains across a layer below which it is no layer.
const FEWEST_GRAINS: f64 = 2.0;

/// A layer before it is laid along the track.
pub(super) struct Stratum {
    name: String,
    ground: Ground,
    thickness: Along,
    /// Where the thickness stands.
    span: Span,
}

impl From<Laid> for Varying {
    fn from(laid: Laid) -> Varying {
        match laid {
            Laid::Fixed(given) => Varying::Constant(given),
            Laid::Varies(profile) => Varying::Profile(profile),
        }
    }
}

impl Checker<'_> {
    /// The layers of a trackform, downwards; `None` where one is not understood.
    pub(super) fn strata(&mut self, form: &Record) -> Option<Vec<Stratum>> {
        let Some(slot) = form.get("layers") else { return Some(Vec::new()) };
        let Val::Pairs(pairs) = &slot.value else { return None };
        let strata: Vec<Option<Stratum>> = pairs.iter().map(|(key, thickness)| self.stratum(key, thickness)).collect();
        strata.into_iter().collect()
    }

    fn stratum(&mut self, key: &Slot, thickness: &Slot) -> Option<Stratum> {
        let material = if let Val::Record(record) = &key.value { Some(record) } else { None };
        let ground = material.and_then(|record| self.ground(record));
        let along = match &thickness.value {
            Val::Number(n) => Along::Fixed(Given { value: n.value, origin: thickness.origin }),
            Val::Profile(shape) => Along::Varies(shape.clone(), thickness.origin),
            Val::Word { .. } => {
                self.report(
                    Diagnostic::new(Code::E0421, "only the layers of a stretch can take what is left")
                        .at(thickness.span, "left of what?")
                        .help(
                            "a stretch keeps the depth of the trackform under it; a trackform itself says every thickness, such as `1 m`",
                        ),
                );
                return None;
            }
            _ => return None,
        };
        Some(Stratum { name: material?.name.clone(), ground: ground?, thickness: along, span: thickness.span })
    }

    /// The layers of a section.
    pub(super) fn lay_layers(&mut self, built: &Built, places: &Places, section: usize) -> Option<Vec<Layer>> {
        let (start, end) = places.sections[section];
        let cover = |what: &str, layer: &str| Cover {
            what: format!("the {what} of layer `{layer}` of trackform `{}`", built.name),
            start,
            end,
            seats: Some(places.seats_of(section)),
            smooth: false,
        };
        let mut layers = Vec::new();
        let mut sound = true;
        for stratum in built.layers.as_ref()? {
            let thickness = self.lay(&stratum.thickness, places, &cover("thickness", &stratum.name));
            let material = match &stratum.ground {
                Ground::Granular(granular) => Some(Material::Granular(granular.clone())),
                Ground::Soil { youngs_modulus, poisson_ratio, density, strength } => {
                    self.lay(youngs_modulus, places, &cover("Young's modulus", &stratum.name)).map(|youngs_modulus| {
                        let (poisson_ratio, density, strength) = (*poisson_ratio, *density, *strength);
                        Material::Soil(Soil { youngs_modulus: youngs_modulus.into(), poisson_ratio, density, strength })
                    })
                }
            };
            let (Some(thickness), Some(material)) = (thickness, material) else {
                sound = false;
                continue;
            };
            let layer = Layer { name: stratum.name.clone(), material, thickness: thickness.into() };
            sound &= self.holds_its_grains(&layer, stratum.span);
            layers.push(layer);
        }
        Some(layers).filter(|_| sound)
    }

    /// A layer is thicker than a grain or two.
    fn holds_its_grains(&mut self, layer: &Layer, span: Span) -> bool {
        let Some(granular) = layer.granular() else { return true };
        let (thickness, largest) = (layer.thickness.largest(), granular.grading.largest());
        let needed = FEWEST_GRAINS * largest;
        if thickness >= needed * (1.0 - 1e-9) {
            return true;
        }
        let mm = |length: f64| number((length * 1e4).round() / 10.0);
        let mut mistake = Diagnostic::new(
            Code::E0511,
            format!("layer `{}` of {} mm is thinner than two of its grains", layer.name, mm(thickness)),
        )
        .at(span, format!("its largest grain has {} mm", mm(largest)));
        if let Some(cut) = granular.grading.cut_above.and_then(|cut| cut.origin.span()) {
            mistake = mistake.at(cut, "grains up to this size");
        }
        self.report(
            mistake.help(format!("make it {} mm or more, or cut the grading with a smaller `cut_above`", mm(needed))),
        );
        false
    }

    /// The bed, whose side walls leave room for the longest sleeper.
    pub(super) fn bed(&mut self, track: &Record, forms: &[Built]) -> Option<Bed> {
        let half_width = match track.get("bed_width") {
            Some(_) => Some(given(track, "bed_width")?),
            None => None,
        };
        let length = |built: &Built| {
            let sleeper = built.sleeper.as_ref()?;
            Some((sleeper.number("length")?.value, sleeper.get("length")?.origin.span(), built.name.clone()))
        };
        let longest = forms.iter().filter_map(length).max_by(|a, b| a.0.total_cmp(&b.0));
        if let (Some(half), Some((length, origin, name))) = (half_width, longest)
            && 2.0 * *half < length * (1.0 - 1e-9)
        {
            let span = track.get("bed_width").map_or(track.span, |slot| slot.span);
            let message = format!(
                "the bed is {} m wide, but the sleepers of trackform `{name}` are {} m long",
                number(2.0 * *half),
                number(length)
            );
            let mut mistake = Diagnostic::new(Code::E0420, message).at(span, "between its side walls");
            if let Some(origin) = origin {
                mistake = mistake.at(origin, "length of a sleeper");
            }
            self.report(mistake.help(format!(
                "write `bed_width = {} m per track` or more, or leave it out: the bed is then as wide as the sleepers",
                number(length)
            )));
            return None;
        }
        Some(Bed {
            half_width,
            ends: if track.word("bed_ends")? == "periodic" { BedEnds::Periodic } else { BedEnds::Walls },
            base: if track.word("base")? == "quiet" { Base::Quiet } else { Base::Rigid },
        })
    }
}
