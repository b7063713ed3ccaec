//! Expressions of responses: what each reduction and function is of, what is said against those that are none, and that
//! a run answers them.

use std::path::Path;
use trackbed::check::Modules;
use trackbed::diag::{Code, render};
use trackbed::results::{self, RunRecorder};
use trackbed::{Compiled, compile, execute};

/// Measured settlement: half a millimetre everywhere before the slab.
struct Measured;

impl Modules for Measured {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        let text = match relative.to_str()? {
            "measured.csv" => "x_m,settlement_mm\n-12,0.5\n-6,0.5\n-1.2,0.5\n",
            "loads.csv" => "x_m,force_kN,stiffness_MN/m\n-12,40,1\n-6,41,2\n",
            _ => return None,
        };
        Some(text.as_bytes().to_vec())
    }
}

const SCENE: &str = r#"use std
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 24 m, stiff: 15 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }
traffic { trains = ore, total = 8 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s }
record { at = -3 sleepers, after = [0, 8] axles, quantities = sleeper_velocity }
scenario { allow = [stiffness_jump: "a test", passing_frequency: "a test", wheel_on_track: "a test"] }
"#;

fn expecting(that: &str) -> Compiled {
    compile("scene.track", &format!("{SCENE}expect {{ that = [{that}] }}\n"), &Measured, &[])
}

fn told(compiled: &Compiled) -> String {
    render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

#[test]
fn a_run_answers_every_reduction_and_function() {
    let that = [
        // the rail bends most under a wheel, and less than the sleepers' supports would alone
        "0.8 mm < max(rail_displacement) < 3 mm",
        "min(rail_displacement) < 0 mm",
        "max(rail_displacement, over = 2 .. 6 m) < max(rail_displacement, over = -9 .. -3 m)",
        "max(rail_moment, over = -9 .. -3 m) <= max(rail_moment)",
        "mean(rail_level) > 0 mm",
        "percentile(contact_force, 50 %) <= percentile(contact_force, 95 %)",
        "percentile(contact_force, 100 %) <= max(contact_force)",
        "rms(settlement) >= mean(settlement)",
        "max(max(settlement) - 10 mm, 0 mm) <= 0 mm",
        "abs(0 mm - max(settlement)) >= max(settlement)",
        "sqrt(max(settlement) * max(settlement)) <= 1.000001 * max(settlement)",
        "rms(sleeper_velocity) < max(sleeper_velocity)",
        "misfit(settlement, file(\"measured.csv\")) < 1 mm",
        "abs(misfit(settlement, file(\"measured.csv\")) - (0.5 mm - mean(settlement, over = -12 .. -1.2 m))) < 0.1 mm",
    ];
    let compiled = expecting(&that.join(", "));
    assert!(compiled.diagnostics.is_empty(), "{}", told(&compiled));
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    let (tables, histories) = (&recorder.tables, recorder.all_histories());
    let scalars = recorder.scalars();
    let view = tables.view(&histories, &scalars, &scenario.track, &plan.supports);
    for verdict in results::verdicts(&scenario, view) {
        assert!(verdict.met, "{}: {:?} {:?}", verdict.text, verdict.values, verdict.problem);
    }
    // the peak of the whole rail stands in the summary
    let deepest = tables.rail.iter().filter(|row| row.axles == 8).map(|row| row.max_displacement_m).fold(0.0, f64::max);
    assert!((deepest / scalars["max_rail_displacement"].value - 1.0).abs() < 0.02);
}

#[test]
fn expressions_that_say_nothing_are_refused() {
    let refused = [
        ("percentile(contact_force) < 40 kN per seat", Code::E0403, "the share of values"),
        ("percentile(contact_force, 5 kN) < 40 kN per seat", Code::E0302, "a share"),
        ("percentile(contact_force, 120 %) < 40 kN per seat", Code::E0405, "0 .. 100 %"),
        ("percentile(contact_force, 95 %) < 4 mm", Code::E0305, "same dimension"),
        ("rms(settlement) < 4 kN per seat", Code::E0305, "same dimension"),
        ("misfit(settlement) < 1 mm", Code::E0403, "a file of measured values"),
        ("misfit(settlement, 3 mm) < 1 mm", Code::E0403, "a file of measured values"),
        ("misfit(settlement, file(\"none.csv\")) < 1 mm", Code::E0508, "none.csv"),
        ("misfit(settlement, file(\"loads.csv\", column = force)) < 1 mm", Code::E0302, "force"),
        ("misfit(settlement, file(\"loads.csv\")) < 1 mm", Code::E0509, "loads.csv"),
        ("misfit(voided_sleepers, file(\"measured.csv\")) < 1", Code::E0406, "not a value along the track"),
        ("abs(max(settlement), 3 mm) < 1 mm", Code::E0406, "takes one value"),
        ("max(max(settlement), 3 kN) < 1 mm", Code::E0305, "same dimension"),
        ("max(setlement) < 1 mm", Code::E0408, "did you mean `settlement`"),
        ("max(settlement, void) < 1 mm", Code::E0402, "no such argument"),
        ("median(settlement) < 1 mm", Code::E0408, "median"),
    ];
    for (that, code, says) in refused {
        let compiled = expecting(that);
        let found: Vec<Code> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
        assert_eq!(found, [code], "{that}: {}", told(&compiled));
        assert!(told(&compiled).contains(says), "{that}: {}", told(&compiled));
    }
}
