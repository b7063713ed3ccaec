//! Loads modules: reads every file that a scene uses and registers its names.

use super::files::Files;
use super::headers;
use super::library::{self, Part};
use super::modules::{DataError, LARGEST_DATA_FILE, Modules, Parsed};
use super::overrides::{self, Override};
use super::scope::{Scope, ScopeId};
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Fix, Help, Sources, Span};
use crate::schema::{self, Role};
use crate::syntax::decode;
use crate::syntax::tree::{Declaration, Item, Name, Tree, Use};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// A text and the user's modules that its lines seem to use.
pub fn seeming_texts<'t>(main: &'t str, modules: &dyn Modules) -> Vec<Cow<'t, str>> {
    let mut texts = vec![Cow::Borrowed(main)];
    let (mut known, mut next) = (BTreeSet::new(), 0);
    while let Some(text) = texts.get(next) {
        let uses = text.lines().filter_map(|line| line.trim().strip_prefix("use ")?.split([' ', '\t', '/']).next());
        // a path that is not made of names is reported when it is read
        let named = uses.filter(|path| path.split('.').all(is_name));
        let files = named.map(|path| format!("{}.track", path.replace('.', "/")));
        let new: Vec<String> = files.filter(|file| known.insert(file.clone())).collect();
        let read = |file: &String| Some(Cow::Owned(String::from_utf8(modules.read(Path::new(file))?).ok()?));
        texts.extend(new.iter().filter_map(read));
        next += 1;
    }
    texts
}

fn is_name(part: &str) -> bool {
    !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Whether a name is another name for the standard library.
fn is_library(name: &str) -> bool {
    ["std", "stdlib", "standard"].contains(&name.to_lowercase().as_str())
}

/// Help for a module that has no file: the standard library, or one of its modules.
fn missing_file(name: &str) -> Option<Help> {
    if is_library(name) {
        return Some(Help {
            said: "the standard library is called `std`: write `use std`".into(),
            writes: vec!["std".into()],
        });
    }
    let module = library::MODULES.iter().any(|(module, _)| *module == name);
    let said = || format!("it is a module of the standard library: write `use std` or `use std.{name}`");
    module.then(|| Help { said: said(), writes: vec!["std".into(), format!("std.{name}")] })
}

/// The mistake of a module whose file cannot be read.
fn unread(relative: &str, names: &[&str], error: &DataError, span: Span) -> Diagnostic {
    let (message, label, help) = match error {
        DataError::Missing => (
            format!("there is no file `{relative}` below the main file's folder"),
            "not found",
            match names {
                [path @ .., "track"] => {
                    let module = path.join(".");
                    let said = format!("write `use {module}`, without the ending");
                    Some(Help { said, writes: vec![module] })
                }
                _ => missing_file(names[0]),
            },
        ),
        DataError::Outside => (
            format!("`{relative}` is a link to a file outside the main file's folder"),
            "not read",
            Some(Help::say("copy the file into the folder of the scene")),
        ),
        DataError::TooLarge(bytes) => (
            format!("`{relative}` has {} MiB, more than {} MiB", bytes.div_ceil(1 << 20), LARGEST_DATA_FILE >> 20),
            "not read",
            Some(Help::say("keep long tables of numbers in a data file: `file(\"level.csv\")`")),
        ),
        DataError::Unreadable(cause) => (
            format!("`{relative}` cannot be read: {cause}"),
            "not read",
            Some(Help::say("check that it is a file and that you may read it")),
        ),
    };
    Diagnostic::new(Code::E0204, message).label(span, label).maybe_advise(span, help)
}

/// The modules that a file brings in.
#[derive(Default)]
struct BroughtIn {
    modules: BTreeMap<String, ScopeId>,
    broken: BTreeSet<String>,
    /// The place at which the file names each module, by name.
    places: BTreeMap<String, Span>,
}

/// Names of values, which no declaration may have.
const TAKEN: [&str; 6] = ["none", "auto", "yes", "no", "rest", "all"];

/// A scene with all files that it uses.
pub struct Loaded<'m> {
    pub files: Files<'m>,
    pub scopes: Vec<Scope>,
    pub main: ScopeId,
    /// The scope of defaults: every module of the standard library is known there.
    pub standard: ScopeId,
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads a text, with some lines edited, and all files that it uses.
pub fn load<'m>(name: &str, text: &str, edits: &[Override], library: Part, modules: &'m dyn Modules) -> Loaded<'m> {
    let mut loader = Loader::new(modules, library);
    let main = loader.load(name, text.to_string(), edits);
    let standard = loader.standard_scope();
    let Loader { sources, scopes, diagnostics, .. } = loader;
    Loaded { files: Files::new(sources, modules), scopes, main, standard, diagnostics }
}

/// Reads files into scopes, each file once.
struct Loader<'a> {
    sources: Sources,
    scopes: Vec<Scope>,
    diagnostics: Vec<Diagnostic>,
    modules: &'a dyn Modules,
    library: Part,
    /// Scopes by file; `None` while a file is being read.
    known: BTreeMap<String, Option<ScopeId>>,
    /// Files being read, each used by the one before it.
    reading: Vec<String>,
}

impl<'a> Loader<'a> {
    fn new(modules: &'a dyn Modules, library: Part) -> Self {
        Loader {
            sources: Sources::default(),
            scopes: Vec::new(),
            diagnostics: Vec::new(),
            modules,
            library,
            known: BTreeMap::new(),
            reading: Vec::new(),
        }
    }

    /// Reads a text, with some lines edited, and all files that it uses.
    fn load(&mut self, name: &str, text: String, edits: &[Override]) -> ScopeId {
        let file = self.sources.add(name, text, false);
        let parsed = self.modules.parsed(file, &self.sources.get(file).text);
        self.scope(name, parsed, false, edits)
    }

    fn scope(&mut self, name: &str, parsed: Parsed, library: bool, edits: &[Override]) -> ScopeId {
        // modules find the main file by its name below its own folder
        let key =
            if self.scopes.is_empty() && self.reading.is_empty() { name.rsplit(['/', '\\']).next() } else { None };
        let key = key.unwrap_or(name).to_string();
        self.known.insert(key.clone(), None);
        self.reading.push(key.clone());
        let Parsed { mut tree, mistakes } = parsed;
        self.diagnostics.extend(mistakes.iter().cloned());
        if !edits.is_empty() {
            overrides::apply(&mut self.sources, &mut self.diagnostics, Arc::make_mut(&mut tree), edits);
        }
        if !library {
            self.diagnostics.extend(headers::mended(&mut tree));
        }
        let mut brought = BroughtIn::default();
        for item in &tree.items {
            if let Item::Use(used) = item {
                self.bring_in(used, &mut brought);
            }
        }
        let BroughtIn { modules, broken, .. } = brought;
        let names = self.names(&tree, &modules);
        self.scopes.push(Scope { tree, library, names, modules, broken });
        let id = self.scopes.len() - 1;
        self.reading.pop();
        self.known.insert(key, Some(id));
        id
    }

    /// A scope in which every module of the standard library is known, for defaults.
    fn standard_scope(&mut self) -> ScopeId {
        let file = self.sources.add("defaults", "", true);
        let modules =
            library::MODULES.iter().filter_map(|(name, _)| Some((name.to_string(), self.library(name)?))).collect();
        let tree = Arc::new(Tree { file, items: Vec::new() });
        let (names, broken) = (BTreeMap::new(), BTreeSet::new());
        self.scopes.push(Scope { tree, library: true, names, modules, broken });
        self.scopes.len() - 1
    }

    fn library(&mut self, module: &str) -> Option<ScopeId> {
        let name = format!("std/{module}.track");
        if let Some(known) = self.known.get(&name) {
            return *known;
        }
        let (module, text) = *library::MODULES.iter().find(|(n, _)| *n == module)?;
        let file = self.sources.add(name.as_str(), text, true);
        let parsed = self.modules.parsed(file, &self.library.text_of(module, text));
        Some(self.scope(&name, parsed, true, &[]))
    }

    fn bring_in(&mut self, used: &Use, brought: &mut BroughtIn) {
        let names: Vec<&str> = used.path.names.iter().map(|n| n.text.as_str()).collect();
        if names == ["std"] && used.alias.is_none() {
            for (module, _) in library::MODULES {
                if let Some(scope) = self.library(module) {
                    brought.modules.entry(module.to_string()).or_insert(scope);
                }
            }
            return;
        }
        let alias = used.alias.as_ref().or(used.path.names.last()).map_or(String::new(), |n| n.text.clone());
        let scope = if names[0] == "std" {
            let found = names.get(1).filter(|_| names.len() == 2).and_then(|module| self.library(module));
            if found.is_none() {
                let near = names.get(1).and_then(|n| nearest(n, library::MODULES.iter().map(|(m, _)| *m)));
                let (message, help) = match &used.alias {
                    Some(alias) if names.len() == 1 => (
                        format!(
                            "`use std` brings in the modules of the standard library; it cannot be renamed to `{}`",
                            alias.text
                        ),
                        Some(Help::say(
                            "write `use std`, and for example `rails.UIC60` for an entry of its module `rails`",
                        )),
                    ),
                    _ if names.len() == 3 => (
                        format!("`{}` is not a module: a module is used as a whole", names.join(".")),
                        Some(Help {
                            said: format!("write `use std`, and `{}` at the place of use", names[1..].join(".")),
                            writes: vec!["std".to_owned()],
                        }),
                    ),
                    _ => (
                        format!("the standard library has no module `{}`", names[1..].join(".")),
                        near.map(|n| Help {
                            said: format!("did you mean `use std.{n}`?"),
                            writes: vec![format!("std.{n}")],
                        }),
                    ),
                };
                let mistake = Diagnostic::new(Code::E0204, message).label(used.path.span, "not found");
                // `use std as s` without its other name
                let without = |alias: &Name| Span { start: used.path.span.end, ..alias.span };
                let alias = used.alias.as_ref().filter(|_| names.len() == 1);
                let plain = alias.map(|alias| Fix::replace(without(alias), "").titled("write `use std`"));
                self.diagnostics.push(mistake.maybe_advise(used.path.span, help).maybe_fix(plain));
                if names.len() != 2 {
                    brought.broken.extend(library::MODULES.iter().map(|(module, _)| module.to_string()));
                }
            }
            found
        } else {
            self.file(&names, used.path.span)
        };
        // no other file has such a name: entries of the library are not reported as missing again
        let of_library = library::MODULES.iter().any(|(module, _)| *module == names[0]);
        if scope.is_none() && names[0] != "std" && (is_library(names[0]) || of_library) {
            brought.broken.extend(library::MODULES.iter().map(|(module, _)| module.to_string()));
        }
        let place = used.alias.as_ref().map_or(used.path.span, |n| n.span);
        if let Some(first) = brought.places.insert(alias.clone(), place)
            && scope.is_none_or(|s| brought.modules.get(&alias) != Some(&s))
        {
            self.diagnostics.push(
                Diagnostic::new(Code::E0202, format!("two modules are called `{alias}`"))
                    .label(place, "again here")
                    .label(first, "first used here")
                    .help(format!("give one of them another name: `use {} as other`", used.path.text())),
            );
            return;
        }
        match scope {
            Some(scope) => {
                brought.modules.insert(alias, scope);
            }
            None => {
                brought.broken.insert(alias);
            }
        }
    }

    fn file(&mut self, names: &[&str], span: Span) -> Option<ScopeId> {
        let relative = format!("{}.track", names.join("/"));
        match self.known.get(&relative) {
            Some(Some(scope)) => return Some(*scope),
            Some(None) => {
                let start = self.reading.iter().position(|f| *f == relative).unwrap_or(0);
                let circle = &self.reading[start..];
                let message = match circle {
                    [one] => format!("`{one}` uses itself"),
                    _ => {
                        let quoted: Vec<String> = circle.iter().map(|f| format!("`{f}`")).collect();
                        let (last, first) =
                            quoted.split_last().map_or((String::new(), &[][..]), |(l, f)| (l.clone(), f));
                        format!("{} and {last} use each other", first.join(", "))
                    }
                };
                let help = format!(
                    "the circle is {} -> {relative}; move the common parts into a file of their own",
                    circle.join(" -> ")
                );
                self.diagnostics
                    .push(Diagnostic::new(Code::E0206, message).label(span, "closes the circle").help(help));
                return None;
            }
            None => {}
        }
        let bytes = match self.modules.data(Path::new(&relative)) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.diagnostics.push(unread(&relative, names, &error, span));
                return None;
            }
        };
        match decode(&relative, &bytes) {
            Ok(text) => Some(self.load(&relative, text, &[])),
            Err(mistake) => {
                self.diagnostics.push(mistake.label(span, "used here"));
                None
            }
        }
    }

    /// Takes the names of a file, each once.
    fn names(&mut self, tree: &Tree, modules: &BTreeMap<String, ScopeId>) -> BTreeMap<String, usize> {
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let mut places: BTreeMap<String, Span> = BTreeMap::new();
        for (index, item) in tree.items.iter().enumerate() {
            let (name, span, nameless) = match item {
                Item::Use(_) => continue,
                Item::Let(l) => (l.name.text.clone(), l.name.span, false),
                Item::Declaration(d) => match &d.name {
                    Some(name) => (name.text.clone(), name.span, false),
                    None => (d.kind.text.clone(), d.kind.span, true),
                },
            };
            if TAKEN.contains(&name.as_str()) {
                self.diagnostics.push(
                    Diagnostic::new(Code::E0207, format!("`{name}` is a word of the language and cannot be a name"))
                        .label(span, "choose another name"),
                );
                continue;
            }
            if let Some(first) = places.get(&name) {
                let mistake = Diagnostic::new(Code::E0202, format!("`{name}` is declared twice"))
                    .label(span, "again here")
                    .label(*first, "first declared here");
                let mistake =
                    if nameless { mistake.help(format!("give each `{name}` a name of its own")) } else { mistake };
                self.diagnostics.push(mistake);
                continue;
            }
            if modules.contains_key(&name) && !nameless {
                self.diagnostics.push(
                    Diagnostic::new(Code::E0202, format!("`{name}` is the name of a module too"))
                        .label(span, "declared here")
                        .help("rename it, or give the module another name with `as`"),
                );
            }
            places.insert(name.clone(), span);
            names.insert(name, index);
        }
        self.exclusive(tree);
        names
    }

    /// Checks that a scene has at most one object of each single kind, and traffic or load, not both.
    fn exclusive(&mut self, tree: &Tree) {
        let mut first: BTreeMap<&str, &Declaration> = BTreeMap::new();
        for item in &tree.items {
            let Item::Declaration(d) = item else { continue };
            let once = matches!(schema::kind(&d.kind.text).map(|k| k.role), Some(Role::Scene { once: true }));
            match first.get(d.kind.text.as_str()) {
                // two nameless ones are reported as a name declared twice
                Some(other) if once && (d.name.is_some() || other.name.is_some()) => self.diagnostics.push(
                    Diagnostic::new(Code::E0409, format!("a scene has one `{}`", d.kind.text))
                        .label(d.kind.span, "second here")
                        .label(other.kind.span, "first here"),
                ),
                Some(_) => {}
                None => {
                    first.insert(&d.kind.text, d);
                }
            }
        }
        if let (Some(traffic), Some(load)) = (first.get("traffic"), first.get("load")) {
            self.diagnostics.push(
                Diagnostic::new(Code::E0409, "a scene has `traffic` or `load`, not both")
                    .label(load.kind.span, "a test load")
                    .label(traffic.kind.span, "and traffic"),
            );
        }
    }
}
