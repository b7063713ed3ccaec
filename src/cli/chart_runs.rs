//! `trackbed chart --of run`: whole runs of a scene by every tier, their error against the finest and their time.

use super::running::{self, Request, Running};
use super::scene::{PassArguments, SceneArguments, failed, not_yet, show};
use super::subject::{json, write};
use super::terminal::aligned;
use super::{Format, Outcome, interrupt, stored, terminal};
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::report;
use crate::results::{self, Run};
use crate::scenario::Loading;
use crate::store::{Directory, Mode};
use crate::trials::runs::{
    Ended, RunChart, RunErrors, RunRow, RunSubject, RunVariant, SHARE, Took, reference, runs_csv, subject, variants,
};
use crate::units::{duration, percent};
use std::path::Path;
use std::time::Instant;

/// What a chart of runs is asked for.
pub(super) struct Asked<'a> {
    pub scene: &'a SceneArguments,
    pub out: &'a Path,
    pub axles: Option<u64>,
    /// Time for all runs, s.
    pub budget: f64,
    pub packings: u64,
    pub dry_run: bool,
    pub format: Format,
}

/// A variant that can run.
struct Planned {
    variant: RunVariant,
    compiled: Compiled,
}

impl Planned {
    fn new(subject: &RunSubject<'_>, variant: RunVariant) -> Result<Planned, String> {
        let compiled = subject.compile(&variant).to_run();
        match compiled.diagnostics.iter().find(|d| d.is_error()) {
            Some(mistake) => Err(mistake.message.clone()),
            None if compiled.runnable().is_none() => Err("there is nothing to run".to_owned()),
            None => Ok(Planned { variant, compiled }),
        }
    }

    fn graph(&self) -> &Graph {
        // a variant without a plan is none
        self.compiled.runnable().unwrap_or_else(|| unreachable!("planned without a plan"))
    }

    fn expected_seconds(&self) -> f64 {
        self.graph().cost.seconds_on_two_cores
    }

    /// Whether both compute the same.
    fn is_like(&self, other: &Planned) -> bool {
        let parts = |planned: &Planned| {
            let graph = planned.graph();
            (graph.nodes.clone(), graph.schedule.clone(), graph.supports.clone())
        };
        parts(self) == parts(other)
    }
}

pub(super) fn run(asked: &Asked<'_>) -> Outcome {
    let modules = asked.scene.remembered();
    let Some(compiled) = asked.scene.compile_with(&modules).map(Compiled::to_run) else { return Outcome::Usage };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    let Some(scenario) = &compiled.scenario else { return not_yet(&compiled) };
    if !matches!(scenario.loading, Some(Loading::Traffic(_))) {
        let message = "`chart` compares runs of trains, and no train passes in this scene";
        let diagnostic = Diagnostic::new(Code::E0701, message).help("give the scene a `train` and a `traffic`");
        terminal::diagnostics(&[diagnostic], &compiled.sources);
        return Outcome::Failed;
    }
    let name = asked.scene.file.display().to_string();
    let text = compiled.sources.iter().next().map_or("", |(_, source)| source.text.as_str());
    let bounds = (asked.axles, asked.budget);
    let subject = subject((&name, text), &modules, &asked.scene.set, scenario, bounds);
    let (mut finest, mut refused) = (Vec::new(), None);
    for planned in reference(scenario).into_iter().map(|variant| Planned::new(&subject, variant)) {
        match planned {
            Ok(planned) => finest.push(planned),
            Err(reason) => refused = refused.or(Some(reason)),
        }
    }
    // the finest within half of the time, else the fastest
    let within = finest.iter().position(|planned| planned.expected_seconds() <= SHARE * asked.budget);
    let Some(finest) = (!finest.is_empty()).then(|| finest.swap_remove(within.unwrap_or(finest.len() - 1))) else {
        terminal::error(&format!("no reference of this scene can run: {}", refused.unwrap_or_default()));
        return Outcome::Failed;
    };
    let (rows, chosen) = chosen(&subject, &finest, variants(scenario, asked.packings), asked.budget);
    announce(&subject, &finest, &rows, &chosen);
    if asked.dry_run {
        terminal::out(&aligned(&intended(&finest, &rows, &chosen)));
        return Outcome::Fine;
    }
    match computed(asked, &subject, finest, rows, &chosen) {
        Ok(chart) => told(asked, &chart),
        Err(outcome) => outcome,
    }
}

/// A row of the chart before it has run.
type Row = (RunVariant, Result<Planned, String>);

/// The variants that differ from the reference and from each other, and which of them run: the fastest first, as long
/// as the time for all suffices.
fn chosen(subject: &RunSubject<'_>, finest: &Planned, variants: Vec<RunVariant>, budget: f64) -> (Vec<Row>, Vec<bool>) {
    let mut rows: Vec<Row> = Vec::new();
    for variant in variants {
        let planned = Planned::new(subject, variant.clone());
        let known = |other: &Planned| planned.as_ref().is_ok_and(|planned| planned.is_like(other));
        if !known(finest) && !rows.iter().any(|(_, other)| other.as_ref().is_ok_and(known)) {
            rows.push((variant, planned));
        }
    }
    let seconds = |row: &Row| row.1.as_ref().map_or(f64::INFINITY, Planned::expected_seconds);
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| seconds(&rows[*a]).total_cmp(&seconds(&rows[*b])));
    let (mut sum, mut chosen) = (finest.expected_seconds(), vec![false; rows.len()]);
    for index in order {
        sum += seconds(&rows[index]);
        chosen[index] = sum <= budget;
    }
    (rows, chosen)
}

fn announce(subject: &RunSubject<'_>, finest: &Planned, rows: &[Row], chosen: &[bool]) {
    for sentence in &subject.shortened {
        terminal::note(&format!("shortened: {sentence}\n"));
    }
    let of_rows = rows.iter().zip(chosen).filter(|(_, chosen)| **chosen);
    let planned: Vec<&Planned> = of_rows.filter_map(|((_, planned), _)| planned.as_ref().ok()).collect();
    let seconds = finest.expected_seconds() + planned.iter().map(|planned| planned.expected_seconds()).sum::<f64>();
    terminal::note(&format!(
        "{} runs and the reference `{}`, about {}\n",
        planned.len(),
        finest.variant.name,
        duration(seconds)
    ));
}

/// What would run, as a table.
fn intended(finest: &Planned, rows: &[Row], chosen: &[bool]) -> Vec<Vec<String>> {
    let edits = |variant: &RunVariant| {
        let edits: Vec<String> = variant.edits.iter().map(|e| format!("{} = {}", e.path, e.value)).collect();
        edits.join(", ")
    };
    let line = |variant: &RunVariant, what: String| vec![variant.name.clone(), what, edits(variant)];
    let mut table = vec![["run", "about", "edits"].map(str::to_owned).to_vec()];
    table.push(line(&finest.variant, format!("{}, the reference", duration(finest.expected_seconds()))));
    for ((variant, planned), chosen) in rows.iter().zip(chosen) {
        table.push(line(
            variant,
            match planned {
                Ok(planned) if *chosen => duration(planned.expected_seconds()),
                Ok(planned) => format!("{}, left out", duration(planned.expected_seconds())),
                Err(reason) => format!("refused: {reason}"),
            },
        ));
    }
    table
}

/// Runs what is to run, and compares.
fn computed(
    asked: &Asked<'_>,
    subject: &RunSubject<'_>,
    finest: Planned,
    rows: Vec<Row>,
    chosen: &[bool],
) -> Result<RunChart, Outcome> {
    let Some((reference, took)) = run_one(asked, subject, &finest)? else {
        terminal::error(&format!("the reference `{}` has failed", finest.variant.name));
        return Err(Outcome::Failed);
    };
    let mut ran = Vec::new();
    for ((variant, planned), chosen) in rows.into_iter().zip(chosen) {
        let estimated = planned.as_ref().ok().map(Planned::expected_seconds);
        let result = match planned {
            Err(reason) => Err(Ended::Refused { reason }),
            Ok(_) if !chosen => Err(Ended::LeftOut),
            Ok(planned) => {
                let began = Instant::now();
                let ran = run_one(asked, subject, &planned)?;
                ran.ok_or_else(|| Ended::Stopped { seconds: began.elapsed().as_secs_f64() })
            }
        };
        ran.push((variant, estimated, result));
    }
    Ok(RunChart::new((&finest.variant, finest.graph(), &reference, took), &subject.shortened, ran))
}

/// Runs a variant into its own directory, or reads what it gave before; `None` if the run fails, which has been said.
/// No bed of another run is used, so that times can be compared.
fn run_one(asked: &Asked<'_>, subject: &RunSubject<'_>, planned: &Planned) -> Result<Option<(Run, Took)>, Outcome> {
    let Planned { variant, compiled } = planned;
    let out = asked.out.join("runs").join(&variant.name);
    let set = [subject.set.as_slice(), &variant.edits].concat();
    let request = Request {
        scene: SceneArguments { file: asked.scene.file.clone(), set },
        passes: PassArguments { without: Vec::new() },
        out: out.clone(),
        cache: None,
        force: false,
        is_worker: false,
        is_part: true,
    };
    let Some(scenario) = &compiled.scenario else { return Ok(None) };
    let running = Running::new(&request, compiled, (scenario, planned.graph()));
    let directory = Directory::open(&out, running.work.clone(), Mode::Resume);
    let directory = directory.map_err(|error| running.stop(stored::diagnostic(&error)))?;
    if directory.finished().is_none() {
        terminal::note(&format!("{}: about {}\n", variant.name, duration(planned.expected_seconds())));
        match running::compute(directory, &running, &|_, _| Ok(Vec::new())) {
            Ok(_) => {}
            Err(outcome) if interrupt::asked().load(std::sync::atomic::Ordering::Relaxed) => return Err(outcome),
            Err(_) => return Ok(None),
        }
    }
    read(&out).map(Some).map_err(|error| running.refuse(&error))
}

fn read(out: &Path) -> Result<(Run, Took), results::ResultsError> {
    let (run, timings) = (results::read(out)?, results::read_timings(out)?);
    let seconds = |name: &str| timings.get(name).copied().unwrap_or(0.0);
    Ok((run, Took { seconds: seconds("solve_s"), build_s: seconds("build_s") }))
}

fn told(asked: &Asked<'_>, chart: &RunChart) -> Outcome {
    let as_json = serde_json::to_string_pretty(chart).unwrap_or_default() + "\n";
    let files = [
        ("chart.csv", runs_csv(chart)),
        ("chart.json", as_json),
        ("chart.svg", report::runs_chart_svg(chart)),
        ("chart.html", report::runs_chart_page(chart)),
    ];
    if let Err(outcome) = write(Some(asked.out), &files) {
        return outcome;
    }
    match asked.format {
        Format::Json => json(chart),
        Format::Human => {
            terminal::out(&text(chart));
            terminal::summary(&format!("{}\n", asked.out.join("chart.html").display()));
            Outcome::Fine
        }
    }
}

fn text(chart: &RunChart) -> String {
    let mut out = format!("{}: {} axles\n", chart.title, chart.axles);
    for sentence in &chart.shortened {
        out.push_str(&format!("shortened: {sentence}\n"));
    }
    out.push_str(&format!("errors against `{}`, which took {}", chart.reference, duration(chart.took.seconds)));
    if chart.took.build_s > 0.0 {
        out.push_str(&format!(", {} of it until the first train", duration(chart.took.build_s)));
    }
    out.push_str("; `*` is not beaten by a faster run\n\n");
    let heads = ["run", "time", "to the first train"].into_iter().chain(RunErrors::ALL.map(|(_, name, _)| name));
    let mut table: Vec<Vec<String>> = vec![heads.map(str::to_owned).collect()];
    table.extend(chart.rows.iter().map(cells));
    out.push_str(&aligned(&table));
    if let Some(band) = chart.band() {
        out.push_str(&format!("\nanother packing of the same bed differs by up to {} of settlement\n", percent(band)));
    }
    if let Some((row, done)) = chart.fastest_within(chart.tolerance) {
        out.push_str(&format!(
            "\nthe fastest run with a settlement error of at most {}: `{}`, {}\n",
            percent(chart.tolerance),
            row.variant.name,
            duration(done.took.seconds)
        ));
    }
    out
}

/// A row of the table, with as many cells as every other.
fn cells(row: &RunRow) -> Vec<String> {
    let name = row.variant.name.clone();
    let mut cells = match &row.ended {
        Ended::Done(done) => {
            let mark = if done.efficient { " *" } else { "" };
            let errors = RunErrors::ALL.map(|(_, _, read)| read(&done.errors).map_or("-".to_owned(), percent));
            let took = [name + mark, duration(done.took.seconds), duration(done.took.build_s)];
            took.into_iter().chain(errors).collect()
        }
        Ended::LeftOut => {
            vec![name, format!("left out: about {}", row.estimated_s.map_or("?".to_owned(), duration))]
        }
        Ended::Stopped { seconds } => vec![name, format!("stopped by a solver after {}", duration(*seconds))],
        Ended::Refused { reason } => vec![name, format!("refused: {reason}")],
    };
    cells.resize(3 + RunErrors::ALL.len(), String::new());
    cells
}
