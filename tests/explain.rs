//! Every code has a page; what it says fails does fail with that code, and what it says passes does pass.

use std::collections::BTreeMap;
use std::path::Path;
use trackbed::check::{Modules, NoModules};
use trackbed::diag::{Code, Diagnostic, Severity};
use trackbed::study::{Scene, plan};
use trackbed::{Compiled, compile};

/// Codes that no text alone can show, and what shows them instead.
const RUN_TIME: [(Code, &str); 19] = [
    (Code::E0610, "a bed of a scene: `tests/pack.rs`"),
    (Code::E0612, "a plan that a pass of another program breaks: `tests/graph/planner.rs`"),
    (Code::E0701, "a chart of a scene without trains: `tests/study.rs`"),
    (Code::E0702, "a chart after a count that is not known: `tests/study.rs`"),
    (Code::E0711, "a study whose designs all miss: `tests/studies.rs`"),
    (Code::E0802, "a run into a directory that is taken: `tests/cli.rs`"),
    (Code::E0803, "a checkpoint of another scene: `a_checkpoint_of_another_scene_is_refused` below"),
    (Code::E0804, "a finished run that misses an expectation: `tests/cli.rs`"),
    (Code::E0805, "a measured curve beside the scene: `tests/calibrate.rs`"),
    (Code::E0806, "a measured curve beside the scene: `tests/calibrate.rs`"),
    (Code::E0808, "a study with a point that fails: `tests/studies.rs`"),
    (Code::E0809, "a study resumed after a change: `tests/studies.rs`"),
    (Code::E0810, "a bed that is packed: `a_bed_that_moves_on_is_refused` of the packer"),
    (Code::E0811, "a rig on grains: `src/solvers/granular/rig`"),
    (Code::E0812, "a rig whose bed gives way: `tests/rigs.rs`"),
    (Code::E0813, "a run that no machine holds: `tests/attacks.rs`"),
    (Code::E0814, "a run whose law sinks the track: `tests/attacks.rs`"),
    (Code::E0815, "a machine without Slurm: `tests/workers.rs`"),
    (Code::E0816, "a run that is allowed less memory than it takes: `tests/faults.rs`"),
];

/// Pages whose failing example is no scene: the bytes of the file are the mistake.
const NOT_TEXT: [Code; 1] = [Code::E0102];

/// Limits of methods, and the maps that show them.
const MAPS: [(Code, &str); 7] = [
    (Code::E0603, "stability.svg"),
    (Code::E0703, "stability.svg"),
    (Code::L1005, "stability.svg"),
    (Code::E0807, "exchange_transition.svg"),
    (Code::L1006, "exchange_transition.svg"),
    (Code::L1020, "grain_inertia.csv"),
    (Code::L1035, "grains_short.svg"),
];

/// A fenced block: what stands behind the fence, and its lines.
struct Block<'a> {
    kind: &'a str,
    text: &'a str,
}

fn blocks(section: &str) -> Vec<Block<'_>> {
    section
        .split("```")
        .skip(1)
        .step_by(2)
        .map(|block| {
            let (kind, text) = block.split_once('\n').unwrap();
            Block { kind, text }
        })
        .collect()
}

/// The failing and the passing part of a page.
fn parts(code: Code) -> (&'static str, &'static str) {
    let (_, examples) = code.page().split_once("\n## Fails\n").unwrap_or_else(|| panic!("{code} has `## Fails`"));
    examples.split_once("\n## Passes\n").unwrap_or_else(|| panic!("{code} has `## Passes`"))
}

struct Files<'a>(BTreeMap<&'a str, &'a str>);

impl Modules for Files<'_> {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative.to_str()?).map(|text| text.as_bytes().to_vec())
    }
}

/// Compiles a block; `// file: name` lines divide it into a main file and its modules.
fn compiled(text: &str) -> Compiled {
    let mut files = text.split("// file: ").map(|part| part.split_once('\n').unwrap_or((part, "")));
    let first = files.next();
    if !text.starts_with("// file: ") {
        assert_eq!(files.count(), 0, "the first of several files has its name too");
        return compile("main.track", text, &Files(BTreeMap::new()), &[]);
    }
    assert_eq!(first, Some(("", "")));
    let (name, main) = files.next().unwrap();
    compile(name, main, &Files(files.chain([(name, main)]).collect()), &[])
}

fn codes(compiled: &Compiled) -> Vec<Code> {
    compiled.diagnostics.iter().map(|d| d.code).collect()
}

/// What a text of a page gives; rules of grains need scenes that this version only checks, which is not what they are
/// about.
fn found(page: Code, compiled: &Compiled) -> Vec<&Diagnostic> {
    let waits = |d: &Diagnostic| page.rule().is_some() && d.code == Code::E0604;
    compiled.diagnostics.iter().filter(|d| !waits(d)).collect()
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

/// What stands against the points of the studies of a block.
fn studied(text: &str) -> Vec<Code> {
    let compiled = compiled(text);
    assert!(codes(&compiled).is_empty() && !compiled.studies.is_empty(), "{}", told(&compiled));
    let scene = Scene { name: "main.track", text, modules: &NoModules, set: &[] };
    let plans = compiled.studies.iter().map(|study| plan(scene, &compiled, study));
    plans.flat_map(|plan| plan.diagnostics).map(|d| d.code).collect()
}

/// Runs a block in memory and says how it ended.
fn outcome(text: &str) -> Result<(), Code> {
    let compiled = compiled(text);
    assert!(codes(&compiled).is_empty(), "{}", told(&compiled));
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = trackbed::results::RunRecorder::new(&scenario, &graph);
    trackbed::execute::execute(&graph, &mut recorder)
        .map_err(|error| trackbed::execute::diagnose(&error, &graph, &compiled.origins).code)?;
    let (tables, histories) = (&recorder.tables, recorder.all_histories());
    let scalars = recorder.scalars();
    let view = tables.view(&histories, &scalars, &scenario.track, &graph.supports);
    if trackbed::results::BlockRow::overshoot(&tables.blocks).is_some() {
        return Err(Code::E0807);
    }
    let held = trackbed::results::verdicts(&scenario, view).iter().all(|v| v.met);
    if held { Ok(()) } else { Err(Code::E0804) }
}

#[test]
fn every_page_has_its_title_and_its_parts() {
    for code in Code::ALL {
        let page = code.page();
        assert!(page.starts_with(&format!("# {code}: {}\n\n", code.title())), "{code}");
        let (fails, passes) = parts(*code);
        assert_eq!((blocks(fails).len(), blocks(passes).len()), (1, 1), "{code}");
        let prose = page.split("\n## Fails\n").next().unwrap().split("\n\n").skip(1).filter(|p| !p.trim().is_empty());
        assert!((1..=3).contains(&prose.count()), "{code} says in one to three paragraphs what it means");
        let widest = page.lines().map(|l| l.chars().count()).max().unwrap();
        assert!(widest <= 120, "{code}: a line of {widest} characters");
        if let Some(rule) = code.rule() {
            assert!(page.contains(&format!("Rule `{rule}`")) && page.contains(&format!("allow = [{rule}: ")), "{code}");
        }
    }
}

#[test]
fn what_fails_gives_its_code_alone() {
    for code in Code::ALL.iter().filter(|c| !NOT_TEXT.contains(c)) {
        for block in blocks(parts(*code).0) {
            match block.kind {
                "track" => {
                    let compiled = compiled(block.text);
                    let found = found(*code, &compiled);
                    assert!(!found.is_empty(), "{code} finds nothing:\n{}", told(&compiled));
                    assert!(found.iter().all(|d| d.code == *code), "{code}:\n{}", told(&compiled));
                    assert!(found.iter().all(|d| d.severity == code.severity()), "{code}");
                    // errors are said once; rules may speak of each end or side
                    assert!(found.len() == 1 || code.rule().is_some(), "{code}:\n{}", told(&compiled));
                }
                "track run" => assert_eq!(outcome(block.text), Err(*code), "{code}"),
                "track study" => assert_eq!(studied(block.text), [*code]),
                kind => {
                    assert_eq!(kind, "console", "{code}");
                    assert!(RUN_TIME.iter().any(|(c, _)| c == code), "{code} needs an example that can be tested");
                }
            }
        }
    }
}

#[test]
fn what_passes_gives_nothing() {
    for code in Code::ALL {
        for block in blocks(parts(*code).1) {
            match block.kind {
                "track" => {
                    let compiled = compiled(block.text);
                    assert!(found(*code, &compiled).is_empty(), "{code}:\n{}", told(&compiled));
                }
                "track run" => assert_eq!(outcome(block.text), Ok(()), "{code}"),
                "track study" => assert_eq!(studied(block.text), [], "{code}"),
                kind => assert_eq!(kind, "console", "{code}"),
            }
        }
    }
}

#[test]
fn a_rule_can_be_allowed_and_denied() {
    for code in Code::ALL.iter() {
        let Some(rule) = code.rule() else { continue };
        // a scene has one `scenario`: that of the page makes way
        let page = blocks(parts(*code).0)[0].text;
        let scene: String = page.lines().filter(|l| !l.starts_with("scenario ")).map(|l| format!("{l}\n")).collect();
        let allowed = compiled(&format!("{scene}\nscenario {{ allow = [{rule}: \"an example\"] }}\n"));
        assert!(found(*code, &allowed).is_empty(), "{code}:\n{}", told(&allowed));
        let denied = compiled(&format!("{scene}\nscenario {{ deny = {rule} }}\n"));
        let found = found(*code, &denied);
        assert!(found.iter().all(|d| d.severity == Severity::Error), "{code}:\n{}", told(&denied));
        assert!(!found.is_empty());
    }
}

#[test]
fn a_file_that_is_not_text_is_refused() {
    let mistake = trackbed::syntax::decode("scene.track", b"// ges\xE4ttigt").unwrap_err();
    assert_eq!(mistake.code, Code::E0102);
    assert!(blocks(parts(Code::E0102).0)[0].kind == "text");
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let text = blocks(parts(Code::L1006).1)[0].text.replace("400 axles", "40 axles");
    let compiled = compiled(&text);
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let open = |scene: &str, mode| {
        let work = trackbed::store::Work { name: "run".into(), scene_sha256: scene.to_owned() };
        trackbed::store::Directory::open(directory.path(), work, mode)
    };
    let kept = open("one", trackbed::store::Mode::New).unwrap();
    let mut recorder = trackbed::results::RunRecorder::new(&scenario, &graph).kept_in(&kept);
    trackbed::execute::execute(&graph, &mut recorder).unwrap();
    drop(recorder);
    drop(kept);
    assert!(open("two", trackbed::store::Mode::Resume).unwrap_err().is_of_another());
    let kept = open("one", trackbed::store::Mode::Resume).unwrap();
    let mut same = trackbed::results::RunRecorder::new(&scenario, &graph).kept_in(&kept);
    assert!(same.resume().unwrap().is_some());
}

#[test]
fn the_page_of_a_limit_names_the_map_that_shows_it() {
    for (code, map) in MAPS {
        let (page, map) = (code.page().replace('\n', " "), format!("docs/charts/{map}"));
        assert!(page.contains(&format!("`{map}`")), "{code}: {map}");
        assert!(
            page.contains("`trackbed stability FILE` draws it") || page.contains("`trackbed stability FILE` maps"),
            "{code}"
        );
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(&map).is_file(), "{map}");
    }
}
