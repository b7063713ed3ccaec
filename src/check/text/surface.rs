//! Surfaces of grains from STL files: closed bodies, or all faults of the surface.

use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Sources, Span};
use crate::solvers::granular::grains::stl::{self, StlError};
use crate::solvers::granular::shape::{FaultKind, Mesh, MeshFault};
use crate::units::number;

/// A closed surface from the bytes of a file; `None` if a diagnostic has been given.
pub fn read(name: &str, bytes: &[u8], span: Span, sources: &mut Sources, findings: &mut Findings) -> Option<Mesh> {
    let error = match stl::read(bytes) {
        Ok(mesh) => return Some(mesh),
        Err(error) => error,
    };
    let mistake = match &error {
        StlError::Mesh(faults) => not_closed(name, &faults.faults).label(span, "read here"),
        StlError::Bodies { count } => {
            Diagnostic::new(Code::E0607, format!("`{name}` holds {count} bodies, but a grain is one body"))
                .label(span, "read here")
                .help("keep the largest body, or write each into a file of its own and list them all")
        }
        StlError::Text { bytes: at, .. } => {
            // the part that could be read is text
            let text = String::from_utf8_lossy(bytes).into_owned();
            let file = sources.add(name, text, false);
            Diagnostic::new(Code::E0606, format!("`{name}` cannot be read as STL: {error}"))
                .label(Span::new(file, at.start, at.end), "unexpected text")
                .label(span, "read here")
                .help("write the file again, preferably as binary STL")
        }
        StlError::NotStl | StlError::Cut { .. } => {
            Diagnostic::new(Code::E0606, format!("`{name}` cannot be read as STL: {error}"))
                .label(span, "read here")
                .help("write the surface as STL, binary or text; every mesh tool can")
        }
    };
    findings.report(mistake);
    None
}

/// All faults of a surface that is not a closed body, with help for the first.
fn not_closed(name: &str, faults: &[MeshFault]) -> Diagnostic {
    let told: Vec<String> = faults.iter().map(one_fault).collect();
    let help = match faults.first().map(|fault| fault.kind) {
        Some(FaultKind::OpenEdge) => "close the holes in a mesh tool: only a closed body has a volume",
        Some(FaultKind::InsideOut) => "turn its normals outward in a mesh tool and write it again",
        Some(FaultKind::Winding) => "make its normals agree in a mesh tool and write it again",
        Some(FaultKind::NonManifoldEdge) => "remove double triangles and walls inside the body",
        Some(FaultKind::Degenerate) => "remove triangles without area with a mesh tool",
        _ => "write the surface of a whole grain",
    };
    Diagnostic::new(Code::E0607, format!("`{name}` is not a closed body: {}", told.join(", "))).help(help)
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
        FaultKind::NonFinite => ("corner that is not a number", "corners that are not numbers"),
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
