//! The standard library, embedded: files in the language itself.

use crate::diag::{FileId, Span};
use crate::schema::{KINDS, Need};
use crate::syntax::parse;
use crate::syntax::tree::{Declaration, Item, ValueKind};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Modules by name, with their text.
pub const MODULES: &[(&str, &str)] = &[
    ("ballasts", include_str!("../../../stdlib/ballasts.track")),
    ("gradings", include_str!("../../../stdlib/gradings.track")),
    ("laws", include_str!("../../../stdlib/laws.track")),
    ("pads", include_str!("../../../stdlib/pads.track")),
    ("rails", include_str!("../../../stdlib/rails.track")),
    ("slabs", include_str!("../../../stdlib/slabs.track")),
    ("sleepers", include_str!("../../../stdlib/sleepers.track")),
    ("soils", include_str!("../../../stdlib/soils.track")),
    ("subballasts", include_str!("../../../stdlib/subballasts.track")),
    ("usps", include_str!("../../../stdlib/usps.track")),
    ("vehicles", include_str!("../../../stdlib/vehicles.track")),
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
    /// The entry of the same module that it extends.
    pub base: Option<String>,
    /// Paths of its own fields with their values as written, without source and evidence.
    pub fields: Vec<(String, String)>,
}

/// Every entry of the standard library, module by module, in the order of their files.
pub fn library() -> Vec<Entry> {
    MODULES.iter().flat_map(|(module, text)| entries(module, text)).collect()
}

fn entries(module: &'static str, text: &str) -> Vec<Entry> {
    let (tree, _) = parse(FileId(0), text);
    let declared = tree.items.into_iter().filter_map(|item| match item {
        Item::Declaration(declaration) => entry(module, text, declaration),
        _ => None,
    });
    declared.collect()
}

/// The part of the library that a check reads. Reading the whole library takes longer than checking most scenes.
#[derive(Clone)]
pub enum Part {
    Whole,
    Named(BTreeSet<Key>),
}

/// Module and name of an entry.
type Key = (&'static str, &'static str);

/// For longer texts the whole library is read, because it is short beside them.
const LONGEST: usize = 1 << 16;

impl Part {
    /// Entries that these texts and the defaults of fields name in full, and the entries that these name or extend.
    pub fn named_in<'t>(texts: impl Iterator<Item = &'t str> + Clone) -> Part {
        if texts.clone().map(str::len).sum::<usize>() > LONGEST {
            return Part::Whole;
        }
        let of_module = |(module, text): &(&'static str, &'static str)| {
            (*module, outline(text).map(|(name, place)| (name, &text[place])).collect())
        };
        let entries: Entries = MODULES.iter().map(of_module).collect();
        let mut named = BTreeSet::new();
        let asked = texts.chain(defaults()).flat_map(full_names);
        let mut unread: Vec<Key> = asked.filter_map(|name| known(&entries, name)).collect();
        while let Some(key) = unread.pop() {
            if named.insert(key) {
                let declared = entries[key.0][key.1];
                let base = base(declared).map(|name| (key.0, name));
                unread.extend(full_names(declared).chain(base).filter_map(|name| known(&entries, name)));
            }
        }
        Part::Named(named)
    }

    /// Whether an entry is read.
    fn has(&self, key: Key) -> bool {
        match self {
            Part::Whole => true,
            Part::Named(named) => named.contains(&key),
        }
    }

    /// A module's text, with unread parts replaced by blanks, so that read parts keep their place.
    pub(super) fn text_of(&self, module: &'static str, text: &'static str) -> Cow<'static, str> {
        if let Part::Whole = self {
            return Cow::Borrowed(text);
        }
        let mut read = String::with_capacity(text.len());
        for (name, place) in outline(text) {
            read.push_str(&text[read.len()..place.start]);
            if self.has((module, name)) {
                read.push_str(&text[place]);
            } else {
                // a comment is skipped as a whole
                read.push_str("//");
                read.extend(std::iter::repeat_n(' ', place.len() - 2));
            }
        }
        read.push_str(&text[read.len()..]);
        Cow::Owned(read)
    }
}

fn defaults<'t>() -> impl Iterator<Item = &'t str> + Clone {
    KINDS.iter().flat_map(|kind| kind.fields).filter_map(|field| match field.need {
        Need::Default(text) => Some(text),
        _ => None,
    })
}

/// Texts of the entries of each module.
type Entries = BTreeMap<&'static str, BTreeMap<&'static str, &'static str>>;

fn known(entries: &Entries, (module, name): (&str, &str)) -> Option<Key> {
    let (module, entries) = entries.get_key_value(module)?;
    Some((module, entries.get_key_value(name)?.0))
}

/// `rails.UIC60`, anywhere in a line, with the text behind it.
fn full_names(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let part = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    text.split(move |c| !part(c)).filter_map(|path| {
        let (module, rest) = path.split_once('.')?;
        Some((module, rest.split('.').next()?))
    })
}

/// `concrete` of `sleeper wide : concrete {`.
fn base(declared: &str) -> Option<&str> {
    let header = declared.lines().find(|line| !line.starts_with("///"))?;
    header.split_once(" : ")?.1.split(' ').next()
}

/// The declarations of a module by name, each with its `///` lines. The library is formatted: a declaration ends with
/// the first line that is a bracket alone.
fn outline(text: &'static str) -> impl Iterator<Item = (&'static str, Range<usize>)> {
    let (mut at, mut start, mut name) = (0, None, None);
    text.split_inclusive('\n').filter_map(move |line| {
        let (from, line) = (at, line.trim_end_matches('\n'));
        at += line.len() + 1;
        let mut words = line.split([' ', ':']);
        match line {
            "}" => return Some((name.take()?, start.take()?..from + 1)),
            "" => start = None,
            _ if line.starts_with("///") => {
                start.get_or_insert(from);
            }
            _ if line.ends_with('{') && !line.starts_with(' ') => {
                start.get_or_insert(from);
                name = words.nth(1);
            }
            _ => {}
        }
        None
    })
}

fn entry(module: &'static str, text: &str, declared: Declaration) -> Option<Entry> {
    let field = |name: &str| match &declared.fields.iter().find(|f| f.path.text() == name)?.value.kind {
        ValueKind::Text(text) => Some(text.clone()),
        ValueKind::Path(path) => Some(path.text()),
        _ => None,
    };
    let lines: Vec<&str> = declared.docs.iter().map(|line| line.trim()).collect();
    let value = |span: Span| text.get(span.start as usize..span.end as usize).unwrap_or_default().to_string();
    let own = declared.fields.iter().filter(|field| !["source", "evidence"].contains(&field.path.text().as_str()));
    let fields = own.map(|field| (field.path.text(), value(field.value.span))).collect();
    Some(Entry {
        module,
        kind: declared.kind.text.clone(),
        name: declared.name.as_ref()?.text.clone(),
        doc: lines.join(" "),
        source: field("source").unwrap_or_default(),
        evidence: field("evidence").unwrap_or_default(),
        base: declared.base.as_ref().map(|path| path.text()),
        fields,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_has_every_entry_and_a_part_keeps_places() {
        for (module, text) in MODULES {
            let (tree, _) = parse(FileId(0), text);
            let declared: Vec<&Declaration> = tree
                .items
                .iter()
                .filter_map(|item| match item {
                    Item::Declaration(declaration) => Some(declaration),
                    _ => None,
                })
                .collect();
            let names: Vec<&str> = declared.iter().filter_map(|d| Some(d.name.as_ref()?.text.as_str())).collect();
            assert_eq!(outline(text).map(|(name, _)| name).collect::<Vec<_>>(), names, "{module}");
            for one in &declared {
                let name = outline(text).find(|(name, _)| *name == one.name.as_ref().unwrap().text).unwrap().0;
                let (part, mistakes) = parse(FileId(0), &Part::Named([(*module, name)].into()).text_of(module, text));
                let found: Vec<_> = part.items.iter().filter(|item| !matches!(item, Item::Use(_))).collect();
                assert!(mistakes.is_empty());
                assert_eq!(found, [&Item::Declaration((*one).clone())], "{module}.{name}");
            }
        }
    }

    #[test]
    fn entries_bring_what_they_name() {
        let Part::Named(named) = Part::named_in(["grains = ballasts.granite_31_63 // and nothing else"].into_iter())
        else {
            panic!("not the whole")
        };
        let ballast = ["clumps_32_80", "granite_31_63"].map(|name| ("ballasts", name));
        let gradings = ["ballast_31_63", "ballast_32_80"].map(|name| ("gradings", name));
        let asked: BTreeSet<Key> = ballast.into_iter().chain(gradings).collect();
        assert!(named.is_superset(&asked) && !named.contains(&("rails", "UIC60")), "{named:?}");
    }
}
