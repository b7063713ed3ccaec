//! The open documents, and the answers to requests about them.

use super::files::{Beside, OpenTexts, Places, Trees};
use super::positions::Lines;
use super::references::Neighbour;
use super::view::View;
use super::worker::{Board, Job, Shown, Worker};
use super::{actions, completion, definition, diagnostics, hints, hover, layout, library, outline, references, tokens};
use crate::check::surveyed_names;
use crate::compile::compile;
use crate::diag;
use crate::report::drawing_svg;
use crate::syntax;
use lsp_types::{
    CodeAction, CompletionItem, Diagnostic, DocumentHighlight, DocumentSymbol, Hover, InlayHint, Location, Position,
    Range, SemanticToken, TextDocumentContentChangeEvent, TextEdit, Url, WorkspaceEdit,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// A text that is open in the editor.
struct Document {
    text: Arc<str>,
    lines: Lines,
    version: i32,
    path: Option<PathBuf>,
    /// The analysed text, computed on request.
    view: Option<Rc<View>>,
}

/// All open documents of an editor.
pub struct Session {
    documents: BTreeMap<Url, Document>,
    trees: Arc<Trees>,
    /// Folder of the files of the standard library.
    library: PathBuf,
    /// Folders of the workspace.
    roots: Vec<PathBuf>,
    /// Documents whose diagnostics must be computed again.
    stale: BTreeSet<Url>,
    board: Board,
    worker: Worker,
}

impl Session {
    /// Starts without documents.
    pub fn new(library: PathBuf, roots: Vec<PathBuf>, board: Board) -> Session {
        let worker = Worker::start(board.clone());
        let (documents, stale) = (BTreeMap::new(), BTreeSet::new());
        Session { documents, trees: Arc::default(), library, roots, stale, board, worker }
    }

    pub fn open(&mut self, address: Url, version: i32, text: &str) {
        let path = address.to_file_path().ok();
        let document = Document { text: text.into(), lines: Lines::new(text), version, path, view: None };
        self.documents.insert(address.clone(), document);
        self.changed(&address);
    }

    pub fn close(&mut self, address: &Url) {
        self.changed(address);
        self.documents.remove(address);
        self.stale.remove(address);
        self.board.close(address);
    }

    /// Applies edits in their order; an edit without a range replaces the whole text.
    pub fn edit(&mut self, address: &Url, version: i32, changes: &[TextDocumentContentChangeEvent]) {
        let Some(document) = self.documents.get_mut(address) else { return };
        let mut moved = self.board.shown(address).of_plan;
        for change in changes {
            document.text = match change.range {
                None => change.text.as_str().into(),
                Some(range) => {
                    shift(&mut moved, range, &change.text);
                    let start = document.lines.offset(&document.text, range.start);
                    let end = document.lines.offset(&document.text, range.end).max(start);
                    format!("{}{}{}", &document.text[..start], change.text, &document.text[end..]).into()
                }
            };
            document.lines = Lines::new(&document.text);
        }
        document.version = version;
        self.board.keep(address, moved);
        self.changed(address);
    }

    /// Marks a document with a new text, and the documents that use it, for a new analysis.
    fn changed(&mut self, address: &Url) {
        let path = self.documents.get(address).and_then(|document| document.path.clone());
        for (other, document) in &mut self.documents {
            let uses = |view: &Rc<View>| {
                let sources = &view.survey.checked.sources;
                let folder = view.places.folder.as_ref();
                path.as_ref().is_some_and(|path| {
                    sources.iter().any(|(_, s)| !s.library && folder.is_some_and(|f| f.join(&s.name) == *path))
                })
            };
            if other == address || document.view.as_ref().is_none_or(uses) {
                document.view = None;
                self.stale.insert(other.clone());
            }
        }
    }

    /// Marks all documents after a file has changed outside the editor.
    pub fn changed_on_disk(&mut self) {
        for (address, document) in &mut self.documents {
            document.view = None;
            self.stale.insert(address.clone());
        }
    }

    pub fn is_stale(&self) -> bool {
        !self.stale.is_empty()
    }

    /// Shows the diagnostics of one document that has changed.
    pub fn refresh(&mut self) {
        let Some(address) = self.stale.pop_first() else { return };
        let Some(view) = self.view(&address) else { return };
        let checked = &view.survey.checked;
        let mut found = diagnostics::shown(&checked.diagnostics, &checked.sources, &view.places);
        let version = self.documents.get(&address).map_or(0, |document| document.version);
        // the worker computes the plan again; until then its last diagnostics stay
        let of_plan = if checked.sound { self.board.shown(&address).of_plan } else { Vec::new() };
        found.extend(of_plan.iter().cloned());
        self.board.show(&address, Shown { version, diagnostics: found, of_plan }, false);
        if checked.scenario.is_some() {
            let (name, modules) = self.around(&address);
            let (text, places) = (view.text.clone(), view.places.clone());
            self.worker.compile(Job { address, version, name, text, modules, places });
        }
    }

    /// The open texts.
    fn open_texts(&self) -> OpenTexts {
        let texts = self.documents.values();
        Arc::new(texts.filter_map(|d| Some((d.path.clone()?, d.text.clone()))).collect())
    }

    /// The name of a document in messages, and its modules.
    fn around(&self, address: &Url) -> (String, Beside) {
        let path = self.documents.get(address).and_then(|document| document.path.as_deref());
        self.around_file(path, address)
    }

    fn around_file(&self, path: Option<&Path>, address: &Url) -> (String, Beside) {
        let name = path.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let folder = path.and_then(Path::parent).map(Path::to_path_buf);
        let name = name.unwrap_or_else(|| address.path().to_owned());
        (name, Beside { folder, open: self.open_texts(), trees: self.trees.clone() })
    }

    /// The analysed text of a document.
    pub fn view(&mut self, address: &Url) -> Option<Rc<View>> {
        let document = self.documents.get(address)?;
        if let Some(view) = &document.view {
            return Some(view.clone());
        }
        let (name, modules) = self.around(address);
        let places = Places { main: address.clone(), folder: modules.folder.clone(), library: self.library.clone() };
        let view = Rc::new(View::new(&name, document.text.clone(), &modules, places));
        self.documents.get_mut(address)?.view = Some(view.clone());
        Some(view)
    }

    fn placed(&mut self, address: &Url, position: Position) -> Option<(Rc<View>, usize)> {
        let view = self.view(address)?;
        let offset = view.lines.offset(&view.text, position);
        Some((view, offset))
    }

    pub fn hover(&mut self, address: &Url, position: Position) -> Option<Hover> {
        let (view, offset) = self.placed(address, position)?;
        hover::hover(&view, offset)
    }

    pub fn completion(&mut self, address: &Url, position: Position) -> Vec<CompletionItem> {
        self.placed(address, position).map_or_else(Vec::new, |(view, offset)| completion::completion(&view, offset))
    }

    pub fn definition(&mut self, address: &Url, position: Position) -> Option<Location> {
        let (view, offset) = self.placed(address, position)?;
        let found = definition::definition(&view, offset)?;
        if found.uri.to_file_path().is_ok_and(|path| path.starts_with(&self.library)) {
            library::lay_down(&self.library).ok()?;
        }
        Some(found)
    }

    pub fn references(&mut self, address: &Url, position: Position) -> Vec<Location> {
        let Some((view, offset)) = self.placed(address, position) else { return Vec::new() };
        references::references(&view, &self.neighbours(&view), offset)
    }

    pub fn highlights(&mut self, address: &Url, position: Position) -> Vec<DocumentHighlight> {
        let Some((view, offset)) = self.placed(address, position) else { return Vec::new() };
        let places = references::references(&view, &[], offset).into_iter().filter(|place| place.uri == *address);
        places.map(|place| DocumentHighlight { range: place.range, kind: None }).collect()
    }

    pub fn renamable(&mut self, address: &Url, position: Position) -> Result<Range, String> {
        let (view, offset) = self.placed(address, position).ok_or("the file is not open")?;
        references::renamable(&view, offset)
    }

    pub fn rename(&mut self, address: &Url, position: Position, name: &str) -> Result<WorkspaceEdit, String> {
        let (view, offset) = self.placed(address, position).ok_or("the file is not open")?;
        references::rename(&view, &self.neighbours(&view), offset, name)
    }

    pub fn outline(&mut self, address: &Url) -> Vec<DocumentSymbol> {
        self.view(address).map_or_else(Vec::new, |view| outline::outline(&view))
    }

    pub fn layout(&mut self, address: &Url) -> Vec<TextEdit> {
        let document = self.documents.get(address);
        document.map_or_else(Vec::new, |document| layout::layout(&document.text, &document.lines))
    }

    pub fn colours(&mut self, address: &Url) -> Vec<SemanticToken> {
        self.view(address).map_or_else(Vec::new, |view| tokens::colours(&view))
    }

    pub fn hints(&mut self, address: &Url, range: Range) -> Vec<InlayHint> {
        self.view(address).map_or_else(Vec::new, |view| hints::hints(&view, range))
    }

    pub fn actions(&mut self, address: &Url, range: Range) -> Vec<CodeAction> {
        let shown: Vec<Diagnostic> = self.board.shown(address).diagnostics;
        self.view(address).map_or_else(Vec::new, |view| actions::actions(&view, &shown, range))
    }

    /// The drawing of the scene, or the reason why there is none.
    pub fn drawing(&mut self, address: &Url) -> Result<String, String> {
        let document = self.documents.get(address).ok_or("the file is not open")?;
        let (name, modules) = self.around(address);
        let compiled = compile(&name, &document.text, &modules, &[]);
        let errors = diag::has_errors(&compiled.diagnostics);
        match compiled.scenario.filter(|_| !errors) {
            Some(scenario) => Ok(drawing_svg(&scenario)),
            None if errors => Err("the scene has errors".into()),
            None => Err("no drawing: the scene is not complete, or the file has no `track`".into()),
        }
    }

    /// The other scenes of the workspace that may use a file of this scene.
    fn neighbours(&self, view: &View) -> Vec<Neighbour> {
        let mut roots = self.roots.clone();
        roots.extend(view.places.folder.clone().filter(|folder| !roots.iter().any(|root| folder.starts_with(root))));
        let mut files = Vec::new();
        roots.iter().for_each(|root| track_files(root, 0, &mut files));
        files.sort();
        files.dedup();
        files
            .iter()
            .filter_map(|file| self.neighbour(file))
            .filter(|other| other.places.main != view.places.main)
            .collect()
    }

    fn neighbour(&self, file: &Path) -> Option<Neighbour> {
        let main = Url::from_file_path(file).ok()?;
        let (name, modules) = self.around_file(Some(file), &main);
        let text = match modules.open.get(file) {
            Some(text) => text.to_string(),
            None => syntax::decode(&name, &std::fs::read(file).ok()?).ok()?,
        };
        // a file without `use` refers to nothing in this scene
        if !text.lines().any(|line| line.trim_start().starts_with("use ")) {
            return None;
        }
        let places = Places { main, folder: modules.folder.clone(), library: self.library.clone() };
        let (sources, files) = surveyed_names(&name, &text, &modules);
        Some(Neighbour { sources, files, places })
    }
}

/// Largest number of files, more than a workspace of scenes has.
const MOST_FILES: usize = 400;
const DEEPEST: usize = 6;

/// The `.track` files below a folder, without links and hidden folders.
fn track_files(folder: &Path, depth: usize, files: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut entries: Vec<_> = entries.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let Ok(kind) = entry.file_type() else { continue };
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        let skipped = name.starts_with('.') || ["target", "node_modules"].contains(&name.as_str());
        if kind.is_dir() && depth < DEEPEST && !skipped {
            track_files(&path, depth + 1, files);
        } else if kind.is_file() && name.ends_with(".track") && files.len() < MOST_FILES {
            files.push(path);
        }
    }
}

/// Moves diagnostics below an edit by the number of lines that it adds or removes.
fn shift(diagnostics: &mut [Diagnostic], range: Range, text: &str) {
    let added = text.matches('\n').count() as i64 - i64::from(range.end.line - range.start.line.min(range.end.line));
    let moved = |line: u32| (i64::from(line) + added).max(0) as u32;
    for diagnostic in diagnostics.iter_mut().filter(|d| d.range.start.line > range.end.line) {
        diagnostic.range.start.line = moved(diagnostic.range.start.line);
        diagnostic.range.end.line = moved(diagnostic.range.end.line);
    }
}
