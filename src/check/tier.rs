//! The tier of the model under the sleepers: what the scene asks for, and what of it this version cannot run.

use super::Checker;
use super::geometry::Places;
use super::track::given;
use super::value::{Number, Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Grains, Tier, Volume, response::Response};
use crate::solvers::foundation::Method;

/// What the parts of a track have to bring along.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    /// Grains give the stiffness of the supports: layers without a modulus do instead of a `support`.
    pub layers_do: bool,
    /// By which layers with a modulus become the support of a sleeper.
    pub support_method: Method,
    /// The lowest layer goes on without end.
    pub quiet_base: bool,
    /// Only test loads on sleepers, or on the bed itself, act: a rail is not needed.
    pub rig: bool,
    /// A plate lies on the bed: sleepers are not needed either.
    pub plate: bool,
    /// Trains run: what is counted is axles.
    pub traffic: bool,
}

/// What runs today in the place of grains.
const INSTEAD: &str = "`--set solve.substructure=law` runs the scene with a settlement law under each sleeper";

pub(super) fn tier(solve: &Record) -> Tier {
    match solve.word("substructure") {
        Some("law") => Tier::Law,
        Some("cells") => Tier::Cells,
        Some("zone") => Tier::Zone,
        Some("full") => Tier::Full,
        _ => Tier::Auto,
    }
}

impl Default for Asked {
    fn default() -> Self {
        let support_method = Method::StressCone;
        Asked { layers_do: false, support_method, quiet_base: false, rig: false, plate: false, traffic: false }
    }
}

impl Asked {
    pub fn of(solve: &Record, track: &Record, traffic: bool, loads: &[Record]) -> Asked {
        let tier = tier(solve);
        let by_layers = tier == Tier::Auto && forms(track).any(stands_on_grains);
        let layers_do = tier.has_grains() || by_layers;
        let on = |load: &Record, words: &[&str]| load.word("on").is_some_and(|word| words.contains(&word));
        let under_load = !loads.is_empty() && loads.iter().all(|load| on(load, &["sleepers", "bed"]));
        let rig = layers_do && !traffic && under_load;
        let plate = rig && loads.iter().all(|load| on(load, &["bed"]));
        let support_method = method(solve).unwrap_or(Method::StressCone);
        let quiet_base = track.word("base") == Some("quiet");
        Asked { layers_do, support_method, quiet_base, rig, plate, traffic }
    }
}

fn method(solve: &Record) -> Option<Method> {
    let Val::Word { word, arguments } = &solve.get("support_method")?.value else { return None };
    if word.name == "stress_cone" {
        return Some(Method::StressCone);
    }
    match arguments.get("neighbours")?.value {
        Val::Number(n) => Some(Method::LayeredElastic { neighbours: n.value }),
        _ => None,
    }
}

fn forms(track: &Record) -> impl Iterator<Item = &Record> {
    let pairs = match track.get("sections").map(|slot| &slot.value) {
        Some(Val::Pairs(pairs)) => pairs.as_slice(),
        _ => &[],
    };
    pairs.iter().filter_map(|(form, _)| if let Val::Record(form) = &form.value { Some(&**form) } else { None })
}

/// What of a load is more than a constant force at one place.
fn changes(load: &Record) -> Option<&Slot> {
    let cyclic = load.get("force").filter(|force| matches!(force.value, Val::Word { .. }));
    let moves = load.get("speed").filter(|speed| matches!(speed.value, Val::Number(n) if n.value > 0.0));
    cyclic.or(moves)
}

pub(super) fn has_layers(form: &Record) -> bool {
    matches!(form.get("layers").map(|slot| &slot.value), Some(Val::Pairs(pairs)) if !pairs.is_empty())
}

/// Whether a trackform has layers and nothing else that carries its sleepers.
pub(super) fn stands_on_layers(form: &Record) -> bool {
    let none = |field: &str| matches!(form.get(field).map(|s| &s.value), None | Some(Val::Word { .. }));
    has_layers(form) && none("slab") && none("support") && form.word("support") != Some("rigid")
}

/// Whether only grains can say how stiff those layers are.
fn stands_on_grains(form: &Record) -> bool {
    let Some(Val::Pairs(pairs)) = form.get("layers").map(|slot| &slot.value) else { return false };
    let without = |record: &Record| record.kind.name == "granular" && record.get("youngs_modulus").is_none();
    stands_on_layers(form) && pairs.iter().any(|(key, _)| matches!(&key.value, Val::Record(r) if without(r)))
}

impl Checker<'_> {
    /// Warns of what needs a tier of grains, once a scene.
    pub(super) fn waits_for_grains(&mut self, solve: &Record, track: &Record, loads: &[Record]) {
        // what a rig runs is a bed under its sleepers
        if self.asked.rig && forms(track).all(|form| form.get("rail").is_none()) {
            return;
        }
        let tier = tier(solve);
        let cyclic = loads.iter().find_map(changes);
        let without = forms(track).find(|form| stands_on_grains(form));
        let slot = solve.get("substructure");
        let mistake = if let (true, Some(slot)) = (tier.has_grains(), slot) {
            let name = solve.word("substructure").unwrap_or_default();
            let help = match (cyclic, forms(track).any(|form| form.get("rail").is_none()), without) {
                (Some(_), ..) => "nothing else runs such a load; a constant one gives the equilibrium".to_string(),
                (_, true, _) => {
                    "give the trackforms a `rail`, a `pad` and a `support` to run them with `law`".to_string()
                }
                (.., Some(form)) => {
                    format!(
                        "give trackform `{}` a `support`, or its grains a `youngs_modulus`; then {INSTEAD}",
                        form.name
                    )
                }
                _ => INSTEAD.to_string(),
            };
            Diagnostic::new(Code::E0604, format!("this version checks the tier `{name}` and cannot run it yet"))
                .at(slot.span, "a model of grains")
                .help(help)
        } else if let Some(load) = cyclic {
            Diagnostic::new(Code::E0604, "this version checks cyclic and moving loads and cannot run them yet")
                .at(load.span, "not a constant force at one place")
                .help("a constant `force` gives the equilibrium of the track under it")
        } else if let (Tier::Auto, Some(form)) = (tier, without) {
            let message =
                format!("trackform `{}` has no `support`, and grains without a modulus in its layers", form.name);
            let at = form.get("layers").map_or(form.span, |slot| slot.span);
            Diagnostic::new(Code::E0604, message)
                .at(at, "only a model of grains finds their stiffness, and this version cannot run it yet")
                .help(
                    "add `support = { stiffness = 50 MN/m per seat }`, or give each granular its `youngs_modulus`, to run it with a settlement law",
                )
        } else {
            return;
        };
        self.report(mistake);
    }

    /// How grains are computed, from a complete `solve`.
    pub(super) fn grains(&mut self, record: &Record, places: &Option<Places>) -> Option<Grains> {
        let window = self.window(record.get("window")?, places);
        let optional = |field: &str| match record.get(field).map(|slot| &slot.value) {
            Some(Val::Number(_)) => Some(given(record, field)),
            Some(Val::Word { .. }) => Some(None),
            _ => None,
        };
        Some(Grains {
            tier: tier(record),
            window: window?,
            monolithic: record.word("coupling")? == "monolithic",
            support_from_passage: record.word("support_from")? == "passage",
            step: optional("grain_step")?,
            zone_size: optional("zone_size")?,
            tolerance: record.number("tolerance")?.value,
            budget: optional("budget")?,
            memory: optional("memory")?,
            both_rails: record.word("symmetry")? == "full",
            repeats: record.number("repeats")?.value as u32,
        })
    }

    /// A span at every transition; on a track without one, from its left end.
    fn window(&mut self, slot: &Slot, places: &Option<Places>) -> Option<Option<Vec<[f64; 2]>>> {
        let (a, b) = match &slot.value {
            Val::Range(a, b) => (*a, *b),
            Val::Word { .. } => return Some(None),
            _ => return None,
        };
        let places = places.as_ref()?;
        let names: Vec<Option<String>> = match places.transitions.as_slice() {
            [] => vec![None],
            several => several.iter().map(|t| Some(t.name.clone())).collect(),
        };
        let mut spans = Vec::new();
        for name in names {
            let mut place = |at: Number| self.chainage(places, at, name.as_deref().map(|n| (n, slot.span)), slot.span);
            let (a, b) = (place(a)?, place(b)?);
            spans.push([a.min(b), a.max(b)]);
        }
        Some(Some(spans))
    }

    /// The shape of the volumes of a record.
    pub(super) fn volume(&mut self, record: &Record) -> Option<Volume> {
        let Val::Word { word, arguments } = &record.get("volume")?.value else { return None };
        let length = |name: &str| match arguments.get(name).map(|slot| &slot.value) {
            Some(Val::Number(n)) => Some(n.value),
            _ => None,
        };
        Some(if word.name == "sphere" {
            Volume::Sphere { radius: length("radius")? }
        } else {
            let across = match arguments.get("across").map(|slot| &slot.value) {
                Some(Val::Word { .. }) => None,
                _ => Some(length("across")?),
            };
            Volume::Box { along: length("along")?, across, height: length("height")? }
        })
    }

    /// Notes what a run without grains does not answer.
    pub(super) fn without_grains(&mut self, quantity: Response, span: Span) {
        let message = format!("`{}` is a response of grains, and this scene runs without them", quantity.name());
        self.report(
            Diagnostic::new(Code::E0422, message)
                .at(span, "not recorded")
                .help("it is kept for runs with `substructure = cells`, `zone` or `full`"),
        );
    }
}
