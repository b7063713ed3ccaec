//! Surfaces of grains: read from files, or taken from the library, and closed.

use super::given::{Arguments, argument};
use crate::check::evaluate::value::{Slot, Val};
use crate::check::findings::Findings;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Surface, Surfaces};
use crate::schema::{Need, Word};
use crate::solvers::granular::grains::stl;
use std::sync::Arc;

/// Surfaces of the library by the words that name them.
const LIBRARY: &[(&str, &[u8])] = &[
    ("blocky", include_bytes!("../../../stdlib/shapes/blocky.stl")),
    ("flat", include_bytes!("../../../stdlib/shapes/flat.stl")),
    ("elongated", include_bytes!("../../../stdlib/shapes/elongated.stl")),
    ("bladed", include_bytes!("../../../stdlib/shapes/bladed.stl")),
    ("worn", include_bytes!("../../../stdlib/shapes/worn.stl")),
];

/// Arguments for the form of angular shapes; they have no effect if surfaces are given.
const OF_ANGULAR: [&str; 4] = ["templates", "flatness", "elongation", "roundness"];

/// The surfaces that clumps fill.
pub fn grain_surfaces(
    word: &Word,
    arguments: &Arguments,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Surfaces> {
    let Some(from) = arguments.get("from") else {
        return Some(Surfaces::Angular {
            templates: argument(arguments, "templates").map(|n| *n as u32)?,
            flatness: argument(arguments, "flatness")?,
            elongation: argument(arguments, "elongation")?,
            roundness: argument(arguments, "roundness")?,
        });
    };
    let sound = one_form(word, arguments, from, findings);
    let Val::List(slots) = &from.value else { return None };
    if slots.is_empty() {
        let mistake = Diagnostic::new(Code::E0406, "expected at least one surface, found an empty list");
        findings.report(mistake.label(from.span, "no surface").help("leave `from` out for angular shapes"));
        return None;
    }
    let surfaces: Vec<Option<Surface>> = slots.iter().map(|slot| grain_surface(slot, files, findings)).collect();
    sound?;
    surfaces.into_iter().collect::<Option<_>>().map(Surfaces::Meshes)
}

/// Refuses indices of angular shapes beside surfaces. Values equal to the defaults are accepted.
fn one_form(word: &Word, arguments: &Arguments, from: &Slot, findings: &mut Findings) -> Option<()> {
    let mut sound = Some(());
    for name in OF_ANGULAR {
        let Some(slot) = arguments.get(name) else { continue };
        if slot.origin.span().is_none() || is_default(word, name, slot) {
            continue;
        }
        findings.report(
            Diagnostic::new(Code::E0407, format!("`from` and `{name}` both give the shapes of grains"))
                .label(slot.span, "for angular shapes")
                .label(from.span, "these surfaces have forms of their own")
                .help(format!("keep one of the two: `{name}` applies to the shapes that are generated without `from`")),
        );
        sound = None;
    }
    sound
}

fn grain_surface(slot: &Slot, files: &mut Files<'_>, findings: &mut Findings) -> Option<Surface> {
    let Val::Word { word, arguments } = &slot.value else { return None };
    if word.name != "file" {
        let bytes = LIBRARY.iter().find(|(name, _)| *name == word.name)?.1;
        return Some(Surface { name: word.name.into(), mesh: Arc::new(stl::read(bytes).ok()?) });
    }
    let Some(Slot { value: Val::Text(name), span, .. }) = arguments.get("name") else { return None };
    let mesh = files.surface(name, *span, findings)?;
    Some(Surface { name: name.clone(), mesh })
}

/// Whether an argument equals its default.
fn is_default(word: &Word, name: &str, slot: &Slot) -> bool {
    let field = word.arguments.iter().find(|field| field.name == name);
    let (Some(Need::Default(text)), Val::Number(given)) = (field.map(|f| f.need), &slot.value) else { return false };
    text.parse() == Ok(given.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema;

    #[test]
    fn every_surface_of_the_library_has_its_word_and_its_form() {
        let granular = schema::kind("granular").unwrap();
        let shape = granular.field("shape").unwrap();
        let clumps = shape.form.words().into_iter().find(|word| word.name == "clumps").unwrap();
        let from = clumps.arguments.iter().find(|field| field.name == "from").unwrap();
        let words: Vec<&str> = from.form.words().iter().map(|word| word.name).filter(|name| *name != "file").collect();
        assert_eq!(words, LIBRARY.iter().map(|(name, _)| *name).collect::<Vec<_>>());
        for word in from.form.words().into_iter().filter(|word| word.name != "file") {
            let bytes = LIBRARY.iter().find(|(name, _)| *name == word.name).unwrap().1;
            let form = crate::solvers::granular::grains::GrainForm::of_surface(&stl::read(bytes).unwrap());
            let said = |index: &str| {
                let rest = word.doc.split(index).nth(1).unwrap().trim_start();
                rest.split([',', ' ']).next().unwrap().parse::<f64>().unwrap()
            };
            assert!((form.flatness() / said("flatness") - 1.0).abs() < 0.01, "{}", word.name);
            assert!((form.elongation() / said("elongation") - 1.0).abs() < 0.01, "{}", word.name);
        }
    }
}
