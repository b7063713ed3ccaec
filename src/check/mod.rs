//! From the tree to the scenario: names, dimensions, fields, ranges, places.
//!
//! Everything is checked, whatever else is wrong: a value that could not be understood is marked and hides only what
//! depends on it.

mod arithmetic;
mod chosen;
mod columns;
mod combine;
mod complete;
mod expectation;
mod fit;
mod force;
mod geometry;
mod grading;
mod ground;
mod groundwork;
mod law;
mod layers;
mod library;
mod loading;
mod material;
mod meant;
mod measure;
mod measured;
mod modules;
mod names;
mod overrides;
mod profile;
mod random;
mod random_field;
mod records;
mod reduction;
mod resolve;
mod scatter;
mod seats;
mod spacing;
mod springs;
mod stretch;
mod study;
mod surface;
mod table;
mod tamping;
mod tier;
mod track;
mod trackform;
mod traffic;
mod value;
mod vary;
mod vehicle;
mod words;

pub use library::{Entry, library};
pub use measured::{MeasuredCurve, measured_curve};
pub use modules::{DataError, Folder, LARGEST_DATA_FILE, Modules, NoModules, Parsed, Remembered};
pub use overrides::Override;
pub use resolve::resolve;

use crate::diag::{self, Code, Diagnostic, FileId, Sources, Span};
use crate::scenario::{Evidence, LibraryEntry, Loading, RigLoad, Scenario, Study, Traffic};
use crate::schema::{self, Role};
use crate::solvers::granular::shape::Mesh;
use crate::syntax::tree::{Item, Value};
use geometry::Places;
use library::Part;
use modules::{Loader, Scope, ScopeId};
use names::ItemId;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;
use table::Table;
use tier::Asked;
use value::{Record, Val};

/// What became of a file: every diagnostic, and the scene where nothing stands against it.
#[derive(Debug)]
pub struct Checked {
    pub sources: Sources,
    pub diagnostics: Vec<Diagnostic>,
    /// `None` for a library, and where a mistake or a hole leaves a part unknown. Beside errors it serves to find more of
    /// them; it is not to be run.
    pub scenario: Option<Scenario>,
    /// The studies of the main file; those without a mistake.
    pub studies: Vec<Study>,
    /// Whether nothing stands against a run.
    pub sound: bool,
}

/// Checks a text that a person calls `name`.
pub fn check(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Checked {
    with_checker(name, text, modules, overrides, |_, _| ()).0
}

/// Checks a text, and asks something of what was found out about it.
///
/// Of the library only what the user's texts name is read. Where anything is amiss the whole of it is: what was meant may
/// stand there.
fn with_checker<T>(
    name: &str,
    text: &str,
    modules: &dyn Modules,
    overrides: &[Override],
    ask: impl Fn(&mut Checker<'_>, ScopeId) -> T,
) -> (Checked, T) {
    let texts = modules::texts(text, modules);
    let edits = overrides.iter().map(|edit| edit.value.as_str());
    let part = Part::named_in(texts.iter().map(|text| text.as_ref()).chain(edits));
    if let Part::Named(_) = part {
        let found = with_library(part, name, text, modules, overrides, &ask);
        if found.0.sound {
            return found;
        }
    }
    with_library(Part::Whole, name, text, modules, overrides, &ask)
}

fn with_library<T>(
    library: Part,
    name: &str,
    text: &str,
    modules: &dyn Modules,
    overrides: &[Override],
    ask: &impl Fn(&mut Checker<'_>, ScopeId) -> T,
) -> (Checked, T) {
    let mut loader = Loader::new(modules, library);
    let main = loader.load(name, text.to_string(), overrides);
    let standard = loader.standard_scope();
    let scopes = std::mem::take(&mut loader.scopes);
    let diagnostics = std::mem::take(&mut loader.diagnostics);
    let lost = |d: &&Diagnostic| matches!(d.code, Code::E0101 | Code::E0104 | Code::E0106);
    let unreadable = diagnostics.iter().filter(lost).filter_map(|d| Some(d.labels.first()?.span)).collect();
    let mut checker = Checker {
        diagnostics,
        loader,
        scopes,
        standard,
        records: HashMap::new(),
        stack: Vec::new(),
        circles: BTreeSet::new(),
        used: BTreeSet::new(),
        library_uses: BTreeMap::new(),
        without_library: BTreeSet::new(),
        defaults: HashMap::new(),
        numbers: HashMap::new(),
        tables: HashMap::new(),
        surfaces: HashMap::new(),
        reported: HashSet::new(),
        missing: Vec::new(),
        unreadable,
        superseded: Vec::new(),
        depth: 0,
        operands: 0,
        supports: ground::Supports::default(),
        seat_places: None,
        asked: Asked::default(),
        counted: None,
        seed: 1,
    };
    let (scenario, studies) = checker.scene(main);
    let known = checker.diagnostics.len();
    let answer = ask(&mut checker, main);
    checker.diagnostics.truncate(known);
    let mut diagnostics = checker.diagnostics;
    let within = |d: &Diagnostic, outer: &Span| {
        d.labels
            .first()
            .is_some_and(|l| l.span.file == outer.file && l.span.start >= outer.start && l.span.start < outer.end)
    };
    diagnostics.retain(|d| d.code != Code::E0105 || !checker.superseded.iter().any(|span| within(d, span)));
    diag::sort(&mut diagnostics);
    let sound = !diagnostics.iter().any(|d| d.is_error() || d.code == Code::E0410);
    (Checked { sources: checker.loader.sources, diagnostics, scenario, studies, sound }, answer)
}

/// The state of a check.
struct Checker<'a> {
    loader: Loader<'a>,
    scopes: Vec<Scope>,
    /// Where defaults are read: every module of the standard library is known there.
    standard: ScopeId,
    diagnostics: Vec<Diagnostic>,
    /// Files that name modules of the standard library without bringing it in.
    without_library: BTreeSet<ScopeId>,
    /// Objects evaluated so far.
    records: HashMap<ItemId, Option<Rc<Record>>>,
    /// Items being evaluated, with the place that asked.
    stack: Vec<(ItemId, Span)>,
    /// Circles of names reported so far.
    circles: BTreeSet<Vec<ItemId>>,
    /// Items that something asked for.
    used: BTreeSet<ItemId>,
    /// Entries of the standard library that are named outside of it, and where; nowhere for a default.
    library_uses: BTreeMap<ItemId, Option<Span>>,
    /// Defaults of the schema, parsed.
    defaults: HashMap<&'static str, Rc<Value>>,
    /// Values of lets that are numbers.
    numbers: HashMap<ItemId, Option<arithmetic::Raw>>,
    /// Data files by name, read once; `None` where they could not be.
    tables: HashMap<String, Option<Rc<Table>>>,
    /// Surfaces of grains by name, read once.
    surfaces: HashMap<String, Option<Arc<Mesh>>>,
    /// What has been reported, by code, message and place.
    reported: HashSet<(Code, String, Option<Span>)>,
    /// What objects lack, until all of them are known.
    missing: Vec<Missing>,
    /// Where the text could not be read.
    unreadable: Vec<Span>,
    /// Values of another form: what was said of foreign signs in them is not worth following.
    superseded: Vec<Span>,
    /// Values inside values at this moment, against [`DEEPEST`].
    depth: usize,
    /// Operands of the comparison that is being read.
    operands: usize,
    /// What stacks of layers made of the support of a seat.
    supports: ground::Supports,
    /// Known once the track is laid out.
    seat_places: Option<Places>,
    /// Known before the track is read.
    asked: Asked,
    /// Known once the traffic is.
    counted: Option<traffic::Counted>,
    /// Of everything random that has none of its own.
    seed: u64,
}

/// What a `scenario` says: title and physics rules.
#[derive(Default)]
struct Head {
    title: String,
    allow: Vec<(String, String)>,
    deny: Vec<String>,
    warn: Vec<String>,
}

/// Something that an object lacks.
struct Missing {
    span: Span,
    bases: Vec<Span>,
    what: String,
    diagnostic: Diagnostic,
}

/// Kinds that are read once the places along the track are known: they count from transitions.
const AFTER_PLACES: [&str; 2] = ["expect", "study"];

/// Values that lead to values: deeper than people write, shallow enough for any stack.
const DEEPEST: usize = 1_200;
/// What following a name costs of that.
const NAME: usize = 20;

impl Checker<'_> {
    /// Takes a mistake once: what is said of a place is not said again because another way leads there.
    fn report(&mut self, diagnostic: Diagnostic) {
        let place = diagnostic.labels.first().map(|l| l.span);
        if self.reported.insert((diagnostic.code, diagnostic.message.clone(), place)) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Notes that an object lacks something. What a base lacks as well is said of the base alone, see [`Self::say_missing`].
    fn lacks(&mut self, record: &Record, what: &str, diagnostic: Diagnostic) {
        if !record.partial {
            self.missing.push(Missing {
                span: record.span,
                bases: record.bases.clone(),
                what: what.to_string(),
                diagnostic,
            });
        }
    }

    /// Reports what is missing, once where several objects inherit the gap.
    fn say_missing(&mut self) {
        let missing = std::mem::take(&mut self.missing);
        let gaps: HashSet<(Span, &str)> = missing.iter().map(|m| (m.span, m.what.as_str())).collect();
        for gap in &missing {
            if !gap.bases.iter().any(|base| gaps.contains(&(*base, gap.what.as_str()))) {
                self.report(gap.diagnostic.clone());
            }
        }
    }

    /// Whether something inside a span could not be read as text.
    fn unread(&self, span: Span) -> bool {
        self.unreadable.iter().any(|s| s.file == span.file && s.start >= span.start && s.end <= span.end)
    }

    /// Evaluates every declaration of the user's files, then builds the scene.
    fn scene(&mut self, main: ScopeId) -> (Option<Scenario>, Vec<Study>) {
        let tree = self.scopes[main].tree.clone();
        if tree.items.is_empty() {
            if !diag::has_errors(&self.diagnostics) {
                self.report(
                    Diagnostic::new(Code::E0601, "the file declares nothing")
                        .at(Span::new(Loader::main_file(), 0, 0), "empty")
                        .help("`trackbed new` writes a scene to begin with"),
                );
            }
            return (None, Vec::new());
        }
        let roots = self.evaluate_all(main);
        let track_record = self.only(main, "track");
        let scenario = track_record.as_ref().and_then(|record| self.build(main, record));
        self.expectations_elsewhere(main);
        let studies = if track_record.is_some() { self.studies(main) } else { Vec::new() };
        self.idle_lets();
        self.say_missing();
        // what is misspelt or unread may be what would have used it
        if track_record.is_some() && !diag::has_errors(&self.diagnostics) {
            self.unused(main, &roots);
        }
        (scenario, studies)
    }

    /// Evaluates declarations, the main file's last, and returns those that act by themselves. Expectations and
    /// studies wait until places are known.
    fn evaluate_all(&mut self, main: ScopeId) -> Vec<ItemId> {
        let mut roots = Vec::new();
        let mine: Vec<ScopeId> = (0..self.scopes.len()).filter(|s| !self.scopes[*s].library).collect();
        for scope in mine {
            let tree = self.scopes[scope].tree.clone();
            for (item, declaration) in tree.items.iter().enumerate() {
                let Item::Declaration(d) = declaration else { continue };
                let id = ItemId { scope, item };
                let acts = matches!(schema::kind(&d.kind.text).map(|k| k.role), Some(Role::Scene { .. }));
                if acts && scope == main {
                    roots.push(id);
                }
                if !AFTER_PLACES.contains(&d.kind.text.as_str()) {
                    let used = self.used.contains(&id);
                    self.record(id, d.span);
                    if !used && !acts {
                        self.used.remove(&id);
                    }
                }
            }
        }
        roots
    }

    /// Bindings that nothing asks for may have unknown units all the same.
    fn idle_lets(&mut self) {
        for scope in (0..self.scopes.len()).filter(|s| !self.scopes[*s].library).collect::<Vec<_>>() {
            let tree = self.scopes[scope].tree.clone();
            for (item, thing) in tree.items.iter().enumerate() {
                if let Item::Let(binding) = thing
                    && !self.used.contains(&ItemId { scope, item })
                {
                    self.units_in(&binding.value);
                }
            }
        }
    }

    /// Expectations and studies of a file without a track are read all the same.
    fn expectations_elsewhere(&mut self, main: ScopeId) {
        let tree = self.scopes[main].tree.clone();
        for (item, declaration) in tree.items.iter().enumerate() {
            if let Item::Declaration(d) = declaration
                && AFTER_PLACES.contains(&d.kind.text.as_str())
            {
                self.record(ItemId { scope: main, item }, d.span);
            }
        }
    }

    /// Every object of a kind in the main file, complete.
    fn all(&mut self, main: ScopeId, kind: &str) -> Vec<Record> {
        let tree = self.scopes[main].tree.clone();
        let mut found = Vec::new();
        for (item, declaration) in tree.items.iter().enumerate() {
            let Item::Declaration(d) = declaration else { continue };
            if d.kind.text != kind {
                continue;
            }
            if let Some(record) = self.record(ItemId { scope: main, item }, d.span) {
                found.push(self.complete(&record));
            }
        }
        found
    }

    fn only(&mut self, main: ScopeId, kind: &str) -> Option<Record> {
        self.all(main, kind).into_iter().next()
    }

    fn build(&mut self, main: ScopeId, track_record: &Record) -> Option<Scenario> {
        let traffic_record = self.only(main, "traffic");
        let load_records = self.all(main, "load");
        let solve_record = self.only(main, "solve").unwrap_or_else(|| self.default_solve());
        self.asked = Asked::of(&solve_record, track_record, traffic_record.is_some(), &load_records);
        self.waits_for_grains(&solve_record, track_record, &load_records);
        if let Some(seed) = solve_record.number("seed") {
            self.seed = seed.value as u64;
        }
        let track = self.track(track_record);
        let places = self.seat_places.clone();
        let traffic: Option<Traffic> = traffic_record.as_ref().and_then(|r| self.traffic(r));
        let loads: Vec<Option<Vec<_>>> = load_records.iter().map(|r| self.loads(r, &places)).collect();
        let solve = self.solve(&solve_record, &places);
        if let Some(solve) = &solve {
            self.shear_stiffnesses(track_record, solve.beam);
        }
        let ends = loading::cycles(&load_records);
        let records = self.all(main, "record");
        let records: Vec<Option<_>> = records.iter().map(|r| self.kept(r, &places, traffic.as_ref(), ends)).collect();
        let tampings = self.all(main, "tamping");
        let tampings = self.tampings(&tampings, &places, track.as_ref(), traffic.as_ref());
        let expectations = self.expectations(main);
        let head = self.scenario_head(main);
        let loads: Vec<_> = loads.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
        let loading = match (traffic_record.is_some(), loads.is_empty()) {
            (true, _) => Some(Loading::Traffic(traffic?)),
            (false, false) => Some(match loads.iter().map(RigLoad::at_rest).collect() {
                Some(at_rest) => Loading::Static(at_rest),
                None => Loading::Rig(loads),
            }),
            (false, true) => None,
        };
        let kept: Vec<_> = records.into_iter().collect::<Option<_>>()?;
        let (records, volumes): (Vec<_>, Vec<_>) = kept.into_iter().unzip();
        let (records, volumes) = (records.into_iter().flatten().collect(), volumes.into_iter().flatten().collect());
        Some(Scenario {
            title: head.title,
            track: track?,
            loading,
            tampings: tampings?,
            solve: solve?,
            records,
            volumes,
            expectations,
            allow: head.allow,
            deny: head.deny,
            warn: head.warn,
            library: self.library_entries(),
        })
    }

    /// `solve` of a scene that says nothing about it.
    fn default_solve(&mut self) -> Record {
        let Some(kind) = schema::kind("solve") else { unreachable!("the vocabulary has `solve`") };
        let span = Span::new(FileId(0), 0, 0);
        self.complete(&Record::empty(kind, "solve", span))
    }

    fn expectations(&mut self, main: ScopeId) -> Vec<crate::scenario::response::Expectation> {
        let mut found = Vec::new();
        for record in self.all(main, "expect") {
            let Some(Val::List(slots)) = record.get("that").map(|s| &s.value) else { continue };
            found.extend(
                slots.iter().filter_map(|s| if let Val::Comparison(e) = &s.value { Some(e.clone()) } else { None }),
            );
        }
        found
    }

    /// Title and physics rules; the file's name where there is no title.
    fn scenario_head(&mut self, main: ScopeId) -> Head {
        let record = self.only(main, "scenario");
        let name = self.loader.sources.get(Loader::main_file()).name.clone();
        let stem = name.rsplit(['/', '\\']).next().unwrap_or(&name).trim_end_matches(".track").to_string();
        let Some(record) = record else { return Head { title: stem, ..Head::default() } };
        let text = |val: &Val| if let Val::Text(t) = val { Some(t.clone()) } else { None };
        let allow = match record.get("allow").map(|s| &s.value) {
            Some(Val::Pairs(pairs)) => {
                pairs.iter().filter_map(|(k, v)| Some((text(&k.value)?, text(&v.value)?))).collect()
            }
            _ => Vec::new(),
        };
        let rules = |field: &str| match record.get(field).map(|s| &s.value) {
            Some(Val::List(slots)) => slots.iter().filter_map(|s| text(&s.value)).collect(),
            _ => Vec::new(),
        };
        let title = record.text("title").map_or(stem, str::to_string);
        Head { title, allow, deny: rules("deny"), warn: rules("warn") }
    }

    /// Entries of the standard library that the scene names or leaves to a default, with their evidence.
    fn library_entries(&self) -> Vec<LibraryEntry> {
        let entry = |(id, span): (&ItemId, &Option<Span>)| {
            let record = self.records.get(id)?.as_ref()?;
            let evidence = match record.word("evidence")? {
                "read" => Evidence::Read,
                "derived" => Evidence::Derived,
                _ => Evidence::Unchecked,
            };
            let file = &self.loader.sources.get(record.span.file).name;
            let module = file.trim_start_matches("std/").trim_end_matches(".track");
            let source = record.text("source").unwrap_or_default().to_string();
            Some(LibraryEntry { name: format!("{module}.{}", record.name), source, evidence, span: *span })
        };
        self.library_uses.iter().filter_map(entry).collect()
    }

    /// Warns of declarations of the main file that nothing asks for.
    fn unused(&mut self, main: ScopeId, roots: &[ItemId]) {
        let tree = self.scopes[main].tree.clone();
        for (item, thing) in tree.items.iter().enumerate() {
            let id = ItemId { scope: main, item };
            let (name, span) = match thing {
                Item::Declaration(d) => match &d.name {
                    Some(name) => (name.text.clone(), name.span),
                    None => (d.kind.text.clone(), d.kind.span),
                },
                Item::Let(l) => (l.name.text.clone(), l.name.span),
                Item::Use(_) => continue,
            };
            let declared = self.scopes[main].names.get(&name) == Some(&item);
            if declared
                && !roots.contains(&id)
                && !self.used.contains(&id)
                && !matches!(self.records.get(&id), Some(None))
            {
                self.report(
                    Diagnostic::new(Code::E0412, format!("nothing uses `{name}`"))
                        .at(span, "declared here")
                        .help("take it out, or use it"),
                );
            }
        }
    }
}
