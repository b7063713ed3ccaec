//! Brings in modules: reads every file that a scene uses and makes the names of each known.

use super::library;
use crate::diag::{Code, Diagnostic, FileId, Sources, Span, nearest::nearest};
use crate::schema::{self, Role};
use crate::syntax::tree::{Declaration, Item, Tree, Use};
use crate::syntax::{decode, parse};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Where `use site.gravel` finds `site/gravel.track`.
pub trait Modules {
    /// The bytes of a file below the main file's folder; `None` where there is none.
    fn read(&self, relative: &Path) -> Option<Vec<u8>>;
}

/// Modules in a folder.
pub struct Folder(pub PathBuf);

impl Modules for Folder {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        std::fs::read(self.0.join(relative)).ok()
    }
}

/// No modules but the standard library, for scenes that stand in memory.
pub struct NoModules;

impl Modules for NoModules {
    fn read(&self, _: &Path) -> Option<Vec<u8>> {
        None
    }
}

/// Index of a scope: one file.
pub(super) type ScopeId = usize;

/// One file with its names.
pub(super) struct Scope {
    pub tree: Rc<Tree>,
    pub library: bool,
    /// Declarations and lets by name: indices of items.
    pub names: BTreeMap<String, usize>,
    pub modules: BTreeMap<String, ScopeId>,
}

/// Names that values have, which nothing else may have.
const TAKEN: [&str; 6] = ["none", "auto", "yes", "no", "rest", "all"];

/// Reads files into scopes, each file once.
pub(super) struct Loader<'a> {
    pub sources: Sources,
    pub scopes: Vec<Scope>,
    pub diagnostics: Vec<Diagnostic>,
    modules: &'a dyn Modules,
    /// Scopes by file; `None` while a file is being read.
    known: BTreeMap<String, Option<ScopeId>>,
}

impl<'a> Loader<'a> {
    pub fn new(modules: &'a dyn Modules) -> Self {
        Loader {
            sources: Sources::default(),
            scopes: Vec::new(),
            diagnostics: Vec::new(),
            modules,
            known: BTreeMap::new(),
        }
    }

    /// Reads a text and all that it uses. `edit` may change the tree before its names are taken.
    pub fn load(
        &mut self,
        name: &str,
        text: String,
        library: bool,
        edit: impl FnOnce(&mut Self, &mut Tree),
    ) -> ScopeId {
        self.known.insert(name.to_string(), None);
        let file = self.sources.add(name, text, library);
        let text = self.sources.get(file).text.clone();
        let (mut tree, mistakes) = parse(file, &text);
        self.diagnostics.extend(mistakes);
        edit(self, &mut tree);
        let tree = Rc::new(tree);
        let mut modules = BTreeMap::new();
        for item in &tree.items {
            if let Item::Use(used) = item {
                self.bring_in(used, name, &mut modules);
            }
        }
        let names = self.names(&tree, &modules);
        self.scopes.push(Scope { tree, library, names, modules });
        let id = self.scopes.len() - 1;
        self.known.insert(name.to_string(), Some(id));
        id
    }

    /// A scope in which every module of the standard library is known, for defaults.
    pub fn standard_scope(&mut self) -> ScopeId {
        let file = self.sources.add("defaults", "", true);
        let modules =
            library::MODULES.iter().filter_map(|(name, _)| Some((name.to_string(), self.library(name)?))).collect();
        let tree = Rc::new(Tree { file, items: Vec::new() });
        self.scopes.push(Scope { tree, library: true, names: BTreeMap::new(), modules });
        self.scopes.len() - 1
    }

    fn library(&mut self, module: &str) -> Option<ScopeId> {
        let name = format!("std/{module}.track");
        if let Some(known) = self.known.get(&name) {
            return *known;
        }
        let text = library::MODULES.iter().find(|(n, _)| *n == module)?.1;
        Some(self.load(&name, text.to_string(), true, |_, _| {}))
    }

    fn bring_in(&mut self, used: &Use, user: &str, modules: &mut BTreeMap<String, ScopeId>) {
        let names: Vec<&str> = used.path.names.iter().map(|n| n.text.as_str()).collect();
        if names == ["std"] && used.alias.is_none() {
            for (module, _) in library::MODULES {
                if let Some(scope) = self.library(module) {
                    modules.entry(module.to_string()).or_insert(scope);
                }
            }
            return;
        }
        let alias = used.alias.as_ref().or(used.path.names.last()).map_or(String::new(), |n| n.text.clone());
        let scope = if names[0] == "std" {
            let found = names.get(1).filter(|_| names.len() == 2).and_then(|module| self.library(module));
            if found.is_none() {
                let near = names.get(1).and_then(|n| nearest(n, library::MODULES.iter().map(|(m, _)| *m)));
                self.diagnostics.push(
                    Diagnostic::new(
                        Code::E0204,
                        format!("the standard library has no module `{}`", names[1..].join(".")),
                    )
                    .at(used.path.span, "not found")
                    .maybe_help(near.map(|n| format!("did you mean `use std.{n}`?"))),
                );
            }
            found
        } else {
            self.file(&names, used.path.span, user)
        };
        if let Some(scope) = scope {
            modules.insert(alias, scope);
        }
    }

    fn file(&mut self, names: &[&str], span: Span, user: &str) -> Option<ScopeId> {
        let relative = format!("{}.track", names.join("/"));
        match self.known.get(&relative) {
            Some(Some(scope)) => return Some(*scope),
            Some(None) => {
                self.diagnostics.push(
                    Diagnostic::new(Code::E0206, format!("`{user}` and `{relative}` use each other"))
                        .at(span, "closes the circle")
                        .help("move what both need into a third file"),
                );
                return None;
            }
            None => {}
        }
        let Some(bytes) = self.modules.read(Path::new(&relative)) else {
            self.diagnostics.push(
                Diagnostic::new(Code::E0204, format!("there is no file `{relative}` below the main file's folder"))
                    .at(span, "not found"),
            );
            return None;
        };
        match decode(&relative, &bytes) {
            Ok(text) => Some(self.load(&relative, text, false, |_, _| {})),
            Err(mistake) => {
                self.diagnostics.push(mistake.at(span, "used here"));
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
                        .at(span, "choose another name"),
                );
                continue;
            }
            if let Some(first) = places.get(&name) {
                let mistake = Diagnostic::new(Code::E0202, format!("`{name}` is declared twice"))
                    .at(span, "again here")
                    .at(*first, "first declared here");
                let mistake =
                    if nameless { mistake.help(format!("give each `{name}` a name of its own")) } else { mistake };
                self.diagnostics.push(mistake);
                continue;
            }
            if modules.contains_key(&name) && !nameless {
                self.diagnostics.push(
                    Diagnostic::new(Code::E0202, format!("`{name}` is the name of a module too"))
                        .at(span, "declared here")
                        .help("rename it, or give the module another name with `as`"),
                );
                continue;
            }
            places.insert(name.clone(), span);
            names.insert(name, index);
        }
        self.exclusive(tree);
        names
    }

    /// At most one of the kinds of which a scene has one; traffic or load, not both.
    fn exclusive(&mut self, tree: &Tree) {
        let mut first: BTreeMap<&str, &Declaration> = BTreeMap::new();
        for item in &tree.items {
            let Item::Declaration(d) = item else { continue };
            let once = matches!(schema::kind(&d.kind.text).map(|k| k.role), Some(Role::Scene { once: true }));
            match first.get(d.kind.text.as_str()) {
                // two nameless ones are reported as a name declared twice
                Some(other) if once && (d.name.is_some() || other.name.is_some()) => self.diagnostics.push(
                    Diagnostic::new(Code::E0409, format!("a scene has one `{}`", d.kind.text))
                        .at(d.kind.span, "second here")
                        .at(other.kind.span, "first here"),
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
                    .at(load.kind.span, "a test load")
                    .at(traffic.kind.span, "and traffic"),
            );
        }
    }

    pub fn main_file() -> FileId {
        FileId(0)
    }
}
