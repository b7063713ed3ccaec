//! The texts of a scene and its data files, each read once.

use super::modules::{DataError, LARGEST_DATA_FILE, Modules};
use super::surface;
use super::table::Table;
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Sources, Span};
use crate::solvers::granular::shape::Mesh;
use crate::syntax::decode;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// Every text that a check has read, and the source of further texts.
pub struct Files<'m> {
    pub sources: Sources,
    pub modules: &'m dyn Modules,
    /// Data files by name; `None` if they could not be read.
    tables: HashMap<String, Option<Rc<Table>>>,
    /// Surfaces of grains by name, as `tables`.
    surfaces: HashMap<String, Option<Arc<Mesh>>>,
}

impl<'m> Files<'m> {
    /// Begins with the texts that have been loaded.
    pub fn new(sources: Sources, modules: &'m dyn Modules) -> Files<'m> {
        Files { sources, modules, tables: HashMap::new(), surfaces: HashMap::new() }
    }

    /// A data file below the main file's folder; `None` if a diagnostic has been given.
    pub fn table(&mut self, name: &str, span: Span, findings: &mut Findings) -> Option<Rc<Table>> {
        if let Some(known) = self.tables.get(name) {
            return known.clone();
        }
        let table = self.read_table(name, span, findings).map(Rc::new);
        self.tables.insert(name.to_string(), table.clone());
        table
    }

    /// A closed surface from a data file; `None` if a diagnostic has been given.
    pub fn surface(&mut self, name: &str, span: Span, findings: &mut Findings) -> Option<Arc<Mesh>> {
        if let Some(known) = self.surfaces.get(name) {
            return known.clone();
        }
        let bytes = self.data_file(name, span, findings);
        let mesh = bytes.and_then(|bytes| surface::read(name, &bytes, span, &mut self.sources, findings)).map(Arc::new);
        self.surfaces.insert(name.to_string(), mesh.clone());
        mesh
    }

    fn read_table(&mut self, name: &str, span: Span, findings: &mut Findings) -> Option<Table> {
        let bytes = self.data_file(name, span, findings)?;
        let text = match decode(name, &bytes) {
            Ok(text) => text,
            Err(mistake) => {
                findings.report(mistake.label(span, "read here"));
                return None;
            }
        };
        let file = self.sources.add(name, text.as_str(), false);
        let (table, mistakes) = Table::read(file, name, &text);
        let sound = mistakes.is_empty();
        for mistake in mistakes {
            findings.report(mistake.label(span, "read here"));
        }
        table.filter(|_| sound)
    }

    /// The bytes of a data file below the main file's folder; `None` if a diagnostic has been given.
    fn data_file(&self, name: &str, span: Span, findings: &mut Findings) -> Option<Vec<u8>> {
        match self.data(name) {
            Ok(bytes) => Some(bytes),
            Err(error) => {
                findings.report(refusal(name, &error).label(span, "read here"));
                None
            }
        }
    }

    /// The bytes of a data file, if its name stays below the main file's folder.
    fn data(&self, name: &str) -> Result<Vec<u8>, DataError> {
        let plain = |part: &str| !matches!(part, "" | ".." | "~");
        let parts: Vec<&str> = name.split('/').filter(|part| *part != ".").collect();
        if name.contains(['\\', ':', '\0']) || parts.is_empty() || !parts.iter().all(|part| plain(part)) {
            return Err(DataError::Outside);
        }
        let bytes = self.modules.data(Path::new(&parts.join("/")))?;
        let size = bytes.len() as u64;
        if size > LARGEST_DATA_FILE { Err(DataError::TooLarge(size)) } else { Ok(bytes) }
    }
}

fn refusal(name: &str, error: &DataError) -> Diagnostic {
    let (message, help) = match error {
        DataError::Missing => (
            format!("there is no file `{name}` below the main file's folder"),
            "put the file into the folder of the scene or below it, and write its path from there",
        ),
        DataError::Outside => (
            format!("`{name}` does not stay below the main file's folder"),
            "copy the data beside the scene and write `file(\"level.csv\")` or `file(\"data/level.csv\")`",
        ),
        DataError::TooLarge(bytes) => (
            format!("`{name}` has {} MiB, more than {} MiB", bytes.div_ceil(1 << 20), LARGEST_DATA_FILE >> 20),
            "reduce the data: one row every 0.1 m is enough for a wheel",
        ),
        DataError::Unreadable(cause) => {
            (format!("`{name}` cannot be read: {cause}"), "check that it is a file and that you may read it")
        }
    };
    Diagnostic::new(Code::E0508, message).help(help)
}
