//! `trackbed pack`: builds the bed of a scene, shows it and keeps it.

use super::pack_track::{self, TrackArguments};
use super::scene::{SceneArguments, failed, show};
use super::{Format, Outcome, progress, stored, terminal};
use crate::compile::Compiled;
use crate::compile::fingerprint;
use crate::diag::{Code, Diagnostic};
use crate::graph::{BedError, BedPlan, BedRecipe};
use crate::lower::{self, BedUse};
use crate::report::{BedPage, Side};
use crate::results::{self, BedReadings, BedSummary, Beds, FoundBed};
use crate::solvers::granular::packing::Packed;
use crate::store::{Directory, Mode, StoreError, Work};
use crate::units::number;
use std::path::{Path, PathBuf};

/// Build the bed of a scene from its grains: packed, described, drawn and kept for runs
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed pack scenarios/box_test.track --out bed
  trackbed pack scenarios/box_test.track --set solve.seed=2 --out bed_2")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The trackform whose bed is wanted, where a scene has several
    #[arg(long, value_name = "NAME")]
    section: Option<String>,
    /// The directory for page, pictures and files for ParaView; made where it does not exist
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace what is in that directory
    #[arg(long, requires = "out")]
    force: bool,
    /// Where finished beds are kept, by what made them
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
    /// Build it anew, and keep nothing
    #[arg(long)]
    fresh: bool,
    #[command(flatten)]
    track: TrackArguments,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(compiled) = arguments.scene.compile() else { return Outcome::Usage };
    show(&compiled);
    let Some(scenario) = compiled.scenario.as_ref().filter(|_| !failed(&compiled)) else { return Outcome::Failed };
    let plan = match lower::beds(scenario, BedUse::Track).and_then(|plans| chosen(arguments, plans)) {
        Ok(plan) => plan,
        Err(mistakes) => return stop(&compiled, &mistakes),
    };
    // a folder that cannot be is told before minutes of packing
    let directory = match arguments.out.as_deref().map(|out| open(out, arguments.force, &compiled)).transpose() {
        Ok(directory) => directory,
        Err(error) => return stop(&compiled, &[stored::diagnostic(&error)]),
    };
    let beds = if arguments.fresh { Beds::not_kept() } else { beds(arguments.cache.as_deref()) };
    let (mut packed, kept) = match kept_or_built(&beds, &plan) {
        Ok(found) => found,
        Err(mistake) => return stop(&compiled, &[mistake]),
    };
    let readings = match read(beds.folder(), &plan, &packed) {
        Ok(readings) => readings,
        Err(message) => {
            terminal::error(&message);
            return Outcome::Failed;
        }
    };
    let summary = results::bed_summary(&scenario.title, &plan, &packed, Some(readings));
    if let Some(directory) = directory
        && let Err(message) = write(directory, &summary, &mut packed)
    {
        terminal::error(&message);
        return Outcome::Failed;
    }
    let told = tell(arguments, &summary, kept);
    let further = arguments.track.further(&plan).iter().map(|plan| Ok(kept_or_built(&beds, plan)?.0)).collect();
    let cells = match further {
        Ok::<Vec<_>, Diagnostic>(further) => [vec![packed], further].concat(),
        Err(mistake) => return stop(&compiled, &[mistake]),
    };
    match arguments.track.lay(&cells, &plan) {
        None => told,
        Some(Err(mistake)) => stop(&compiled, &[mistake]),
        Some(Ok(mut laid)) => match pack_track::tell(&mut laid, arguments.out.as_deref(), arguments.format) {
            Ok(()) => told,
            Err(message) => {
                terminal::error(&message);
                Outcome::Failed
            }
        },
    }
}

/// The directory for a bed.
fn open(out: &Path, force: bool, compiled: &Compiled) -> Result<Directory, StoreError> {
    let work = Work { name: "bed".to_owned(), scene_sha256: fingerprint(&compiled.sources) };
    Directory::open(out, work, if force { Mode::Force } else { Mode::New })
}

/// The bed that is meant.
fn chosen(arguments: &Arguments, plans: Vec<BedPlan>) -> Result<BedRecipe, Vec<Diagnostic>> {
    let refused = |message: String, help: String| vec![Diagnostic::new(Code::E0610, message).help(help)];
    let names: Vec<String> = plans.iter().map(|plan| format!("`{}`", plan.section)).collect();
    let mut plans = plans.into_iter();
    let Some(name) = &arguments.section else {
        let plan = plans.next().ok_or_else(|| {
            let help = "give a trackform `layers` of a `granular` material";
            refused("this scene has no grains to pack".to_owned(), help.to_owned())
        })?;
        return ready(&plan);
    };
    let plan = plans.find(|plan| plan.section == *name).ok_or_else(|| {
        let help =
            if names.is_empty() { "no section has any".to_owned() } else { format!("there is {}", names.join(", ")) };
        refused(format!("no bed of its own lies under a trackform `{name}`"), help)
    })?;
    ready(&plan)
}

/// The bed of a plan with its clumps.
fn ready(plan: &BedPlan) -> Result<BedRecipe, Vec<Diagnostic>> {
    let refused = |error: BedError| Diagnostic::new(Code::E0610, format!("this bed cannot be packed: {error}"));
    plan.ready(plan.seed()).map_err(|error| vec![refused(error)])
}

/// Where beds are kept: where the user says, else where programs of this machine keep what they can build again.
pub(super) fn beds(given: Option<&Path>) -> Beds {
    let home = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".cache"));
    let usual = || Some(std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from).or_else(home)?.join("trackbed/beds"));
    given.map(Path::to_path_buf).or_else(usual).map_or_else(Beds::not_kept, Beds::kept_in)
}

/// The bed of a plan and whether it was there already; a new one is kept.
fn kept_or_built(beds: &Beds, plan: &BedRecipe) -> Result<(Packed<f32>, bool), Diagnostic> {
    let mut bar = progress::Patient::new("the bed");
    let found = beds.bed(&plan.recipe, |progress| show_share(&mut bar, progress.share)).map_err(|error| {
        Diagnostic::new(Code::E0810, error.to_string())
            .help("give the `packing` of the material more `local_damping`, or less `pressure`")
    })?;
    tell_loss(&found);
    Ok((found.packed, found.was_kept))
}

/// How far work is.
pub(super) fn show_share(bar: &mut progress::Patient, share: f64) {
    bar.show((1e4 * share) as u64, 10_000);
}

/// A bed that was damaged, or cannot be kept, is there all the same.
pub(super) fn tell_loss(found: &FoundBed) {
    if let Some(error) = &found.damage {
        terminal::error(&format!("the bed was packed anew: {error}"));
    }
    if let Some(error) = &found.loss {
        terminal::error(&format!("the bed is not kept: {error}"));
    }
}

/// What is read off the bed, from before where it was kept.
fn read(cache: Option<&Path>, plan: &BedRecipe, packed: &Packed<f32>) -> Result<BedReadings, String> {
    match cache.map(|cache| results::kept_readings(cache, plan)) {
        Some(Ok(Some(kept))) => return Ok(kept),
        Some(Err(error)) => terminal::error(&format!("the bed was measured anew: {error}")),
        Some(Ok(None)) | None => {}
    }
    let mut bar = progress::Patient::new("the plate");
    let readings = results::read_bed(plan, packed, |done, all| bar.show(done as u64, all as u64))
        .map_err(|failure| format!("cannot measure the bed: {failure}"))?;
    if let Some(cache) = cache
        && let Err(error) = results::keep_readings(cache, plan, &readings)
    {
        terminal::error(&format!("what was read off the bed is not kept: {error}"));
    }
    Ok(readings)
}

fn stop(compiled: &Compiled, mistakes: &[Diagnostic]) -> Outcome {
    terminal::diagnostics(mistakes, &compiled.sources);
    Outcome::Failed
}

/// The page, its pictures, numbers for programs and files for ParaView.
fn write(mut directory: Directory, summary: &BedSummary, packed: &mut Packed<f32>) -> Result<(), String> {
    let failure = |error: &dyn std::fmt::Display| format!("cannot write the bed: {error}");
    let snapshot = packed.bed.snapshot().map_err(|error| failure(&error))?;
    let (grains, links) = (results::grains(&packed.bed, &snapshot, None), results::links(&packed.bed, &snapshot));
    let page = BedPage {
        summary,
        samples: &packed.samples,
        grains: &grains,
        links: &links,
        walls: packed.bed.walls(),
        domain: packed.bed.domain(),
    };
    let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
    results::bodies_vtk(&grains, &mut bodies)
        .and(results::contacts_vtk(&links, &mut contacts))
        .map_err(|error| failure(&error))?;
    let json = serde_json::to_vec_pretty(summary).map_err(|error| failure(&error))?;
    let files: [(&str, Vec<u8>); 6] = [
        ("bodies.vtp", bodies),
        ("contacts.vtp", contacts),
        ("along.svg", page.side(Side::X, false, &summary.title).into_bytes()),
        ("chains.svg", page.side(Side::Y, true, &summary.title).into_bytes()),
        ("bed.json", json),
        ("bed.html", page.html().into_bytes()),
    ];
    let staged = files.iter().try_for_each(|(name, bytes)| directory.stage(name, bytes));
    staged.and_then(|()| directory.commit().map(drop)).map_err(|error| failure(&error))
}

fn tell(arguments: &Arguments, summary: &BedSummary, kept: bool) -> Outcome {
    if arguments.format == Format::Json {
        return match serde_json::to_string_pretty(summary) {
            Ok(json) => {
                terminal::out(&format!("{json}\n"));
                Outcome::Fine
            }
            Err(error) => {
                terminal::error(&format!("cannot write the bed as JSON: {error}"));
                Outcome::Failed
            }
        };
    }
    terminal::summary(&text(summary, kept));
    if let Some(out) = &arguments.out {
        terminal::summary(&format!("\nwrote {}\n", out.join("bed.html").display()));
    }
    Outcome::Fine
}

fn text(summary: &BedSummary, kept: bool) -> String {
    let [length, width] = summary.plan_m;
    let mut out = format!(
        "bed of `{}`: {} m x {} m, {} grains of {} pebbles{}\n\n",
        summary.section,
        number(length),
        number(width),
        summary.bodies,
        summary.pebbles,
        if kept { ", as it was kept" } else { "" }
    );
    out += "layer               grains  thickness  porosity  inside  neighbours  without friction  rattlers\n";
    for layer in summary.layers.iter().rev() {
        out += &format!(
            "{:18} {:7}  {:6.0} mm {:9.3} {:7.3} {:11.2} {:17.2} {:7.1} %\n",
            layer.name,
            layer.bodies,
            1e3 * layer.thickness_m,
            layer.porosity,
            layer.inner_porosity,
            layer.coordination,
            layer.coordination_pressed,
            100.0 * layer.rattlers
        );
    }
    out += &summary.readings.as_ref().map_or(String::new(), measured);
    for note in &summary.notes {
        out += &format!("\n{note}");
    }
    out + "\n"
}

/// What its contacts and a plate say of it, in two lines.
fn measured(readings: &BedReadings) -> String {
    let (forces, fabric) = (&readings.forces, &readings.directions);
    let percent = |share: Option<f64>| share.map_or("none".to_owned(), |share| format!("{:.1} %", 100.0 * share));
    let mut out = format!(
        "\ncontacts: {} of {:.0} N in the mean, {} of their friction used, {} slide; fabric deviator {:.3}, of strong contacts {:.3}\n",
        forces.contacts,
        forces.mean,
        percent(forces.mobilised),
        percent(forces.sliding),
        fabric.deviator,
        readings.strong_directions.deviator
    );
    if let Some(plate) = &readings.plate {
        let sides = plate.sides_m.map_or("over the whole cell".to_owned(), |[length, width]| {
            format!("of {} m x {} m", number(length), number(width))
        });
        let [first, again] = plate.stiffness_N_per_m.map(|k| k / 1e6);
        out += &format!("plate {sides} to {:.0} kPa: {first:.1} MN/m, then {again:.1} MN/m", plate.pressure_Pa / 1e3);
        if let Some([first, again]) = plate.moduli_Pa.map(|moduli| moduli.map(|modulus| modulus / 1e6)) {
            out += &format!("; Ev1 {first:.0} MPa, Ev2 {again:.0} MPa, Ev2/Ev1 {:.1}", again / first);
        }
        out += "\n";
    }
    out
}
