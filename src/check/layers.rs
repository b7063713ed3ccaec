//! The layers under the sleepers of a trackform, laid along its section, and the bed that holds them.

use super::Checker;
use super::geometry::Places;
use super::material::Ground;
use super::seats::{Along, Cover, Laid};
use super::track::given;
use super::trackform::Built;
use super::value::{Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{
    Base, Bed, BedEnds, Curve, Given, Granular, Layer, Material, Origin, Piece, Profile, Soil, Varying,
};
use crate::units::number;
use std::ops::Range;

/// Grains across a layer below which it is no layer.
const FEWEST_GRAINS: f64 = 2.0;
/// Depths that differ by less are one, m.
pub(super) const TOLERANCE: f64 = 1e-3;

/// Depth of the lowest layer's bottom, m.
pub(super) fn depth(layers: &[Layer], x: f64) -> f64 {
    layers.iter().map(|layer| layer.thickness.at(x)).sum()
}

/// A length in mm, for a message.
pub(super) fn mm(length: f64) -> String {
    number((length * 1e4).round() / 10.0)
}

/// A layer before it is laid along the track.
pub(super) struct Stratum {
    name: String,
    ground: Ground,
    thickness: Thickness,
    /// Where the thickness stands.
    span: Span,
    /// Where the material stands, and where the layer names it.
    material: [Span; 2],
}

enum Thickness {
    Given(Along),
    /// What is left of the depth of the layers that the stretch changes.
    Rest,
}

impl Stratum {
    /// Whether its support cannot be computed.
    pub fn modulus_unknown(&self) -> bool {
        matches!(self.ground, Ground::Granular(_, None))
    }

    /// Name and place of its material, and where the layer names it.
    pub fn places(&self) -> (&str, Span, Span) {
        (&self.name, self.material[0], self.material[1])
    }
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
    /// The layers of a trackform, downwards; `None` where one is not understood. Those of a stretch may say `rest`.
    pub(super) fn strata(&mut self, form: &Record, of_stretch: bool) -> Option<Vec<Stratum>> {
        let Some(slot) = form.get("layers") else { return Some(Vec::new()) };
        let Val::Pairs(pairs) = &slot.value else { return None };
        let strata: Vec<Option<Stratum>> =
            pairs.iter().map(|(key, thickness)| self.stratum(key, thickness, of_stretch)).collect();
        let strata: Vec<Stratum> = strata.into_iter().collect::<Option<_>>()?;
        let mut rests = strata.iter().filter(|stratum| matches!(stratum.thickness, Thickness::Rest));
        if let (Some(first), Some(second)) = (rests.next(), rests.next()) {
            self.report(
                Diagnostic::new(Code::E0423, "two layers cannot both take what is left of the depth")
                    .at(second.span, "again here")
                    .at(first.span, "first here")
                    .help("say the thickness of all layers but one"),
            );
            return None;
        }
        Some(strata)
    }

    fn stratum(&mut self, key: &Slot, thickness: &Slot, of_stretch: bool) -> Option<Stratum> {
        let material = if let Val::Record(record) = &key.value { Some(record) } else { None };
        let ground = material.and_then(|record| self.ground(record));
        let along = match &thickness.value {
            Val::Number(n) => Thickness::Given(Along::Fixed(Given { value: n.value, origin: thickness.origin })),
            Val::Profile(shape) => Thickness::Given(Along::Varies(shape.clone(), thickness.origin)),
            Val::Word { .. } if of_stretch => Thickness::Rest,
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
        let material = material?;
        let places = [material.span, key.span];
        Some(Stratum {
            name: material.name.clone(),
            ground: ground?,
            thickness: along,
            span: thickness.span,
            material: places,
        })
    }

    /// The layers of a trackform under some seats of a section. `before` are those of the section, where a stretch takes their
    /// place.
    pub(super) fn lay_strata(
        &mut self,
        built: &Built,
        places: &Places,
        section: usize,
        seats: Range<usize>,
        before: Option<&[Layer]>,
    ) -> Option<Vec<Layer>> {
        let (start, end) = places.sections[section];
        let cover = |what: &str, layer: &str| Cover {
            what: format!("the {what} of layer `{layer}` of trackform `{}`", built.name),
            start,
            end,
            seats: Some(seats.clone()),
            smooth: false,
        };
        let mut layers = Vec::new();
        let mut rest = None;
        let mut sound = true;
        for (i, stratum) in built.layers.as_ref()?.iter().enumerate() {
            let thickness = match &stratum.thickness {
                Thickness::Given(along) => {
                    self.lay(along, places, &cover("thickness", &stratum.name)).map(Varying::from)
                }
                Thickness::Rest => {
                    rest = Some((i, stratum.span));
                    Some(Varying::Constant(Given::derived(0.0)))
                }
            };
            let mut modulus =
                |along: &Along| self.lay(along, places, &cover("Young's modulus", &stratum.name)).map(Varying::from);
            let material = match &stratum.ground {
                Ground::Granular(granular, along) => match along.as_ref().map(&mut modulus) {
                    Some(None) => None,
                    of_continuum => {
                        let youngs_modulus = of_continuum.flatten();
                        Some(Material::Granular(Box::new(Granular { youngs_modulus, ..(**granular).clone() })))
                    }
                },
                Ground::Soil { youngs_modulus, poisson_ratio, density, spread, strength } => modulus(youngs_modulus)
                    .map(|youngs_modulus| {
                        let (poisson_ratio, density, spread) = (*poisson_ratio, *density, *spread);
                        Material::Soil(Soil { youngs_modulus, poisson_ratio, density, spread, strength: *strength })
                    }),
            };
            let (Some(thickness), Some(material)) = (thickness, material) else {
                sound = false;
                continue;
            };
            layers.push(Layer { name: stratum.name.clone(), material, thickness });
        }
        if !sound {
            return None;
        }
        if let (Some((i, span)), Some(before)) = (rest, before) {
            if before.is_empty() {
                self.report(
                    Diagnostic::new(
                        Code::E0421,
                        "the trackform under the stretch has no layers whose depth could be kept",
                    )
                    .at(span, "left of what?")
                    .help("give the trackform its `layers`, or say every thickness here, such as `1 m`"),
                );
                return None;
            }
            layers[i].thickness = self.left_over(built, &layers, before, places, &seats, span)?;
        }
        Some(layers)
    }

    /// The thickness that keeps the depth of the layers before, exact at seats and where profiles run straight.
    fn left_over(
        &mut self,
        built: &Built,
        layers: &[Layer],
        before: &[Layer],
        places: &Places,
        seats: &Range<usize>,
        span: Span,
    ) -> Option<Varying> {
        let at_seats = places.seats[seats.clone()].iter().map(|seat| seat.0);
        let knots = layers.iter().chain(before).flat_map(|layer| layer.thickness.knots());
        let mut xs: Vec<f64> = knots.chain(at_seats).collect();
        xs.sort_by(f64::total_cmp);
        xs.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let left = |x: f64| depth(before, x) - depth(layers, x);
        if let Some(seat) = seats.clone().find(|seat| left(places.seats[*seat].0) < -TOLERANCE) {
            let x = places.seats[seat].0;
            let message = format!(
                "nothing is left at {}: the other layers are {} mm deep, those under the stretch {} mm",
                places.named(&(seat..seat + 1)),
                mm(depth(layers, x)),
                mm(depth(before, x))
            );
            self.report(Diagnostic::new(Code::E0423, message).at(span, "what is left of the depth").help(format!(
                "make the other layers thinner, or the last layer of trackform `{}` deeper",
                built.name
            )));
            return None;
        }
        let (start, end) = (*xs.first()?, *xs.last()?);
        let points = xs.into_iter().map(|x| [x, left(x).max(0.0)]).collect();
        let piece = Piece { start, end, curve: Curve::Linear(points) };
        Some(Varying::Profile(Profile { pieces: vec![piece], origin: Origin::Derived }))
    }

    /// The layers of a section.
    pub(super) fn lay_layers(&mut self, built: &Built, places: &Places, section: usize) -> Option<Vec<Layer>> {
        let layers = self.lay_strata(built, places, section, places.seats_of(section), None)?;
        self.hold_their_grains(built, &layers).then_some(layers)
    }

    /// Whether each layer is thicker than a grain or two.
    pub(super) fn hold_their_grains(&mut self, built: &Built, layers: &[Layer]) -> bool {
        let spans: Vec<Span> = built.layers.iter().flatten().map(|stratum| stratum.span).collect();
        layers.iter().zip(spans).fold(true, |sound, (layer, span)| self.holds_its_grains(layer, span) && sound)
    }

    fn holds_its_grains(&mut self, layer: &Layer, span: Span) -> bool {
        let Some(granular) = layer.granular() else { return true };
        let (thickness, largest) = (layer.thickness.largest(), granular.grading.largest());
        let needed = FEWEST_GRAINS * largest;
        if thickness >= needed * (1.0 - 1e-9) {
            return true;
        }
        let mut mistake = Diagnostic::new(
            Code::E0511,
            format!("layer `{}` of {} mm is thinner than two of its grains", layer.name, mm(thickness)),
        )
        .at(span, format!("its largest grain has {} mm", mm(largest)));
        if let Some(cut) = granular.grading.cut_above.and_then(|cut| cut.origin.span()) {
            mistake = mistake.at(cut, "grains up to this size");
        }
        let coarse = *granular.scale > 1.0;
        if let Some(scale) = granular.scale.origin.span().filter(|_| coarse) {
            mistake = mistake.at(scale, "grains are modelled larger than they are");
        }
        let smaller = if coarse { ", or model its grains with a smaller `scale`" } else { "" };
        self.report(mistake.help(format!(
            "make it {} mm or more, or cut the grading with a smaller `cut_above`{smaller}",
            mm(needed)
        )));
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
