//! What must hold of any file that the program reads: it is what it says, in finite numbers, or it is refused.

use super::bytes::{changed, changed_json};
use super::dice::Dice;
use std::cell::RefCell;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use trackbed::check::{Modules, NoModules, Parsed, Remembered, check, measured_curve};
use trackbed::diag::FileId;
use trackbed::execute::{Between, Checkpoint, Event, Executor};
use trackbed::graph::Graph;
use trackbed::results;
use trackbed::solvers::granular::grains::{GrainForm, stl};
use trackbed::solvers::granular::packing::{Packed, StoredBed, pack};
use trackbed::solvers::granular::rig::{Rig, StoredTrial, Trial};
use trackbed::solvers::granular::{Bed, measure::Survey};
use trackbed::store::{Directory, Mode, Shelf, Unfinished, Work, sha256};
use trackbed::trials::grains::Pile;
use trackbed::{Scene, compile};

/// Files of a kind, and the reading of one of them by its number in the list.
pub struct Target {
    seeds: Vec<Vec<u8>>,
    /// Whether the bytes are JSON, or a sealed JSON.
    json: bool,
    read: Box<Read>,
}

/// Reads the bytes of a changed file, given its number in the list; panics where what is read cannot be.
type Read = dyn Fn(usize, &[u8]);

impl Target {
    /// The target of that name. Those of grains pack a small bed first.
    pub fn named(name: &str) -> Option<Target> {
        Some(match name {
            "stl" => surfaces(),
            "csv" => tables(),
            "results" => results_of_a_run(),
            "checkpoint" => checkpoints(),
            "bed" => beds(),
            _ => return None,
        })
    }

    /// File `number`, and of which of the seeds it was made.
    pub fn file(&self, number: u64) -> (usize, Vec<u8>) {
        let mut dice = Dice::new(number);
        let seed = dice.roll(self.seeds.len());
        let bytes = &self.seeds[seed];
        let value = (self.json && dice.roll(10) > 1).then(|| serde_json::from_slice(bytes).ok()).flatten();
        match value {
            Some(mut value) => {
                changed_json(&mut value, &mut dice);
                (seed, serde_json::to_vec(&value).unwrap_or_default())
            }
            None => (seed, changed(bytes, &self.seeds, &mut dice)),
        }
    }

    /// Reads a file that was made of a seed.
    pub fn read(&self, seed: usize, bytes: &[u8]) {
        (self.read)(seed, bytes);
    }

    /// Reads every seed as it is.
    pub fn read_seeds(&self) {
        self.seeds.iter().enumerate().for_each(|(seed, bytes)| self.read(seed, bytes));
    }
}

/// Whether a text of `{:?}` holds a number that is none.
fn holds_nan(text: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric()).any(|word| word == "NaN" || word == "inf")
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

// ---- surfaces of grains --------------------------------------------------------------------------------------------

const TETRAHEDRON: &str = "solid t
facet normal 0 0 -1 outer loop vertex 0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet
facet normal 0 -1 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 1 endloop endfacet
facet normal -1 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet
facet normal 1 1 1 outer loop vertex 1 0 0 vertex 0 1 0 vertex 0 0 1 endloop endfacet
endsolid t
";

fn surfaces() -> Target {
    let small = TETRAHEDRON.as_bytes().to_vec();
    let binary = stl::read(&small).map(|mesh| stl::write(&mesh)).unwrap_or_default();
    let stone = fs::read(root().join("stdlib/shapes/flat.stl")).unwrap_or_default();
    // small files are read a hundred times faster
    let seeds = [vec![[small, binary].to_vec(); 20].concat(), vec![stone]].concat();
    Target { seeds, json: false, read: Box::new(|_, bytes| surface(bytes)) }
}

fn surface(bytes: &[u8]) {
    let Ok(mesh) = stl::read(bytes) else { return };
    assert!(mesh.vertices().iter().all(|v| v.iter().all(|x| x.is_finite())), "a corner is no number");
    assert!(mesh.volume().is_finite() && mesh.volume() > 0.0, "volume {}", mesh.volume());
    let form = GrainForm::of_surface(&mesh);
    assert!(!holds_nan(&format!("{form:?}")), "{form:?}");
}

// ---- tables --------------------------------------------------------------------------------------------------------

/// A scene that reads files of numbers wherever one may stand.
const READS: &str = r#"
grading sieved { passing = file("sieves.csv") }
granular stone { grading = sieved, density = 2700 kg/m^3, friction = 0.7, contact_stiffness = 13 MN/m per contact, youngs_modulus = 150 MPa }
trackform seats {
  rail = { mass = 60 kg/m, bending_stiffness = 6.4 MN m^2 }
  pad = { stiffness = 40 MN/m }
  sleeper = { mass = 300 kg }
  spacing = 0.6 m, layers = [stone: 300 mm], settlement = file("settled.csv")
}
track bench { sections = [seats: 20 sleepers], irregularity = file("level.csv") }
load jack { on = sleepers, at = 10 sleepers, force = file("force.csv") per seat }
expect { that = misfit(settlement, file("measured.csv")) < 1 mm }
"#;

const TABLES: [(&str, &str); 5] = [
    ("sieves.csv", "size_mm,passing_%\n22.4,0\n31.5,20\n40,50\n50,90\n63,100\n"),
    ("settled.csv", "x_m,settled_mm\n-1,0\n4,1\n6.5,0.5\n14,0\n"),
    ("level.csv", "x_m,level_mm,other_m\n-1,0,1\n3,0.5,2\n6,-0.25,3\n15,0,4\n"),
    ("force.csv", "time_s,force_kN\n0,5\n0.1,60\n0.2,5\n"),
    ("measured.csv", "# levelled\nx_m,settlement_mm\n1.5,0.2\n3,0.25\n8.25,0.125\n"),
];
const CURVE: &str = "axles,settlement_mm\n10,0.5\n100,1.5\n1000,2\n10000,2.25\n";

/// All tables as they should be, but one.
struct One<'a>(&'a str, &'a [u8]);

impl Modules for One<'_> {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        let name = relative.to_str()?;
        let (_, text) = TABLES.iter().find(|(known, _)| *known == name)?;
        Some(if name == self.0 { self.1.to_vec() } else { text.as_bytes().to_vec() })
    }

    fn parsed(&self, file: FileId, text: &str) -> Parsed {
        PARSED.with(|known| known.parsed(file, text))
    }
}

thread_local! {
    /// The scene and the library, which stay the same.
    static PARSED: Remembered<NoModules> = Remembered::new(NoModules);
}

fn tables() -> Target {
    let seeds = TABLES.iter().map(|(_, text)| text.as_bytes().to_vec()).chain([CURVE.as_bytes().to_vec()]).collect();
    Target { seeds, json: false, read: Box::new(table) }
}

fn table(number: usize, bytes: &[u8]) {
    let Some((name, _)) = TABLES.get(number) else { return curve(bytes) };
    let checked = check("reads.track", READS, &One(name, bytes), &[]);
    assert!(checked.scenario.is_some() || checked.diagnostics.iter().any(|d| d.is_error()), "no scene and no mistake");
    if let Some(scenario) = checked.scenario.filter(|_| checked.sound) {
        assert!(
            !holds_nan(&format!("{:?} {:?}", scenario.track, scenario.loading)),
            "{name} gives a number that is none"
        );
        assert!(!holds_nan(&format!("{:?}", scenario.expectations)), "{name} gives a number that is none");
    }
}

fn curve(bytes: &[u8]) {
    let (curve, mistakes) = measured_curve(FileId(0), &String::from_utf8_lossy(bytes), 3);
    assert!(curve.is_some() == mistakes.is_empty(), "a curve beside mistakes, or neither");
    assert!(curve.is_none_or(|curve| curve.settlement.iter().all(|x| x.is_finite())), "a settlement is no number");
}

// ---- the directory of a run ----------------------------------------------------------------------------------------

/// A track of a few seats, which runs in milliseconds.
const SHORT: &str = r#"
use std
trackform open {
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 40 MN/m per seat }
}
track line { sections = [open: 40 sleepers] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 80 km/h }
traffic { trains = ore, total = 12 axles }
record { at = 20 sleepers, after = [0, 12] axles, every = 10 ms, quantities = contact_force }
solve { elements_per_bay = 1, time_step = 4e-4 s, update_every = 4 axles }
"#;

fn results_of_a_run() -> Target {
    let folder = tempfile::tempdir().expect("a folder for a run");
    let run = Scene::from_text(SHORT).run().expect("a short run");
    results::write(&run, folder.path()).expect("a directory of results");
    let mut names: Vec<PathBuf> =
        fs::read_dir(folder.path()).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    names.sort();
    let seeds: Vec<Vec<u8>> = names.iter().map(|path| fs::read(path).unwrap_or_default()).collect();
    let kept = seeds.clone();
    let read = move |seed: usize, bytes: &[u8]| {
        let _ = &folder;
        fs::write(&names[seed], bytes).expect("a folder that can be written");
        let read = results::read(names[seed].parent().expect("a folder"));
        fs::write(&names[seed], &kept[seed]).expect("a folder that can be written");
        let Ok(run) = read else { return };
        // what texts say is their own
        let scalars: Vec<f64> = run.summary.scalars.values().map(|scalar| scalar.value).collect();
        let values: Vec<f64> = run.histories.iter().flat_map(|row| [row.time_s, row.x_m, row.value]).collect();
        let levels: Vec<f64> = run.sleepers.iter().flat_map(|row| [row.x_m, row.settlement_m, row.void_m]).collect();
        let tables = format!("{scalars:?} {values:?} {levels:?} {:?} {:?}", run.blocks, run.rail);
        assert!(!holds_nan(&tables), "`{}` gives a number that is none", names[seed].display());
    };
    Target { seeds, json: false, read: Box::new(read) }
}

// ---- checkpoints ---------------------------------------------------------------------------------------------------

/// A few coarse grains under a plate.
const PLATE: &str = r#"
grading coarse { passing = [80 mm: 0 %, 100 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, friction = 0.2 }
}
trackform bed { spacing = 0.6 m, layers = [stone: 200 mm] }
track box { sections = [bed: 0.6 m], bed_width = 1 m per track }
load press { on = bed, at = 0.3 m, force = cyclic(0.6 .. 20 kN, 40 Hz) per rail, total = 1 cycle }
solve { substructure = full }
"#;

/// The plan of a scene.
fn plan(text: &str) -> Graph {
    let compiled = compile("drawn.track", text, &NoModules, &[]);
    let told: Vec<String> = compiled.diagnostics.iter().map(|d| d.message.clone()).collect();
    compiled.graph.unwrap_or_else(|| panic!("a plan: {told:?}"))
}

/// The state of a run at its moment `number`, as it is kept.
fn state(graph: &Graph, number: usize) -> Vec<u8> {
    let (mut seen, mut state) = (0, Vec::new());
    let mut listener = |event: &Event<'_>| {
        let Event::Between(between) = event else { return ControlFlow::Continue(()) };
        seen += 1;
        if seen < number {
            return ControlFlow::Continue(());
        }
        state = kept(between);
        ControlFlow::Break(())
    };
    Executor::default().run(graph, &mut listener, None).expect("a run");
    state
}

fn kept(between: &Between<'_>) -> Vec<u8> {
    between.checkpoint().map(|state| serde_json::to_vec(&state).unwrap_or_default()).unwrap_or_default()
}

/// A rig and where its tests begin.
struct Rigged {
    rig: Rig,
}

fn rigged(graph: &Graph) -> Rigged {
    let (bed, actuators) = graph.bed_under_actuators().expect("a rig");
    let ready = bed.bed.ready(1).expect("a recipe");
    let packed = pack::<f32, _>(&ready.recipe, |_| {}).expect("a bed");
    let top = packed.levels.last().copied().unwrap_or_default();
    let trackbed::graph::Schedule::Actuators(tests) = &graph.schedule else { panic!("a rig has tests") };
    Rigged { rig: bed.rig(actuators, &ready.recipe, top, &tests.kept) }
}

fn checkpoints() -> Target {
    let (track, plate) = (plan(SHORT), plan(PLATE));
    let seeds = vec![state(&track, 1), state(&track, 2), state(&plate, 3)];
    let work = Work { name: "run".into(), scene_sha256: "abc".into() };
    let folder = tempfile::tempdir().expect("a folder");
    let directory = Directory::open(folder.path(), work, Mode::New).expect("a directory");
    directory.write_checkpoint(&serde_json::json!({})).expect("a checkpoint");
    let rigged = rigged(&plate);
    let read = move |_: usize, bytes: &[u8]| {
        let _ = &folder;
        let path = directory.path().join(".trackbed/checkpoint");
        fs::write(&path, sealed("checkpoint", "abc", bytes)).expect("a folder that can be written");
        let Ok(Some(unfinished)) = Unfinished::open(directory.path()) else { panic!("work that is gone") };
        let Ok(Some(checkpoint)) = unfinished.read_checkpoint::<Checkpoint>() else { return };
        go_on(&track, &rigged.rig, checkpoint);
    };
    Target { seeds, json: true, read: Box::new(read) }
}

/// Takes a run up where it was, as far as its next moment.
fn go_on(track: &Graph, rig: &Rig, checkpoint: Checkpoint) {
    if let trackbed::execute::ScheduleState::Tests { running: Some(running), .. } = checkpoint.state {
        return grains_go_on(*running, rig);
    }
    let mut seen = Vec::new();
    let mut listener = |event: &Event<'_>| match event {
        Event::Block { after, .. } => {
            seen = after.to_vec();
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    };
    let ended = Executor::default().run(track, &mut listener, Some(checkpoint));
    assert!(ended.is_err() || seen.iter().all(|settlement| settlement.is_finite()), "a settlement is no number");
}

fn grains_go_on(state: StoredTrial<f32>, rig: &Rig) {
    let Ok(mut trial) = Trial::restore(state, rig) else { return };
    look(&mut trial.bed, None);
}

/// The bytes of a sealed file: those who change one and mend its checksum get as far as what it holds.
fn sealed(kind: &str, key: &str, payload: &[u8]) -> Vec<u8> {
    let label = format!("{{\"kind\":\"{kind}\",\"version\":\"{}\",\"key\":\"{key}\"}}\n", env!("CARGO_PKG_VERSION"));
    let content = [label.as_bytes(), payload].concat();
    [format!("trackbed 1 {}\n", sha256(&content)).as_bytes(), &content].concat()
}

// ---- beds ----------------------------------------------------------------------------------------------------------

const PILE: &str = "# periodic x 0.6 m, y 0.6 m; rigid floor z = 0
0.1 0.1 0.03 0.03
0.2 0.1 0.03 0.03
0.1 0.2 0.035 0.03
0.15 0.15 0.07 0.03
";
const CLUMPS: &str = "# periodic x 0.6 m; rigid floor z = 0
1 0.1 0.1 0.03 0.03
1 0.12 0.1 0.03 0.025
2 0.3 0.1 0.03 0.03
3 0.4 0.1 0.03 0.02
3 0.4 0.12 0.03 0.02
3 0.4 0.13 0.04 0.02
";

/// Of the seeds the last two are beds of text, the others beds of the store.
fn beds() -> Target {
    let plate = plan(PLATE);
    let (bed, _) = plate.bed_under_actuators().expect("a rig");
    let packed = pack::<f32, _>(&bed.bed.ready(1).expect("a recipe").recipe, |_| {}).expect("a bed");
    let stored = serde_json::to_vec(&packed.store()).expect("a bed as JSON");
    let folder: RefCell<TempDir> = RefCell::new(tempfile::tempdir().expect("a folder"));
    let densities = packed.densities.clone();
    let read = move |seed: usize, bytes: &[u8]| match seed {
        0 | 1 => stored_bed(folder.borrow().path(), bytes, &densities),
        _ => pile(bytes),
    };
    Target { seeds: vec![stored.clone(), stored, PILE.into(), CLUMPS.into()], json: true, read: Box::new(read) }
}

fn stored_bed(folder: &Path, bytes: &[u8], densities: &[f64]) {
    fs::write(folder.join("abc.bed"), sealed("bed", "abc", bytes)).expect("a folder that can be written");
    let Ok(Some(stored)) = Shelf::new(folder, "bed").get::<StoredBed<f32>>("abc") else { return };
    let Ok(mut packed) = Packed::restore(stored) else { return };
    look(&mut packed.bed, Some(densities));
}

/// Looks at a bed that was read, and makes a step.
fn look(bed: &mut Bed<f32>, densities: Option<&[f64]>) {
    let finite = |bed: &Bed<f32>| {
        bed.pebbles().all(|pebble| pebble.place.iter().all(|x| x.is_finite()) && pebble.radius.is_finite())
    };
    assert!(finite(bed), "a place is no number");
    if let Ok(snapshot) = bed.snapshot() {
        assert!(snapshot.contacts.iter().all(|c| c.force.iter().all(|f| f.is_finite())), "a force is no number");
        if let Some(densities) = densities {
            drop(Survey::from_snapshot(bed, &snapshot, densities));
        }
        let stepped = bed.run(1);
        assert!(stepped.is_err() || finite(bed), "a place is no number after a step");
    }
}

fn pile(bytes: &[u8]) {
    let Ok(pile) = Pile::read(bytes) else { return };
    let laws = trackbed::solvers::granular::ContactLaws::single(trackbed::trials::grains::law());
    let bed: Bed<f32> = pile.bed([1, 1], laws, 2700.0);
    assert!(bed.pebbles().all(|pebble| pebble.place.iter().all(|x| x.is_finite())), "a place is no number");
    assert!(bed.check().is_ok(), "{:?}", bed.check());
}
