//! `trackbed calibrate`: the parameters with which the law of a scene comes nearest to a measured settlement curve, or
//! a law for the grains of the scene.

use super::scene::{SceneArguments, failed, file_name, not_yet, show};
use super::{Format, Outcome, calibrate_grains, terminal};
use crate::check::{self, MeasuredCurve, measured_curve};
use crate::compile::Compiled;
use crate::diag::{Code, Diagnostic, FileId, Span, nearest::nearest, or_list};
use crate::execute::passage_as_built;
use crate::lower::supports;
use crate::scenario::{Scenario, Seat, SettlementLaw, law_argument, law_form};
use crate::schema;
use crate::solvers::settlement::fit::{Fit, FitError};
use crate::solvers::settlement::{self, Law, Measured, Peak, Wanted};
use crate::units::{Dimension, number, parse_unit};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Fit the settlement law of a scene to a measured curve, or a law to the grains of the scene
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed calibrate scenarios/transition.track --measured curve.csv
  trackbed calibrate zone.track --measured curve.csv --seat-load '40 kN' --fit gamma,beta
  trackbed calibrate scenarios/transition_short.track --grains --out on_grains.track")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// CSV file with the columns `axles` and `settlement_mm` (or another unit).
    #[arg(long, value_name = "CSV", required_unless_present = "grains")]
    measured: Option<PathBuf>,
    #[command(flatten)]
    grains: calibrate_grains::GrainArguments,
    /// The peak force of every wheel on the support of a half sleeper, e.g. '40 kN'; by default that of one passage of
    /// the scene.
    #[arg(long, value_name = "FORCE", value_parser = force, conflicts_with = "grains")]
    seat_load: Option<f64>,
    /// The sleeper whose wheel peaks act, e.g. -20; by default the one farthest from every transition.
    #[arg(long, value_name = "SLEEPER", allow_hyphen_values = true, conflicts_with = "grains")]
    sleeper: Option<String>,
    /// The arguments of the law to fit, e.g. gamma,beta; by default those that one force lets tell apart.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with = "grains")]
    fit: Vec<String>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

/// What acts on the support while the curve is measured.
struct Acting {
    wheels: Vec<Peak>,
    /// For the reader.
    described: String,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    match &arguments.measured {
        Some(measured) => to_curve(arguments, measured),
        None => calibrate_grains::run(&arguments.scene, &arguments.grains, arguments.format),
    }
}

fn to_curve(arguments: &Arguments, file: &Path) -> Outcome {
    let Some(mut compiled) = arguments.scene.compile() else { return Outcome::Usage };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    let Some(scenario) = compiled.scenario.take() else { return not_yet(&compiled) };
    let (law, name) = (&scenario.solve.law, file.display().to_string());
    let found = wanted(law, &arguments.fit).and_then(|wanted| {
        let (curve, file) = read(file, &mut compiled, wanted.len() + 1)?;
        let acting = acting(arguments, &compiled, &scenario)?;
        let measured = Measured { wheels: acting.wheels, axles: curve.axles, settlement: curve.settlement };
        let fitted = settlement::calibrate(&law.law, &wanted, &measured);
        let (fitted, fit) = fitted.map_err(|error| vec![refused(&error, law, &wanted, &measured, file)])?;
        Ok(Calibration { law, wanted, measured, described: acting.described, fitted, fit, name: name.clone() })
    });
    match found {
        Ok(calibration) => {
            terminal::out(&match arguments.format {
                Format::Human => calibration.text(),
                Format::Json => format!("{:#}\n", calibration.json()),
            });
            Outcome::Fine
        }
        Err(diagnostics) => {
            terminal::diagnostics(&diagnostics, &compiled.sources);
            Outcome::Failed
        }
    }
}

/// `40 kN`, in N.
fn force(text: &str) -> Result<f64, String> {
    let text = text.trim().trim_end_matches("per seat").trim();
    let end = text.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).unwrap_or(text.len());
    let (value, unit) = text.split_at(end);
    let value: f64 = value.trim().parse().map_err(|_| format!("expected a force such as `40 kN`, found `{text}`"))?;
    match parse_unit(unit.trim()) {
        Ok(unit) if unit.dimension == Dimension::FORCE && value > 0.0 && value.is_finite() => Ok(value * unit.factor),
        Ok(unit) if unit.dimension == Dimension::FORCE => Err("the force must be above 0".into()),
        _ => Err(format!("expected a force such as `40 kN`, found `{text}`")),
    }
}

/// The parameters to fit with the bounds that the vocabulary gives them; one diagnostic for each name that is none.
fn wanted(law: &SettlementLaw, names: &[String]) -> Result<Vec<Wanted>, Vec<Diagnostic>> {
    let form = law.law.form.name();
    let arguments = schema::word(form).map_or(&[][..], |word| word.arguments);
    let numbers = || arguments.iter().filter(|a| a.form.measure().is_some()).map(|a| a.name);
    let usual = law.law.form.usual_parameters().iter().map(|name| (*name).to_string());
    let names: Vec<String> = if names.is_empty() { usual.collect() } else { names.to_vec() };
    let mut mistakes = Vec::new();
    let mut wanted: Vec<Wanted> = Vec::new();
    for name in names {
        let name = name.trim();
        let measure = arguments.iter().find(|a| a.name == name).and_then(|a| a.form.measure());
        match measure {
            Some(_) if wanted.iter().any(|w| w.name == name) => {
                mistakes.push(Diagnostic::new(Code::E0806, format!("`{name}` is to be fitted twice")));
            }
            Some(measure) => {
                let size = parse_unit(measure.unit).map_or(1.0, |u| u.factor);
                wanted.push(Wanted { name: name.into(), low: measure.min * size, high: measure.max * size });
            }
            None => {
                let quoted: Vec<String> = numbers().map(|n| format!("`{n}`")).collect();
                let help = nearest(name, numbers())
                    .map_or_else(|| format!("it has {}", or_list(&quoted)), |n| format!("did you mean `{n}`?"));
                let mistake = format!("`{form}`, the form of law `{}`, has no number `{name}`", law.name);
                mistakes.push(Diagnostic::new(Code::E0806, mistake).help(help));
            }
        }
    }
    if mistakes.is_empty() { Ok(wanted) } else { Err(mistakes) }
}

fn read(measured: &Path, compiled: &mut Compiled, least: usize) -> Result<(MeasuredCurve, FileId), Vec<Diagnostic>> {
    let name = measured.display().to_string();
    let refused = |message: String| vec![Diagnostic::new(Code::E0805, message)];
    let bytes = check::read_bounded(measured).map_err(|e| refused(format!("cannot read `{name}`: {e}")))?;
    let text = crate::syntax::decode(&name, &bytes).map_err(|mistake| refused(mistake.message))?;
    let file = compiled.sources.add(name, text.as_str(), false);
    let (curve, diagnostics) = measured_curve(file, &text, least);
    curve.map(|curve| (curve, file)).ok_or(diagnostics)
}

fn acting(arguments: &Arguments, compiled: &Compiled, scenario: &Scenario) -> Result<Acting, Vec<Diagnostic>> {
    let refused = |message: String, help: &str| vec![Diagnostic::new(Code::E0806, message).help(help)];
    let track = &scenario.track;
    let seat = seat(arguments, scenario)?;
    let name = track.seat_name(&track.seats[seat]);
    if let Some(force) = arguments.seat_load {
        let stiffness = supports(scenario)[seat].support.map_or(f64::INFINITY, |support| support.stiffness);
        let peak = Peak { force, deflection: force / stiffness, void: 0.0 };
        let described = format!("{} kN per seat under every wheel", number(force / 1e3));
        return Ok(Acting { wheels: vec![peak; 4], described });
    }
    let passage = match compiled.runnable() {
        Some(graph) => passage_as_built(graph).map_err(|e| refused(e.to_string(), "give `--seat-load`"))?,
        None => None,
    };
    let Some(passage) = passage else {
        let message = "no train of the scene says how much acts on the support";
        return Err(refused(message.into(), "give the force: `--seat-load '40 kN'`"));
    };
    let wheels = passage.peaks[seat].clone();
    let forces = || wheels.iter().map(|peak| peak.force / 1e3);
    let (least, most) = (forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max));
    let described = format!(
        "{} .. {} kN under the {} wheels of a train, from one passage at sleeper {name}",
        tenths(least),
        tenths(most),
        wheels.len()
    );
    Ok(Acting { wheels, described })
}

/// The ballasted seat that is asked for, or the one farthest from every transition that a whole train passes.
fn seat(arguments: &Arguments, scenario: &Scenario) -> Result<usize, Vec<Diagnostic>> {
    let track = &scenario.track;
    let ballasted = || (0..track.seats.len()).filter(|i| track.seats[*i].is_ballasted());
    if let Some(wanted) = &arguments.sleeper {
        let plain = |name: &str| name.trim_start_matches('+').to_string();
        let found = ballasted().find(|i| plain(&track.seat_name(&track.seats[*i])) == plain(wanted));
        return found.ok_or_else(|| {
            let names = || ballasted().map(|i| track.seat_name(&track.seats[i]));
            let help = format!(
                "the sleepers run from {} to {}",
                names().next().unwrap_or_default(),
                names().next_back().unwrap_or_default()
            );
            vec![Diagnostic::new(Code::E0806, format!("no ballasted sleeper is called `{wanted}`")).help(help)]
        });
    }
    let middle = (track.start() + track.end()) / 2.0;
    let distance = |seat: &Seat| track.transitions.iter().map(|t| (seat.x - t.x).abs()).fold(f64::INFINITY, f64::min);
    // seats near the ends take the mean of those that a whole train passes, so that any far one will do
    let better = |a: &usize, b: &usize| {
        let (a, b) = (&track.seats[*a], &track.seats[*b]);
        distance(a).total_cmp(&distance(b)).then((b.x - middle).abs().total_cmp(&(a.x - middle).abs()))
    };
    let none = || vec![Diagnostic::new(Code::E0806, "the scene has no ballasted sleeper, nothing can settle")];
    ballasted().max_by(better).ok_or_else(none)
}

fn refused(error: &FitError, law: &SettlementLaw, wanted: &[Wanted], measured: &Measured, file: FileId) -> Diagnostic {
    let names = |parameters: &[usize]| {
        let names: Vec<String> = parameters.iter().map(|i| format!("`{}`", wanted[*i].name)).collect();
        or_list(&names).replace(" or ", " and ")
    };
    let most = measured.wheels.iter().map(|peak| peak.force).fold(0.0, f64::max);
    let below = law.law.threshold().filter(|threshold| most <= *threshold);
    match error {
        FitError::TooFew { needed } => {
            Diagnostic::new(Code::E0805, format!("at least {needed} measurements are needed"))
                .label(Span::new(file, 0, 0), "too few")
        }
        FitError::NoEffect { .. } if below.is_some() => Diagnostic::new(
            Code::E0806,
            format!(
                "{} kN a seat stay below the threshold of law `{}`, {} kN: nothing settles whatever its arguments are",
                tenths(most / 1e3),
                law.name,
                tenths(below.unwrap_or_default() / 1e3)
            ),
        )
        .help("lower `initial_threshold`, with `--set`, or fit another law"),
        FitError::NoEffect { parameters } => {
            Diagnostic::new(Code::E0806, format!("the curve does not depend on {}", names(parameters)))
                .help("leave it out of `--fit`")
        }
        FitError::Alike { parameters } => {
            Diagnostic::new(Code::E0806, format!("the curve does not tell {} apart", names(parameters)))
                .help("fit one of them and give the others in the scene")
        }
        FitError::NotFinite => Diagnostic::new(
            Code::E0806,
            format!("law `{}` gives no finite settlement with the arguments of the scene", law.name),
        ),
    }
}

fn tenths(value: f64) -> String {
    number((value * 10.0).round() / 10.0)
}

/// A fitted law and what it was fitted to.
struct Calibration<'a> {
    law: &'a SettlementLaw,
    wanted: Vec<Wanted>,
    measured: Measured,
    described: String,
    fitted: Law,
    fit: Fit,
    /// Path of the measured curve.
    name: String,
}

impl Calibration<'_> {
    fn text(&self) -> String {
        let form = self.law.law.form.name();
        let mut out = format!(
            "law {} ({form}) on {}: {} measurements, {} .. {} axles\nforce: {}\n\n",
            self.law.name,
            self.name,
            self.measured.axles.len(),
            self.measured.axles.first().copied().unwrap_or(0),
            self.measured.axles.last().copied().unwrap_or(0),
            self.described
        );
        for (k, wanted) in self.wanted.iter().enumerate() {
            let shown = |value: f64| law_argument(form, &wanted.name, value);
            let error = match self.fit.standard_errors[k] {
                Some(error) => format!("standard error {}", shown(error)),
                None => "rests on its bound: the curve asks for more than the language allows".to_string(),
            };
            out.push_str(&format!("  {:<20}{:<24}{error}\n", wanted.name, shown(self.fit.values[k])));
        }
        let largest = self.measured.settlement.iter().copied().fold(0.0, f64::max);
        out.push_str(&format!(
            "  {:<20}{:<24}{} % of the largest settlement; least squares of absolute residuals\n\n",
            "rms error",
            format!("{} mm", number(self.fit.rms * 1e3)),
            tenths(100.0 * self.fit.rms / largest)
        ));
        out.push_str(&format!("  {:>14}{:>16}{:>16}\n", "axles", "measured mm", "fitted mm"));
        for ((axles, measured), fitted) in self.measured.axles.iter().zip(&self.measured.settlement).zip(self.curve()) {
            out.push_str(&format!("  {axles:>14}{:>16.4}{:>16.4}\n", measured * 1e3, fitted * 1e3));
        }
        out.push_str(&format!("\n{}", self.declaration()));
        out
    }

    fn curve(&self) -> Vec<f64> {
        settlement::curve(&self.fitted, &self.measured.wheels, &self.measured.axles)
    }

    /// A `law` that can be pasted into a scene.
    fn declaration(&self) -> String {
        let law = self.fitted;
        let forces = || self.measured.wheels.iter().map(|peak| peak.force / 1e3);
        let (least, most) = (forces().fold(f64::INFINITY, f64::min).floor(), forces().fold(0.0, f64::max).ceil());
        let loads = if least < most { format!("  loads     = {least} .. {most} kN per seat\n") } else { String::new() };
        let (first, last) = (self.measured.axles.first(), self.measured.axles.last());
        format!(
            "law {}_fitted {{\n  form      = {}\n  cycle_per = {}\n{loads}  cycles    = {} .. {} axles\n  \
             source    = \"{} fitted to {} by trackbed calibrate, rms error {} mm\"\n  evidence  = derived\n}}\n",
            self.law.name,
            law_form(law.form),
            law.cycle_per.name(),
            first.copied().unwrap_or(0),
            last.copied().unwrap_or(0),
            self.law.name,
            file_name(Path::new(&self.name)),
            number(self.fit.rms * 1e3)
        )
    }

    fn json(&self) -> serde_json::Value {
        let form = self.law.law.form.name();
        let parameters: Vec<_> = self
            .wanted
            .iter()
            .enumerate()
            .map(|(k, wanted)| {
                json!({
                    "name": wanted.name,
                    "text": law_argument(form, &wanted.name, self.fit.values[k]),
                    "value": self.fit.values[k],
                    "standard_error": self.fit.standard_errors[k],
                    "rests_on_bound": self.fit.standard_errors[k].is_none(),
                })
            })
            .collect();
        let rows = self.measured.axles.iter().zip(&self.measured.settlement).zip(self.curve());
        let curve: Vec<_> = rows
            .map(|((axles, measured), fitted)| json!({"axles": axles, "measured_m": measured, "fitted_m": fitted}))
            .collect();
        json!({
            "law": self.law.name,
            "form": form,
            "force": self.described,
            "wheel_peaks_N": self.measured.wheels.iter().map(|peak| peak.force).collect::<Vec<_>>(),
            "parameters": parameters,
            "rms_m": self.fit.rms,
            "curve": curve,
            "declaration": self.declaration(),
        })
    }
}
