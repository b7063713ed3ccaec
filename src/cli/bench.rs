//! `trackbed bench`: how fast the solvers are on this machine. `grains` is the first of its kind.

use super::scene::{SceneArguments, failed, not_yet, show};
use super::{Format, Outcome, pack, progress, subject, terminal};
use crate::execute;
use crate::graph::Graph;
use crate::lower::Origins;
use crate::nodes::{PassageEnergy, TimedSteps};
use crate::report::{self, BedView, Colour, Side};
use crate::results;
use crate::solvers::granular::Real;
use crate::trials::grains::{self, Finished, Measured, Pile, PileError, Request, Share};
use crate::units::{Dimension, parse_unit};
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Measure the speed of a solver on this machine
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed bench scene scenarios/transition_short.track --steps 400
  trackbed bench grains --bed bed.txt --copies 2x2")]
pub(super) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Grains(Grains),
    Scene(SceneSteps),
}

/// Steps of the grains of a scene under its first train, with the rail over them and the soil below, and where their
/// time goes
///
/// The beds are packed, or taken from where they are kept, laid and brought to rest first; that is not timed.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed bench scene scenarios/transition_short.track --steps 400
  trackbed bench scene scenarios/transition_short.track --steps 400 --threads 2 --format json")]
struct SceneSteps {
    #[command(flatten)]
    scene: SceneArguments,
    /// Steps that are timed.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,
    /// Also runs the first passage whole, with an account of its energy: what rail, grains and soil lose, and what no
    /// part explains
    #[arg(long)]
    energy: bool,
    /// Also lets the track lie for a second without a train and tells how far its sleepers move
    #[arg(long)]
    idle: bool,
    /// Threads; all cores where it is not given. The motion does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Where packed beds are kept, by what made them.
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

/// Steps of a bed of spheres or clumps under shaken gravity, and where their time goes
///
/// Linear springs of 13 MN/m, friction 0.7, a normal dashpot of 829 N s/m that may pull, 2700 kg/m3, steps of 10 us.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed bench grains --bed bed.txt
  trackbed bench grains --bed bed.txt --copies 2x2 --steps 500 --repeat 3")]
struct Grains {
    /// A line of `x y z r` for each sphere, or `clump x y z r` for each pebble, in m. The first line says where the bed
    /// ends: `# periodic x 1.2 m, y 1.2 m; rigid floor z = 0`.
    #[arg(long, value_name = "FILE")]
    bed: PathBuf,
    /// Steps that are timed.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,
    /// Steps before those that are timed.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=1_000_000_000))]
    warm: u64,
    /// Do all of it so often, each time from the file, and tell the run of middle length.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// Copies of the bed along x and y, as `5x2`.
    #[arg(long, value_name = "NXxNY", default_value = "1x1", value_parser = copies)]
    copies: [u32; 2],
    /// Threads; all cores where it is not given. The motion does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// `mixed`: forces in single, places and sums in double precision. `f64`: the reference, all in double.
    #[arg(long, value_enum, default_value = "mixed")]
    precision: Precision,
    /// Reach of the neighbour lists, as `2 mm`; the bed chooses it by how long its lists last where it is not given.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    skin: Option<f64>,
    /// Draw the bed after the last step, from the side, as SVG.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Quantity that the colours of the picture show.
    #[arg(long, value_enum, default_value = "displacement")]
    color_by: Color,
    /// The edge of the bed along which the picture runs.
    #[arg(long, value_enum, default_value = "x")]
    side: SideName,
    /// Draw the forces of the grains that are seen as lines between their centres.
    #[arg(long)]
    chains: bool,
    /// Write pebbles and contacts after the last step as `bodies.vtp` and `contacts.vtp`, for ParaView.
    #[arg(long, value_name = "DIR")]
    vtk: Option<PathBuf>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Color {
    Displacement,
    Speed,
    Force,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum SideName {
    X,
    Y,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Precision {
    Mixed,
    F64,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    match &arguments.what {
        What::Grains(grains) => grains.run(),
        What::Scene(scene) => scene.run(),
    }
}

/// Does work with so many threads.
fn with_threads(threads: Option<u16>, work: impl FnOnce() -> Outcome + Send) -> Outcome {
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        pool = pool.num_threads(threads.into());
    }
    match pool.build() {
        Ok(pool) => pool.install(work),
        Err(error) => {
            terminal::error(&format!("cannot start the threads: {error}"));
            Outcome::Failed
        }
    }
}

impl SceneSteps {
    fn run(&self) -> Outcome {
        let Some(compiled) = self.scene.compile() else { return Outcome::Usage };
        show(&compiled);
        let Some(graph) = compiled.graph.as_ref().filter(|graph| graph.runs && !failed(&compiled)) else {
            return not_yet(&compiled);
        };
        with_threads(self.threads, || self.measure(graph, &compiled.origins))
    }

    fn measure(&self, graph: &Graph, origins: &Origins) -> Outcome {
        let measured = execute::Measured { steps: self.steps, energy: self.energy, idle: self.idle };
        let (mut bar, mut shown) = (progress::Patient::seen("building the track on grains"), None);
        let beds = pack::beds(self.cache.as_deref());
        let timed = execute::time_steps(graph, &beds, measured, &mut |stage, share| {
            if shown.replace(stage) != Some(stage) {
                bar = progress::Patient::new(stage.to_string());
            }
            bar.show((1e3 * share) as u64, 1000);
            ControlFlow::Continue(())
        });
        drop(bar);
        match timed {
            Ok(timed) if self.format == Format::Json => subject::json(&timed),
            Ok(timed) => {
                terminal::out(&text_of_steps(&timed));
                Outcome::Fine
            }
            Err(error) => {
                terminal::error(&execute::diagnose(&error, graph, origins).message);
                Outcome::Failed
            }
        }
    }
}

fn text_of_steps(m: &TimedSteps) -> String {
    let mut out = format!("{} grains of {} pebbles under {} sleepers\n", m.grains, m.pebbles, m.sleepers);
    let added = 100.0 * m.added_inertia;
    out += &format!("steps of {:.2} us, {added:.2} % of the mass added as inertia\n", m.time_step_us);
    out += &format!("{:.2} ms a step (median of {} steps)\n\n", m.milliseconds_per_step, m.steps);
    let p = &m.parts_ms;
    for (label, ms) in [
        ("lists", p.lists),
        ("forces", p.forces),
        ("walls", p.walls),
        ("motion", p.motion),
        ("inertia", p.inertia),
        ("rail", p.rail),
        ("soil", p.soil),
    ] {
        out += &format!("  {label:<18}{ms:>8.3} ms\n");
    }
    out += "\nrail and soil are computed at the same time as forces and motion\n";
    out += &format!(
        "{:.0} s of computing a simulated second, {:.0} s an axle\n",
        m.seconds_a_simulated_second, m.seconds_an_axle
    );
    if let Some(energy) = &m.energy {
        out += &text_of_energy(energy);
    }
    if let Some(moved) = m.idle_m {
        out += &format!("\nin a second without a train no sleeper moves by more than {:.3} um\n", 1e6 * moved);
    }
    out
}

fn text_of_energy(e: &PassageEnergy) -> String {
    let mut out = format!("\nthe wheels of a passage do {:.1} J of work\n", e.wheels);
    for (label, joules) in [
        ("lost in the track", e.lost_in_track),
        ("slip", e.slip),
        ("dashpots", e.dashpots),
        ("local damping", e.local_damping),
        ("lost in the soil", e.lost_in_soil),
        ("at interfaces", e.interfaces),
        ("unaccounted", e.unaccounted),
    ] {
        out += &format!("  {label:<18}{joules:>12.4} J, {:>8.4} %\n", 100.0 * joules / e.wheels);
    }
    out
}

impl Grains {
    fn run(&self) -> Outcome {
        let grains = self;
        let name = grains.bed.display();
        let pile =
            match File::open(&grains.bed).map_err(PileError::from).and_then(|file| Pile::read(BufReader::new(file))) {
                Ok(pile) => pile,
                Err(PileError::Unreadable(cause)) => {
                    terminal::error(&format!("cannot read `{name}`: {cause}"));
                    return Outcome::Usage;
                }
                Err(error) => {
                    terminal::error(&format!("`{name}`, {error}"));
                    return Outcome::Failed;
                }
            };
        if let Err(mistake) = grains.check(&pile) {
            terminal::error(&mistake);
            return Outcome::Usage;
        }
        with_threads(grains.threads, || match grains.precision {
            Precision::Mixed => grains.measure::<f32>(&pile),
            Precision::F64 => grains.measure::<f64>(&pile),
        })
    }
}

/// `5x2`.
fn copies(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once('x').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    match numbers {
        Some(copies) if copies.iter().all(|n| (1..=1000).contains(n)) => Ok(copies),
        _ => Err(format!("expected copies along x and y from 1 to 1000, such as `5x2`, found `{text}`")),
    }
}

/// `2 mm`, in m.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let expected = || format!("expected a length such as `2 mm`, found `{text}`");
    let end = text.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).ok_or_else(expected)?;
    let (value, unit) = text.split_at(end);
    let value: f64 = value.trim().parse().map_err(|_| expected())?;
    match parse_unit(unit.trim()) {
        Ok(unit) if unit.dimension == Dimension::LENGTH && value > 0.0 && value.is_finite() => Ok(value * unit.factor),
        Ok(unit) if unit.dimension == Dimension::LENGTH => Err("the length must be above 0".into()),
        _ => Err(expected()),
    }
}

impl Grains {
    /// What does not fit the bed.
    fn check(&self, pile: &Pile) -> Result<(), String> {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            if self.copies[axis] > 1 && !pile.repeats(axis) {
                let bed = self.bed.display();
                return Err(format!("`{bed}` is not periodic along {name}, so copies cannot stand side by side there"));
            }
        }
        let pebbles = pile.pebbles() * self.copies.iter().map(|&n| u64::from(n)).product::<u64>();
        if pebbles > grains::MOST {
            return Err(format!("{pebbles} pebbles are too many; at most {} fit a bed", grains::MOST));
        }
        match self.skin {
            Some(skin) if skin > pile.largest() => {
                Err(format!("a skin of {skin} m is more than the largest radius, {} m", pile.largest()))
            }
            _ => Ok(()),
        }
    }

    fn measure<R: Real>(&self, pile: &Pile) -> Outcome {
        let &Grains { copies, skin, warm, steps, repeat, .. } = self;
        let mut bar = progress::Patient::new("steps");
        let finished =
            grains::measure::<R>(pile, &Request { copies, skin, warm, steps, repeat }, |done, all| bar.show(done, all));
        drop(bar);
        let finished = match finished {
            Ok(finished) => finished,
            Err(failure) => {
                terminal::error(&failure.to_string());
                return Outcome::Failed;
            }
        };
        if let Err(mistake) = self.show(pile, &finished) {
            terminal::error(&mistake);
            return Outcome::Failed;
        }
        let (mut measured, moved) = (finished.measured, finished.bed.bytes_per_step());
        drop((finished.bed, finished.snapshot));
        measured.set_against(grains::triad(), moved);
        match self.format {
            Format::Human => {
                terminal::out(&self.text(&measured));
                Outcome::Fine
            }
            Format::Json => subject::json(&measured),
        }
    }

    /// Writes the picture and the VTK files that are wanted.
    fn show<R: Real>(&self, pile: &Pile, finished: &Finished<R>) -> Result<(), String> {
        if self.picture.is_none() && self.vtk.is_none() {
            return Ok(());
        }
        let Finished { bed, snapshot, measured } = finished;
        let start = results::places(&grains::bed::<R>(pile, self.copies, self.skin));
        let rows = results::grains(bed, snapshot, Some(&start));
        let links = results::links(bed, snapshot);
        let write = |path: &Path, bytes: &[u8]| results::write_atomically(path, bytes).map_err(|e| e.to_string());
        if let Some(directory) = &self.vtk {
            std::fs::create_dir_all(directory)
                .map_err(|e| format!("cannot make the directory `{}`: {e}", directory.display()))?;
            let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
            let made = results::bodies_vtk(&rows, &mut bodies).and(results::contacts_vtk(&links, &mut contacts));
            made.map_err(|e| e.to_string())?;
            write(&directory.join("bodies.vtp"), &bodies)?;
            write(&directory.join("contacts.vtp"), &contacts)?;
        }
        if let Some(path) = &self.picture {
            let milliseconds = 1e3 * bed.time();
            let title =
                format!("{} after {} steps, {milliseconds:.2} ms", self.name(), measured.warm_steps + measured.steps);
            let view = BedView {
                title: &title,
                grains: &rows,
                chains: if self.chains { &links } else { &[] },
                walls: bed.walls(),
                domain: bed.domain(),
                side: match self.side {
                    SideName::X => Side::X,
                    SideName::Y => Side::Y,
                },
                colour: match self.color_by {
                    Color::Displacement => Colour::Displacement,
                    Color::Speed => Colour::Speed,
                    Color::Force => Colour::Force,
                },
            };
            write(path, report::bed_svg(&view).as_bytes())?;
        }
        Ok(())
    }

    fn name(&self) -> String {
        self.bed.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn text(&self, m: &Measured) -> String {
        let name = self.name();
        let mut out = match m.clump_steps_per_second {
            None => format!("{name}: {} spheres", m.bodies),
            Some(_) => format!("{name}: {} bodies of {} pebbles", m.bodies, m.pebbles),
        };
        out += &format!(", {} contacts, {:.2} a body\n", m.contacts, m.contacts_per_body);
        let of = if m.repeats > 1 { format!(", the middle of {} runs", m.repeats) } else { String::new() };
        out += &format!(
            "{} steps in {:.3} s{of}; {}, {} precision\n\n",
            m.steps,
            m.seconds,
            counted(m.threads, "thread"),
            m.precision
        );
        let mut row = |label: &str, text: String| out += &format!("  {label:<18}{text}\n");
        let million = |value: f64| format!("{:.2} million", value / 1e6);
        if let Some(clumps) = m.clump_steps_per_second {
            row("clump-steps", format!("{} a second", million(clumps)));
        }
        row("sphere-steps", format!("{} a second", million(m.sphere_steps_per_second)));
        row("contact updates", format!("{} a second", million(m.contact_updates_per_second)));
        row(
            "kinetic energy",
            format!("{:.6} J of translation, {:.6} J of rotation", m.kinetic_energy, m.rotational_energy),
        );
        row(
            "lists",
            format!(
                "made {}, {} pairs within {:.2} mm",
                counted(m.lists_made, "time"),
                m.listed_contacts,
                1e3 * m.skin_m
            ),
        );
        if let (Some(peak), Some(each)) = (m.peak_memory_bytes, m.bytes_per_sphere) {
            row("memory", format!("{:.1} MB, {each:.0} bytes a sphere", peak as f64 / 1e6));
        }
        if let Some(b) = &m.bandwidth {
            let (used, can) = (b.used_bytes_per_second / 1e9, b.measured_bytes_per_second / 1e9);
            row("bandwidth", format!("{used:.2} GB/s of {can:.2} GB/s by a triad, {:.0} %", 100.0 * b.share));
        }
        out += "\n  where the time goes   share   ns a body and step\n";
        let time = &m.time;
        for (label, Share { share, ns_per_body_step }) in [
            ("search", time.search),
            ("forces", time.forces),
            ("walls", time.walls),
            ("motion", time.motion),
            ("other", time.other),
        ] {
            out += &format!("  {label:<18}{:>7.1} %{ns_per_body_step:>21.1}\n", 100.0 * share);
        }
        out
    }
}

fn counted(count: u64, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}
