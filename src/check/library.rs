//! The standard library, embedded: files in the language itself.

use crate::diag::FileId;
use crate::syntax::parse;
use crate::syntax::tree::{Declaration, Item, ValueKind};

/// Modules by name, with their text.
pub(super) const MODULES: &[(&str, &str)] = &[
    ("ballasts", include_str!("../../stdlib/ballasts.track")),
    ("gradings", include_str!("../../stdlib/gradings.track")),
    ("laws", include_str!("../../stdlib/laws.track")),
    ("pads", include_str!("../../stdlib/pads.track")),
    ("rails", include_str!("../../stdlib/rails.track")),
    ("slabs", include_str!("../../stdlib/slabs.track")),
    ("sleepers", include_str!("../../stdlib/sleepers.track")),
    ("soils", include_str!("../../stdlib/soils.track")),
    ("subballasts", include_str!("../../stdlib/subballasts.track")),
    ("usps", include_str!("../../stdlib/usps.track")),
    ("vehicles", include_str!("../../stdlib/vehicles.track")),
];

/// An entry of the standard library, as it is declared.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// `pads`
    pub module: &'static str,
    pub kind: String,
    pub name: String,
    /// The `///` lines above it.
    pub doc: String,
    pub source: String,
    /// `read`, `derived` or `unchecked`.
    pub evidence: String,
}

/// Every entry of the standard library, module by module, in the order of their files.
pub fn library() -> Vec<Entry> {
    let of_module = |(module, text): &(&'static str, &str)| {
        let (tree, _) = parse(FileId(0), text);
        let entries = tree.items.into_iter().filter_map(|item| match item {
            Item::Declaration(declaration) => entry(module, declaration),
            _ => None,
        });
        entries.collect::<Vec<_>>()
    };
    MODULES.iter().flat_map(of_module).collect()
}

fn entry(module: &'static str, declared: Declaration) -> Option<Entry> {
    let field = |name: &str| match &declared.fields.iter().find(|f| f.path.text() == name)?.value.kind {
        ValueKind::Text(text) => Some(text.clone()),
        ValueKind::Path(path) => Some(path.text()),
        _ => None,
    };
    let lines: Vec<&str> = declared.docs.iter().map(|line| line.trim()).collect();
    Some(Entry {
        module,
        kind: declared.kind.text.clone(),
        name: declared.name.as_ref()?.text.clone(),
        doc: lines.join(" "),
        source: field("source").unwrap_or_default(),
        evidence: field("evidence").unwrap_or_default(),
    })
}
