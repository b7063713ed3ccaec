//! The model under the sleepers that the scene needs, and the parts that are therefore required.

use crate::check::evaluate::value::{Record, Val};
use crate::scenario::Tier;

/// Requirements for the parts of a track.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    /// Grains give the stiffness of the supports: layers without a modulus may replace a `support`.
    pub layers_do: bool,
    /// Only test loads on sleepers or on the bed act, or the load is not given yet: a rail is not needed.
    pub rig: bool,
    /// A plate lies on the bed: sleepers are not needed either.
    pub plate: bool,
    /// Trains run, so counts are axles.
    pub traffic: bool,
}

/// The tier that `solve` names.
pub fn tier(solve: &Record) -> Tier {
    match solve.word("substructure") {
        Some("law") => Tier::Law,
        Some("cells") => Tier::Cells,
        Some("zone") => Tier::Zone,
        Some("full") => Tier::Full,
        _ => Tier::Auto,
    }
}

impl Asked {
    /// Reads the requirements of a scene from its complete records.
    pub fn by_scene(solve: &Record, track: &Record, traffic: bool, loads: &[Record]) -> Asked {
        let tier = tier(solve);
        let by_layers = tier == Tier::Auto && forms(track).any(stands_on_grains);
        let layers_do = tier.has_grains() || by_layers;
        // a value that was not understood may be any of them
        let on = |load: &Record, words: &[&str]| {
            load.unknown("on") || load.word("on").is_some_and(|word| words.contains(&word))
        };
        let under_load = !loads.is_empty() && loads.iter().all(|load| on(load, &["sleepers", "bed"]));
        let all_on_bed = !loads.is_empty() && loads.iter().all(|load| on(load, &["bed"]));
        // a missing load is reported itself, not as missing rails and pads, which a rig does not need
        let unsaid = match loads {
            [] => tier.has_grains(),
            loads => loads.iter().any(|load| load.word("on").is_none()),
        };
        let bare = forms(track).all(|form| form.record("rail").is_none() && form.record("pad").is_none());
        let rig = !traffic && (unsaid || under_load && (layers_do || all_on_bed || bare));
        let plate = rig && (unsaid || all_on_bed);
        // a rig for sleepers has grains unless another tier is asked for
        let layers_do = layers_do || rig && tier == Tier::Auto;
        Asked { layers_do, rig, plate, traffic }
    }
}

/// The trackforms of a track, section by section.
pub fn forms(track: &Record) -> impl Iterator<Item = &Record> {
    let pairs = match track.get("sections").map(|slot| &slot.value) {
        Some(Val::Pairs(pairs)) => pairs.as_slice(),
        _ => &[],
    };
    pairs.iter().filter_map(|(form, _)| if let Val::Record(form) = &form.value { Some(&**form) } else { None })
}

/// Whether a trackform has layers.
pub fn has_layers(form: &Record) -> bool {
    matches!(form.get("layers").map(|slot| &slot.value), Some(Val::Pairs(pairs)) if !pairs.is_empty())
}

/// Whether a trackform has layers and nothing else that carries its sleepers.
pub fn stands_on_layers(form: &Record) -> bool {
    let none = |field: &str| matches!(form.get(field).map(|s| &s.value), None | Some(Val::Word { .. }));
    has_layers(form) && none("slab") && none("support") && form.word("support") != Some("rigid")
}

/// Whether only grains can give the stiffness of the layers.
pub fn stands_on_grains(form: &Record) -> bool {
    let Some(Val::Pairs(pairs)) = form.get("layers").map(|slot| &slot.value) else { return false };
    let without = |record: &Record| record.kind.name == "granular" && record.get("youngs_modulus").is_none();
    stands_on_layers(form) && pairs.iter().any(|(key, _)| matches!(&key.value, Val::Record(r) if without(r)))
}
