//! What each mitigation does to the shipped transition zone after 10,000 axles, as the tables of `docs/mitigations.md`.
//!
//!     cargo run --release --example mitigations

use std::error::Error;
use trackbed::check::Folder;
use trackbed::results::{RailRow, RunRecorder, evaluate};
use trackbed::scenario::response::{Expression, Measure, Reduction, Response};
use trackbed::{compile, execute};

const AXLES: u64 = 10_000;
/// Stiffness gradients are those over this distance, m, no further than `NEAR` from the transition.
const STEP: f64 = 1.0;
const NEAR: f64 = 15.0;
/// Pressure is that before the slab, m, between seats: neither end has one.
const LAST: (f64, f64) = (-5.999, -0.001);

/// Name, and the stretches that make it.
const CASES: [(&str, &str); 8] = [
    ("none", ""),
    (
        "stiffer supports towards the slab, 50 .. 120 MN/m over 20 sleepers",
        "stretch a { over = -20 .. -1 sleepers, support.stiffness = ramp(50 .. 120 MN/m per seat) }",
    ),
    ("under sleeper pads, 0.2 N/mm^3 under 20 sleepers", "stretch a { over = -20 .. -1 sleepers, usp = usps.medium }"),
    (
        "under sleeper pads graded 0.15 .. 0.6 N/mm^3 over 20 sleepers",
        "stretch a { over = -20 .. -1 sleepers, usp = usps.medium { bedding_modulus = ramp(0.15 .. 0.6 N/mm^3) } }",
    ),
    (
        "sleepers 0.4 m wide, six of them, on supports stiffer by as much",
        "stretch a {
  over = -6 .. -1 sleepers
  sleeper.base_width = 400 mm
  sleeper.mass = 200 kg per seat
  support.stiffness = 66.7 MN/m per seat
}",
    ),
    ("closer sleepers, 0.6 .. 0.5 m over 16", "stretch a { over = -16 .. -1 sleepers, spacing = ramp(0.6 .. 0.5 m) }"),
    (
        "four auxiliary rails over 26 seats",
        "stretch a {
  over = -20 .. 6 sleepers
  auxiliary_rails = { rail = rails.UIC60, count = 4, pad = pads.ahmadi_2026 }
}",
    ),
    (
        "softer pads on the slab, 20 .. 40 MN/m over 20 seats",
        "stretch a { over = 1 .. 20 sleepers, pad.stiffness = smooth(20 .. 40 MN/m) }",
    ),
];

/// The same on soft ground whose layers carry the sleepers.
const ON_LAYERS: [(&str, &str); 7] = [
    ("none", ""),
    (
        "wedge of treated soil, 0.1 .. 0.8 m of 150 .. 900 MPa over 20 m",
        "soil treated : soils.cement_treated { youngs_modulus = ramp(150 .. 900 MPa) }
stretch a {
  over = -20 .. 0 m
  layers = [ballasts.clumps_32_80: 300 mm, subballasts.sand_gravel: 300 mm, treated: ramp(0.1 .. 0.8 m), soft: rest]
}",
    ),
    (
        "reinforced embankment, 120 instead of 60 MPa over 20 m",
        "stretch a {
  over = -20 .. 0 m
  layers = [ballasts.clumps_32_80: 300 mm, subballasts.sand_gravel: 300 mm, soils.sandy_gravel: rest]
}",
    ),
    (
        "bonded ballast under 20 sleepers, 250 instead of 110 MPa",
        "stretch a {
  over = -20 .. -1 sleepers
  layers = [ballasts.bonded_granite: 300 mm, subballasts.sand_gravel: 300 mm, soft: rest]
}",
    ),
    (
        "ballast mat of 25 mm under 20 sleepers",
        "stretch a {
  over = -20 .. -1 sleepers
  layers = [ballasts.clumps_32_80: 300 mm, soils.ballast_mat: 25 mm, subballasts.sand_gravel: 275 mm, soft: rest]
}",
    ),
    (
        "approach slab of 6 m, hinged, 300 mm of concrete under the subballast",
        "stretch a {
  over = -6 .. 0 m
  approach_slab = { thickness = 300 mm, youngs_modulus = 34 GPa, density = 2500 kg/m^3, depth = 600 mm }
}",
    ),
    (
        "the same without the hinge",
        "stretch a {
  over = -6 .. 0 m
  approach_slab = { thickness = 300 mm, youngs_modulus = 34 GPa, density = 2500 kg/m^3, depth = 600 mm, hinged = no }
}",
    ),
];

/// What a run shows.
struct Effect {
    /// MN/m per m, before the first axle.
    gradient: f64,
    /// kN, after the last axle.
    seat_load: f64,
    /// mm, after the last axle.
    differential: f64,
    /// kPa, the largest over the last metres before the slab after the last axle; where the layers are known.
    subgrade: Option<f64>,
}

fn on_layers(stretches: &str) -> String {
    let listed = if stretches.is_empty() { "" } else { "a" };
    format!(
        "use std
use transition as base
soil soft : soils.sand {{ youngs_modulus = 60 MPa }}
trackform open : base.open {{
  layers = [ballasts.clumps_32_80: 300 mm, subballasts.sand_gravel: 300 mm, soft: 2 m], support = none
}}
{stretches}
track line : base.line {{ sections = [open: 42 m, base.stiff: 24 m], stretches = [{listed}] }}
traffic : base.traffic {{ total = {AXLES} axles }}
solve : base.solve {{
  support_method = layered_elastic, update_every = adaptive(0.02 mm), elements_per_bay = 2, time_step = 2e-4 s
}}
"
    )
}

fn scene(stretches: &str) -> String {
    let listed = if stretches.is_empty() { "" } else { "a" };
    format!(
        "use std
use transition as base
{stretches}
track line : base.line {{ stretches = [{listed}] }}
traffic : base.traffic {{ total = {AXLES} axles }}
solve : base.solve {{ update_every = adaptive(0.02 mm), elements_per_bay = 2, time_step = 2e-4 s }}
"
    )
}

fn run(scene: &str) -> Result<Effect, Box<dyn Error>> {
    let compiled = compile("mitigation.track", scene, &Folder("scenarios".into()), &[]);
    let (Some(scenario), Some(plan)) = (compiled.scenario, compiled.graph) else {
        return Err(format!("{:?}", compiled.diagnostics).into());
    };
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder)?;
    let tables = &recorder.tables;
    let scalars = recorder.scalars();
    let scalar = |name: &str| scalars.get(name).map(|s| s.value).ok_or(format!("no {name}"));
    let before: Vec<&RailRow> = tables.rail.iter().filter(|r| r.axles == 0 && r.x_m.abs() < NEAR).collect();
    let pressure = Measure { over: Some(LAST), ..Measure::new(Reduction::Max, Response::SubgradePressure) };
    let view = tables.view(&recorder.histories, &scalars, &scenario.track, &plan.supports);
    let subgrade = evaluate(&Expression::Measure(pressure), view);
    Ok(Effect {
        gradient: steepest(&before) / 1e6,
        seat_load: scalar("max_rail_seat_load")? / 1e3,
        differential: scalar("differential_settlement")? * 1e3,
        subgrade: subgrade.ok().map(|pressure| pressure / 1e3),
    })
}

/// The largest change of stiffness at rail level over `STEP`, N/m per m.
fn steepest(rows: &[&RailRow]) -> f64 {
    let over = |row: &&RailRow| {
        let next = rows.iter().find(|r| r.x_m >= row.x_m + STEP - 1e-6)?;
        Some((next.stiffness_N_per_m - row.stiffness_N_per_m).abs() / (next.x_m - row.x_m))
    };
    rows.iter().filter_map(over).fold(0.0, f64::max)
}

fn table(cases: &[(&str, &str)], scene: fn(&str) -> String) -> Result<(), Box<dyn Error>> {
    let mut plain: Option<Effect> = None;
    for (name, stretches) in cases {
        let effect = run(&scene(stretches))?;
        let first = plain.as_ref().unwrap_or(&effect);
        let cell = |value: f64, before: f64| format!("{value:.2} ({:+.0} %)", 100.0 * (value / before - 1.0));
        let subgrade = effect.subgrade.zip(first.subgrade).map(|(now, before)| format!(" {} |", cell(now, before)));
        println!(
            "| {name} | {} | {} | {} |{}",
            cell(effect.gradient, first.gradient),
            cell(effect.seat_load, first.seat_load),
            cell(effect.differential, first.differential),
            subgrade.unwrap_or_default()
        );
        plain.get_or_insert(effect);
    }
    Ok(())
}

const HEAD: &str =
    "| mitigation | stiffness gradient, MN/m per m | largest seat load, kN | differential settlement, mm |";

fn main() -> Result<(), Box<dyn Error>> {
    println!("{HEAD}\n|---|---|---|---|");
    table(&CASES, scene)?;
    println!("\n{HEAD} pressure on the subgrade before the slab, kPa |\n|---|---|---|---|---|");
    table(&ON_LAYERS, on_layers)
}
