//! From evaluated declarations to the scene: every part in order, each from the parts before it.

use super::ask::reader::{Counting, questions};
use super::ask::study::studies;
use super::evaluate::evaluator::Evaluator;
use super::evaluate::value::{Record, Val};
use super::parts::asked::{Asked, forms, has_layers};
use super::parts::layout::layout;
use super::parts::loads::{cycles, loads};
use super::parts::rails::shear_stiffnesses;
use super::parts::records::kept;
use super::parts::solve::solve;
use super::parts::tamping::tampings;
use super::parts::track::track;
use super::parts::traffic::traffic;
use super::text::scope::MAIN_FILE;
use crate::diag::{self, Code, Diagnostic, Span};
use crate::scenario::response::Expectation;
use crate::scenario::{Loading, RigLoad, Scenario, Study};

/// The content of a `scenario`: title and physics rules.
#[derive(Default)]
struct Head {
    title: String,
    allow: Vec<(String, String)>,
    deny: Vec<String>,
    warn: Vec<String>,
}

/// Evaluates every declaration of the user's files, then builds the scene and reads the questions about it.
pub fn scene(eval: &mut Evaluator<'_>) -> (Option<Scenario>, Vec<Study>) {
    if eval.scopes[eval.main].tree.items.is_empty() {
        if !diag::has_errors(&eval.findings.diagnostics) {
            eval.findings.report(
                Diagnostic::new(Code::E0601, "the file declares nothing")
                    .label(Span::new(MAIN_FILE, 0, 0), "empty")
                    .help("`trackbed new` writes a scene to begin with"),
            );
        }
        return (None, Vec::new());
    }
    let roots = eval.evaluate_all();
    let track_record = eval.only("track");
    let found = match &track_record {
        Some(record) => with_track(record, eval),
        None => {
            // read all the same
            let records = eval.asking();
            questions(&records, eval, Counting::default());
            (None, Vec::new())
        }
    };
    eval.idle_lets();
    eval.findings.say_missing();
    // a misspelt or unreadable name may be the missing use
    if let Some(track) = track_record.filter(|_| !diag::has_errors(&eval.findings.diagnostics)) {
        let waiting = waiting(&track, eval);
        eval.unused(&roots, &waiting);
    }
    found
}

/// Kinds with objects that are unused because another part is missing: trains without traffic, and materials of a rig
/// without layers.
fn waiting(track: &Record, eval: &Evaluator<'_>) -> Vec<&'static str> {
    let (runs, loaded) = (eval.declares("traffic"), eval.declares("load"));
    match (runs, loaded) {
        (false, false) => vec!["train"],
        (false, true) if !forms(track).any(has_layers) => vec!["granular", "soil"],
        _ => Vec::new(),
    }
}

fn with_track(track_record: &Record, eval: &mut Evaluator<'_>) -> (Option<Scenario>, Vec<Study>) {
    let traffic_record = eval.only("traffic");
    let load_records = eval.all("load");
    let solve_record = eval.only("solve").unwrap_or_else(|| eval.default_solve());
    let asked = Asked::by_scene(&solve_record, track_record, traffic_record.is_some(), &load_records);
    let seed = solve_record.number("seed").map_or(1, |seed| seed.value as u64);
    let layout = layout(track_record, asked, seed, &mut eval.files, &mut eval.findings);
    let places = layout.as_ref().map(|layout| &layout.places);
    let track = layout.as_ref().and_then(|layout| track(track_record, layout, asked, eval));
    let traffic = traffic_record.as_ref().and_then(|record| traffic(record, places, &mut eval.findings));
    let (traffic, counted) = traffic.unzip();
    let counted = counted.as_ref();
    let loads = load_records.iter().map(|record| loads(record, places, &mut eval.files, &mut eval.findings));
    let loads: Vec<Option<Vec<RigLoad>>> = loads.collect();
    let solve = solve(&solve_record, places, &mut eval.findings);
    if let Some(solve) = &solve {
        shear_stiffnesses(track_record, solve.beam, &mut eval.findings);
    }
    let records = eval.all("record");
    let cycles = cycles(&load_records);
    let kept = records.iter().map(|record| kept(record, places, cycles, asked, counted, &mut eval.findings));
    let kept: Vec<Option<_>> = kept.collect();
    let tamping_records = eval.all("tamping");
    let tampings = tampings(&tamping_records, places, track.as_ref(), asked, counted, &mut eval.findings);
    let counting = Counting { places, traffic: asked.traffic, counted };
    let expectations = expectations(eval, counting);
    let head = head(eval);
    let library = eval.library_entries();
    let assemble = || {
        let loads = loads.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
        let loading = if traffic_record.is_some() { Some(Loading::Traffic(traffic?)) } else { of_loads(loads) };
        let (records, volumes): (Vec<_>, Vec<_>) = kept.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        Some(Scenario {
            title: head.title,
            track: track?,
            loading,
            tampings: tampings?,
            solve: solve?,
            records: records.into_iter().flatten().collect(),
            volumes: volumes.into_iter().flatten().collect(),
            expectations,
            allow: head.allow,
            deny: head.deny,
            warn: head.warn,
            library,
        })
    };
    (assemble(), studies(eval, counting))
}

/// The kind of test loads; `None` without test loads.
fn of_loads(loads: Vec<RigLoad>) -> Option<Loading> {
    if loads.is_empty() {
        return None;
    }
    Some(match loads.iter().map(RigLoad::at_rest).collect() {
        Some(at_rest) => Loading::Static(at_rest),
        None => Loading::Rig(loads),
    })
}

fn expectations(eval: &mut Evaluator<'_>, counting: Counting<'_>) -> Vec<Expectation> {
    let records = eval.all("expect");
    questions(&records, eval, counting).iter().flat_map(|asked| asked.comparisons("that")).collect()
}

/// Title and physics rules; without a title the file's name.
fn head(eval: &mut Evaluator<'_>) -> Head {
    let record = eval.only("scenario");
    let name = &eval.files.sources.get(MAIN_FILE).name;
    let stem = name.rsplit(['/', '\\']).next().unwrap_or(name).trim_end_matches(".track").to_string();
    let Some(record) = record else { return Head { title: stem, ..Head::default() } };
    let text = |val: &Val| if let Val::Text(t) = val { Some(t.clone()) } else { None };
    let allow = match record.get("allow").map(|s| &s.value) {
        Some(Val::Pairs(pairs)) => pairs.iter().filter_map(|(k, v)| Some((text(&k.value)?, text(&v.value)?))).collect(),
        _ => Vec::new(),
    };
    let rules = |field: &str| match record.get(field).map(|s| &s.value) {
        Some(Val::List(slots)) => slots.iter().filter_map(|s| text(&s.value)).collect(),
        _ => Vec::new(),
    };
    let title = record.text("title").map_or(stem, str::to_string);
    Head { title, allow, deny: rules("deny"), warn: rules("warn") }
}
