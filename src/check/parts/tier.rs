//! Refuses what a scene asks of models of grains and this version cannot run.

use super::asked::{Asked, forms, stands_on_grains, tier};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic};
use crate::scenario::Tier;

/// What runs today in the place of grains.
const INSTEAD: &str = "`--set solve.substructure=law` runs the scene with a settlement law under each sleeper";

/// What of a load is more than a constant force at one place.
fn changes(load: &Record) -> Option<&Slot> {
    let cyclic = load.get("force").filter(|force| matches!(force.value, Val::Word { .. }));
    let moves = load.get("speed").filter(|speed| matches!(speed.value, Val::Number(n) if n.value > 0.0));
    cyclic.or(moves)
}

/// Warns of what needs a tier of grains, once a scene.
pub fn waits_for_grains(solve: &Record, track: &Record, loads: &[Record], asked: Asked, findings: &mut Findings) {
    // what a rig runs is a bed under its sleepers
    if asked.rig && forms(track).all(|form| form.get("rail").is_none()) {
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
            (_, true, _) => "give the trackforms a `rail`, a `pad` and a `support` to run them with `law`".to_string(),
            (.., Some(form)) => {
                format!("give trackform `{}` a `support`, or its grains a `youngs_modulus`; then {INSTEAD}", form.name)
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
        let message = format!("trackform `{}` has no `support`, and grains without a modulus in its layers", form.name);
        let at = form.get("layers").map_or(form.span, |slot| slot.span);
        Diagnostic::new(Code::E0604, message)
            .at(at, "only a model of grains finds their stiffness, and this version cannot run it yet")
            .help(
                "add `support = { stiffness = 50 MN/m per seat }`, or give each granular its `youngs_modulus`, to run it with a settlement law",
            )
    } else {
        return;
    };
    findings.report(mistake);
}
