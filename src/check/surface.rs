//! Surfaces of grains: read from files, or taken from the library, and closed.

use super::Checker;
use super::material::{Arguments, argument};
use super::value::{Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Surface, Surfaces};
use crate::schema::{Need, Word};
use crate::solvers::granular::grains::stl::{self, StlError};
use crate::solvers::granular::shape::{FaultKind, Mesh, MeshFault};
use crate::units::number;
use std::sync::Arc;

/// Surfaces of the library by the words that name them.
const LIBRARY: &[(&str, &[u8])] = &[
    ("blocky", include_bytes!("../../stdlib/shapes/blocky.stl")),
    ("flat", include_bytes!("../../stdlib/shapes/flat.stl")),
    ("elongated", include_bytes!("../../stdlib/shapes/elongated.stl")),
    ("bladed", include_bytes!("../../stdlib/shapes/bladed.stl")),
    ("worn", include_bytes!("../../stdlib/shapes/worn.stl")),
];

/// What says the form of angular shapes, and nothing where surfaces are given.
const OF_ANGULAR: [&str; 4] = ["templates", "flatness", "elongation", "roundness"];

impl Checker<'_> {
    /// The surfaces that clumps fill.
    pub(super) fn grain_surfaces(&mut self, word: &Word, arguments: &Arguments) -> Option<Surfaces> {
        let Some(from) = arguments.get("from") else {
            return Some(Surfaces::Angular {
                templates: argument(arguments, "templates").map(|n| *n as u32)?,
                flatness: argument(arguments, "flatness")?,
                elongation: argument(arguments, "elongation")?,
                roundness: argument(arguments, "roundness")?,
            });
        };
        let sound = self.one_form(word, arguments, from);
        let Val::List(slots) = &from.value else { return None };
        if slots.is_empty() {
            let mistake = Diagnostic::new(Code::E0406, "expected one surface at least, found an empty list");
            self.report(mistake.at(from.span, "no surface").help("leave `from` out for angular shapes"));
            return None;
        }
        let surfaces: Vec<Option<Surface>> = slots.iter().map(|slot| self.grain_surface(slot)).collect();
        sound?;
        surfaces.into_iter().collect::<Option<_>>().map(Surfaces::Meshes)
    }

    /// Refuses indices of angular shapes beside surfaces. Defaults that are written out say nothing.
    fn one_form(&mut self, word: &Word, arguments: &Arguments, from: &Slot) -> Option<()> {
        let mut sound = Some(());
        for name in OF_ANGULAR {
            let Some(slot) = arguments.get(name) else { continue };
            if slot.origin.span().is_none() || is_default(word, name, slot) {
                continue;
            }
            self.report(
                Diagnostic::new(Code::E0407, format!("`from` and `{name}` both say which shapes grains have"))
                    .at(slot.span, "of angular shapes")
                    .at(from.span, "these surfaces have forms of their own")
                    .help(format!(
                        "keep one of the two: `{name}` is of the shapes that are made where no `from` stands"
                    )),
            );
            sound = None;
        }
        sound
    }

    fn grain_surface(&mut self, slot: &Slot) -> Option<Surface> {
        let Val::Word { word, arguments } = &slot.value else { return None };
        if word.name != "file" {
            let bytes = LIBRARY.iter().find(|(name, _)| *name == word.name)?.1;
            return Some(Surface { name: word.name.into(), mesh: Arc::new(stl::read(bytes).ok()?) });
        }
        let Some(Slot { value: Val::Text(name), span, .. }) = arguments.get("name") else { return None };
        if !self.surfaces.contains_key(name) {
            let mesh = self.read_surface(name, *span).map(Arc::new);
            self.surfaces.insert(name.clone(), mesh);
        }
        let mesh = self.surfaces.get(name).cloned()??;
        Some(Surface { name: name.clone(), mesh })
    }

    /// A closed surface from a file, once.
    fn read_surface(&mut self, name: &str, span: Span) -> Option<Mesh> {
        let bytes = self.data_file(name, span)?;
        let error = match stl::read(&bytes) {
            Ok(mesh) => return Some(mesh),
            Err(error) => error,
        };
        let mistake = match &error {
            StlError::Mesh(faults) => not_closed(name, &faults.faults).at(span, "read here"),
            StlError::Bodies { count } => {
                Diagnostic::new(Code::E0607, format!("`{name}` holds {count} bodies, a grain is one"))
                    .at(span, "read here")
                    .help("keep the largest body, or write each into a file of its own and list them all")
            }
            StlError::Text { bytes: at, .. } => {
                // what could be read so far is text
                let text = String::from_utf8_lossy(&bytes).into_owned();
                let file = self.loader.sources.add(name, text, false);
                Diagnostic::new(Code::E0606, format!("`{name}` cannot be read as STL: {error}"))
                    .at(Span::new(file, at.start, at.end), "does not go on as it must")
                    .at(span, "read here")
                    .help("write the file again, best as binary STL")
            }
            StlError::NotStl | StlError::Cut { .. } => {
                Diagnostic::new(Code::E0606, format!("`{name}` cannot be read as STL: {error}"))
                    .at(span, "read here")
                    .help("write the surface as STL, binary or text; every mesh tool can")
            }
        };
        self.report(mistake);
        None
    }
}

/// Whether an argument says what its default says.
fn is_default(word: &Word, name: &str, slot: &Slot) -> bool {
    let field = word.arguments.iter().find(|field| field.name == name);
    let (Some(Need::Default(text)), Val::Number(given)) = (field.map(|f| f.need), &slot.value) else { return false };
    text.parse() == Ok(given.value)
}

/// All that keeps triangles from being a closed body, with the way out of the first.
fn not_closed(name: &str, faults: &[MeshFault]) -> Diagnostic {
    let told: Vec<String> = faults.iter().map(one_fault).collect();
    let help = match faults.first().map(|fault| fault.kind) {
        Some(FaultKind::OpenEdge) => "close the holes in a mesh tool: only a closed body has a volume",
        Some(FaultKind::InsideOut) => "turn its normals outward in a mesh tool and write it again",
        Some(FaultKind::Winding) => "make its normals agree in a mesh tool and write it again",
        Some(FaultKind::NonManifoldEdge) => "take out double triangles and walls inside the body",
        Some(FaultKind::Degenerate) => "let a mesh tool take out triangles without area",
        _ => "write the surface of a whole grain",
    };
    Diagnostic::new(Code::E0607, format!("`{name}` is no closed body: {}", told.join(", "))).help(help)
}

/// `3 open edges, the first at triangle 12 near (1.2, 0.4, 3)`, in the unit of the file.
fn one_fault(fault: &MeshFault) -> String {
    let (one, several) = match fault.kind {
        FaultKind::OpenEdge => ("open edge", "open edges"),
        FaultKind::InsideOut => ("part inside out", "parts inside out"),
        FaultKind::Winding => {
            ("edge between triangles that face opposite ways", "edges between triangles that face opposite ways")
        }
        FaultKind::NonManifoldEdge => ("edge of more than two triangles", "edges of more than two triangles"),
        FaultKind::Degenerate => ("triangle without area", "triangles without area"),
        FaultKind::Flat => ("part without volume", "parts without volume"),
        FaultKind::NonFinite => ("corner that is no number", "corners that are no numbers"),
        FaultKind::OutOfRange => ("triangle without its corners", "triangles without their corners"),
        FaultKind::TooMany => ("triangle too many", "triangles too many"),
        FaultKind::Empty => return "it has no triangle".into(),
    };
    let what = if fault.count == 1 { one } else { several };
    let short = |x: f64| number((x * 1e4).round() / 1e4);
    let place = fault.places.first().map_or(String::new(), |place| {
        let first = if fault.count == 1 { "at" } else { "the first at" };
        let [x, y, z] = [place.at.x, place.at.y, place.at.z].map(short);
        format!(", {first} triangle {} near ({x}, {y}, {z})", place.number + 1)
    });
    format!("{} {what}{place}", fault.count)
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
