//! `trackbed calibrate --grains`: a settlement law for the grains of a scene, from specimens of its cells.

use super::bench::length;
use super::scene::{SceneArguments, failed, file_name, not_yet, show};
use super::terminal::aligned;
use super::{Format, Outcome, interrupt, pack, progress, terminal};
use crate::check::Override;
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic, and_list};
use crate::execute::{self, RunError};
use crate::graph::{Clock, Graph};
use crate::nodes::{Builders, NodeError};
use crate::report::{Fitted, specimens_svg};
use crate::scenario::{law_argument, law_form};
use crate::solvers::settlement::Form;
use crate::solvers::settlement::fit::FitError;
use crate::trials::specimens::{Bench, Curve, Ranges, Surrogate, fit_curves, kinds_of_cells};
use crate::units::{number, percent};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// What a law for grains must cover.
#[derive(clap::Args)]
pub(super) struct GrainArguments {
    /// Fit a law to the grains of the scene: specimens of its cells under trains of several loads and voids.
    #[arg(long, conflicts_with = "measured")]
    grains: bool,
    /// Least and largest factor of the forces that a train of the scene adds.
    #[arg(long, value_name = "A..B", default_value = "0.5..1.8", value_parser = factors, conflicts_with = "measured")]
    loads: [f64; 2],
    /// Largest void under a sleeper.
    #[arg(long, value_name = "LENGTH", default_value = "0.5 mm", value_parser = length, conflicts_with = "measured")]
    voids: f64,
    /// Trains that pass each specimen.
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(6..=10_000), conflicts_with = "measured")]
    trains: u32,
    /// Write the laws to this file, which a scene uses with `use`.
    #[arg(long, value_name = "FILE", conflicts_with = "measured")]
    out: Option<PathBuf>,
    /// Write a picture of the specimens and the laws to this file.
    #[arg(long, value_name = "FILE.svg", conflicts_with = "measured")]
    picture: Option<PathBuf>,
    /// Where packed beds and measured specimens are kept, by what made them.
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
}

/// A law for one kind of cell.
struct Found {
    name: String,
    /// The seat of the cell.
    place: String,
    curves: Vec<Curve>,
    /// The specimen whose loads change.
    check: Curve,
    surrogate: Surrogate,
}

/// The parameters of `power` that are fitted.
const FITTED: [&str; 4] = ["a", "m", "b", "g"];

/// Why there is no law.
enum Refused {
    Run(RunError),
    Fit { section: String, error: FitError },
}

/// `0.5..1.8`.
fn factors(text: &str) -> Result<[f64; 2], String> {
    let expected = || format!("expected two factors such as `0.5..1.8`, found `{text}`");
    let (least, most) = text.split_once("..").ok_or_else(expected)?;
    let factor = |text: &str| text.trim().parse::<f64>().map_err(|_| expected());
    let [least, most] = [factor(least)?, factor(most)?];
    if least > 0.0 && least <= 1.0 && (1.0..=10.0).contains(&most) && least < most {
        return Ok([least, most]);
    }
    Err("1 is the train of the scene: the least factor is above 0 and at most 1, the largest is from 1 to 10".into())
}

/// Fails if no `use` can name the file.
fn named_as_module(out: &Path) -> Result<(), String> {
    let name = out.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let is_name = |stem: &str| {
        let known = |character: char| character.is_ascii_alphanumeric() || character == '_';
        stem.starts_with(|first: char| first.is_ascii_alphabetic()) && stem.chars().all(known)
    };
    if name.strip_suffix(".track").is_some_and(is_name) {
        return Ok(());
    }
    let stem = out.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().to_lowercase());
    let letters = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect::<String>();
    let letters = letters.trim_start_matches(|c: char| !c.is_ascii_alphabetic()).trim_end_matches('_').to_owned();
    let better = if letters.is_empty() { "on_grains".to_owned() } else { letters };
    Err(format!(
        "no scene can `use` a module called `{name}`: a name has letters, digits and `_`; write `--out {}`",
        out.with_file_name(format!("{better}.track")).display()
    ))
}

pub(super) fn run(scene: &SceneArguments, asked: &GrainArguments, format: Format) -> Outcome {
    let is_module = |out: &Path| scene.is_beside(out).and_then(|()| named_as_module(out));
    let asked_for = [asked.out.as_deref().map(is_module), asked.picture.as_deref().map(|it| scene.is_beside(it))];
    let wrong: Vec<String> = asked_for.into_iter().flatten().filter_map(Result::err).collect();
    if !wrong.is_empty() {
        wrong.iter().for_each(|why| terminal::error(why));
        return Outcome::Usage;
    }
    let on_cells = Override { path: "solve.substructure".into(), value: "cells".into() };
    let of_cells =
        SceneArguments { file: scene.file.clone(), set: scene.set.iter().cloned().chain([on_cells]).collect() };
    let Some(compiled) = of_cells.compile().map(Compiled::to_run) else { return Outcome::Usage };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    if compiled.graph.as_ref().is_none_or(|graph| kinds_of_cells(graph).is_empty()) {
        let message = "no sleeper of the scene stands on grains under a train";
        let help = "give a trackform `layers` with a `granular`, and the scene a `traffic`";
        terminal::diagnostics(&[Diagnostic::new(Code::E0806, message).help(help)], &compiled.sources);
        return Outcome::Failed;
    }
    let Some(graph) = compiled.runnable() else { return not_yet(&compiled) };
    match laws(graph, asked) {
        Ok(found) => told(&found, scene, asked, format),
        Err(Refused::Run(RunError::Node { cause, .. })) if *cause == NodeError::Stopped => {
            terminal::note("stopped; finished specimens are kept, and the same command goes on from them\n");
            Outcome::Failed
        }
        Err(Refused::Run(error)) => {
            terminal::diagnostics(&[execute::diagnose(&error, graph, &compiled.origins)], &compiled.sources);
            Outcome::Failed
        }
        Err(Refused::Fit { section, error }) => {
            terminal::diagnostics(&[not_fitted(&section, &error)], &compiled.sources);
            Outcome::Failed
        }
    }
}

fn not_fitted(section: &str, error: &FitError) -> Diagnostic {
    let names = |parameters: &[usize]| {
        let names: Vec<String> = parameters.iter().map(|at| format!("`{}`", FITTED[*at])).collect();
        and_list(&names)
    };
    let why = match error {
        FitError::TooFew { needed } => format!("{needed} trains at least are needed"),
        FitError::NoEffect { parameters } => {
            format!("its settlement does not depend on {} of `power`", names(parameters))
        }
        FitError::Alike { parameters } => {
            format!("its settlement does not tell {} of `power` apart from the others", names(parameters))
        }
        FitError::NotFinite => "its settlement is no number".to_owned(),
    };
    Diagnostic::new(Code::E0806, format!("no law can be fitted to the grains of section `{section}`: {why}"))
        .help("let more trains pass (`--trains`), or use a wider range of `--loads` and `--voids`")
}

/// One law for each kind of cell.
fn laws(graph: &Graph, asked: &GrainArguments) -> Result<Vec<Found>, Refused> {
    let (builders, beds) = (Builders::default(), pack::beds(asked.cache.as_deref()));
    let stop = interrupt::asked();
    let going = || if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let (mut bar, mut shown) = (progress::Patient::seen("building the cells"), None);
    let bench = Bench::prepare(graph, &builders, &beds, &mut |stage, share| {
        if shown.replace(stage) != Some(stage) {
            bar = progress::Patient::new(stage.to_string());
        }
        bar.show((1e3 * share) as u64, 1000);
        going()
    });
    drop(bar);
    let Some(bench) = bench.map_err(Refused::Run)? else { return Ok(Vec::new()) };
    let ranges = Ranges { factors: asked.loads, void: asked.voids, trains: asked.trains };
    let mut programs: Vec<_> = ranges.trials().into_iter().map(|trial| vec![trial; ranges.trains as usize]).collect();
    programs.push(ranges.check());
    let kinds = kinds_of_cells(graph);
    let all = kinds.len() as u64 * programs.iter().map(|program| program.len() as u64).sum::<u64>();
    let (done, bar) = (AtomicU64::new(0), Mutex::new(progress::Patient::new("trains over specimens")));
    let tell = || {
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        bar.lock().unwrap_or_else(PoisonError::into_inner).show(done, all);
        going()
    };
    let mut found = Vec::new();
    for (cell, section) in &kinds {
        let mut curves = bench.curves(*cell, &programs, &tell).map_err(Refused::Run)?;
        let Some(check) = curves.pop() else { continue };
        let fitted = fit_curves(&curves, &check, reference(&check));
        let seat = bench.seat(*cell).map_err(|cause| Refused::Run(RunError::node(Clock::Axles(0), cause)))?;
        let place =
            graph.track().and_then(|track| track.seats.get(seat)).map_or(String::new(), |seat| seat.name.clone());
        let surrogate = fitted.map_err(|error| Refused::Fit { section: (*section).to_owned(), error })?;
        found.push(Found { name: named(section, &found), place, curves, check, surrogate });
    }
    Ok(found)
}

/// Mean peak of the wheels of the train of the scene, in whole kN, N: the check begins with this train.
fn reference(check: &Curve) -> f64 {
    let first = check.peaks.first().map_or(&[][..], Vec::as_slice);
    let mean = first.iter().map(|peak| peak.force).sum::<f64>() / first.len().max(1) as f64;
    (mean / 1e3).round().max(1.0) * 1e3
}

/// A name for the law of a section.
fn named(section: &str, before: &[Found]) -> String {
    let plain: String = section.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let name = format!("{plain}_on_grains");
    let again = before.iter().filter(|found| found.name.starts_with(&name)).count();
    if again == 0 { name } else { format!("{name}_{}", again + 1) }
}

fn told(found: &[Found], scene: &SceneArguments, asked: &GrainArguments, format: Format) -> Outcome {
    let file = file_name(&scene.file);
    let laws: Vec<String> = found.iter().map(|found| found.declaration(&file)).collect();
    let files = [
        asked.out.as_ref().map(|out| (out, laws.join("\n"))),
        asked.picture.as_ref().map(|out| (out, specimens_svg(&found.iter().map(Found::drawn).collect::<Vec<_>>()))),
    ];
    for (out, text) in files.into_iter().flatten() {
        if let Err(why) = scene.write_beside(out, text.as_bytes()) {
            terminal::error(&why);
            return Outcome::Failed;
        }
    }
    match format {
        Format::Json => {
            let laws: Vec<_> = found.iter().zip(&laws).map(|(found, text)| found.json(text)).collect();
            terminal::out(&format!("{:#}\n", json!({ "laws": laws })));
        }
        Format::Human => {
            found.iter().for_each(|found| terminal::out(&found.text()));
            match &asked.out {
                Some(out) => terminal::out(&used(found, out)),
                None => terminal::out(&laws.join("\n")),
            }
        }
    }
    Outcome::Fine
}

/// How a scene uses the file.
fn used(found: &[Found], out: &Path) -> String {
    let stem = out.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let name = found.first().map_or("", |found| found.name.as_str());
    let mut text = format!(
        "written to {}; a scene beside it uses it: `use {stem}`, `solve {{ substructure = law, law = {stem}.{name} }}`\n",
        out.display()
    );
    for other in found.iter().skip(1) {
        text += &format!(
            "the trackform or stretch of sleeper {} takes its own: `law = {stem}.{}`\n",
            other.place, other.name
        );
    }
    text
}

impl Found {
    fn text(&self) -> String {
        let Surrogate { law, standard_errors, rms, later, check, axles, .. } = &self.surrogate;
        let mut out = format!(
            "law {}: grains under sleeper {}, {} specimens, {axles} axles each\n\n",
            self.name,
            self.place,
            self.curves.len()
        );
        let mut form = Form::Power(*law);
        let names: Vec<(&str, f64)> = form.parameters().into_iter().map(|(name, value)| (name, *value)).collect();
        for (name, error) in FITTED.into_iter().zip(standard_errors) {
            let value = names.iter().find(|(other, _)| *other == name).map_or(0.0, |(_, value)| *value);
            let shown = |value: f64| law_argument("power", name, value);
            let error = error.map_or("on its bound".to_owned(), |error| format!("standard error {}", shown(error)));
            out += &format!("  {name:<4}{:<20}{error}\n", shown(value));
        }
        let mut rows = vec![
            ["load kN", "void mm", "settled mm", "law", "law of the others", "its error"].map(str::to_owned).to_vec(),
        ];
        let millimetres = |value: f64| format!("{:.3}", 1e3 * value);
        rows.extend(self.surrogate.left_out.iter().map(|one| {
            let values = [one.void, one.settled, one.fitted, one.predicted].map(millimetres);
            let mut row = vec![format!("{:.1}", one.force / 1e3)];
            row.extend(values);
            row.push(percent(one.error));
            row
        }));
        out += &format!("\n{}\n", aligned(&rows));
        out += &format!(
            "errors as shares of the largest settlement (root mean squares): {} of the fit, {} of a specimen by the law \
             of the others, {} of the last trains by the law of the first half; {} of a specimen whose loads change\n",
            percent(*rms),
            percent(self.surrogate.of_left_out()),
            percent(*later),
            percent(*check)
        );
        if let Some(stiffness) = self.stiffness() {
            out += &format!(
                "the grains alone carry the sleeper with {} MN/m under the last train\n",
                number((stiffness / 1e5).round() / 10.0)
            );
        }
        out + "\n"
    }

    /// The law and its specimens for a picture.
    fn drawn(&self) -> Fitted<'_> {
        let title = format!("law {}: grains under sleeper {}", self.name, self.place);
        Fitted { title, law: &self.surrogate.law, specimens: &self.curves, check: &self.check }
    }

    /// Stiffness of the grains of the specimens without a void, N/m: their mean.
    fn stiffness(&self) -> Option<f64> {
        let even = self.curves.iter().filter(|curve| curve.trials.iter().all(|trial| trial.void == 0.0));
        let found: Vec<f64> = even.filter_map(|curve| curve.stiffness).collect();
        (!found.is_empty()).then(|| found.iter().sum::<f64>() / found.len() as f64)
    }

    /// A `law` of the language.
    fn declaration(&self, file: &str) -> String {
        let surrogate = &self.surrogate;
        let [least, most] = surrogate.loads.map(|force| force / 1e3);
        format!(
            "/// Settlement of the grains under sleeper {} of {file}.\nlaw {} {{\n  form     = {}\n  loads    = {} .. {} kN per seat\n  \
             cycles   = 0 .. {} axles\n  voids    = 0 .. {} mm\n  error    = {}\n  source   = \"fitted to {} specimens \
             of the grains of {file} by trackbed calibrate\"\n  evidence = derived\n}}\n",
            self.place,
            self.name,
            law_form(Form::Power(surrogate.law)),
            number(least.floor()),
            number(most.ceil()),
            surrogate.most_axles(),
            number((1e5 * surrogate.void).ceil() / 100.0),
            percent((1e3 * surrogate.error()).ceil() / 1e3),
            self.curves.len()
        )
    }

    fn json(&self, declaration: &str) -> serde_json::Value {
        let surrogate = &self.surrogate;
        let specimens: Vec<_> = surrogate
            .left_out
            .iter()
            .zip(&self.curves)
            .map(|(one, curve)| {
                json!({
                    "factor": one.trial.factor,
                    "force_N": one.force,
                    "void_m": one.void,
                    "settled_m": curve.settled,
                    "stiffness_N_per_m": curve.stiffness,
                    "fitted_m": one.fitted,
                    "by_others_m": one.predicted,
                    "error": one.error,
                })
            })
            .collect();
        json!({
            "law": self.name,
            "sleeper": self.place,
            "axles": surrogate.axles,
            "most_axles": surrogate.most_axles(),
            "error": surrogate.error(),
            "rms": surrogate.rms,
            "check": surrogate.check,
            "later": surrogate.later,
            "stiffness_N_per_m": self.stiffness(),
            "parameters": { "a_m": surrogate.law.a, "m": surrogate.law.m, "b": surrogate.law.b, "g_per_m": surrogate.law.g },
            "specimens": specimens,
            "declaration": declaration,
        })
    }
}
