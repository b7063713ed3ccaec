//! What the physics rules say in numbers, against the closed forms they state.

use std::f64::consts::PI;
use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::diag::Code;

/// 42 m of one trackform under one train; each part may be replaced.
#[derive(Clone, Copy)]
struct Scene<'a> {
    rail: &'a str,
    sleeper: &'a str,
    support: &'a str,
    spacing: &'a str,
    level: &'a str,
    /// Initial settlement of the supports.
    settlement: &'a str,
    vehicle: &'a str,
    speed: f64,
    /// More declarations.
    rest: &'a str,
}

const SCENE: Scene<'_> = Scene {
    rail: "rails.UIC60",
    sleeper: "sleepers.B70",
    support: "40 MN/m per seat",
    spacing: "0.6 m",
    level: "0 mm",
    settlement: "0 mm",
    vehicle: "vehicles.ore_wagon_20t",
    speed: 60.0,
    rest: "",
};

impl Scene<'_> {
    /// The messages of one rule.
    fn says(self, code: Code) -> Vec<String> {
        let Scene { rail, sleeper, support, spacing, level, settlement, vehicle, speed, rest } = self;
        let text = format!(
            "use std
trackform open {{
  rail = {rail}, pad = {{ stiffness = 40 MN/m }}, sleeper = {sleeper}, spacing = {spacing}
  support = {{ stiffness = {support} }}, settlement = {settlement}
}}
track line {{ sections = [open: 42 m], irregularity = {level} }}
vehicle wagon : {vehicle}
train ore {{ vehicles = wagon, speed = {speed} km/h }}
traffic {{ trains = ore, total = 400 axles }}
{rest}
"
        );
        let compiled = compile("scene.track", &text, &NoModules, &[]);
        let told = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
        assert!(compiled.diagnostics.iter().all(|d| !d.is_error()), "{told}");
        compiled.diagnostics.iter().filter(|d| d.code == code).map(|d| d.message.clone()).collect()
    }
}

/// `lambda` of the rail on pads of 40 MN/m and a support, N/m, 0.6 m apart.
fn lambda(support: f64) -> f64 {
    let modulus = 1.0 / (1.0 / 40e6 + 1.0 / support) / 0.6;
    (modulus / (4.0 * 210e9 * 3038.3e-8)).powf(0.25)
}

/// Of a wheel on that track, Hz.
fn resonance(support: f64) -> f64 {
    let modulus = 1.0 / (1.0 / 40e6 + 1.0 / support) / 0.6;
    let mass = 1341.0 / 2.0 + 1.5 * (60.21 + 145.0 / 0.6) / lambda(support);
    (2.0 * modulus / lambda(support) / mass).sqrt() / (2.0 * PI)
}

#[test]
fn a_wheel_on_the_track_has_its_frequency() {
    let frequency = resonance(20e6);
    let at = |share: f64| {
        let speed = frequency * share * 0.6 * 3.6;
        let rest = "scenario { allow = [passing_frequency: \"bogies are another rule\"] }";
        Scene { support: "20 MN/m per seat", speed, rest, ..SCENE }.says(Code::L1012)
    };
    let said = format!(
        "at {:.1} km/h sleepers pass at {1:.0} Hz, near a wheel of `wagon` on the track of `open` at {1:.0} Hz",
        frequency * 0.6 * 3.6,
        frequency.round()
    );
    assert_eq!(at(1.0), [said]);
    assert!(!at(0.91).is_empty() && !at(1.09).is_empty() && at(0.89).is_empty() && at(1.11).is_empty());
}

#[test]
fn speeds_that_one_resonance_or_another_forbids_are_told_as_one_range() {
    let at = |speed: f64| {
        let scene = Scene { support: "20 MN/m per seat", speed, ..SCENE };
        [scene.says(Code::L1007), scene.says(Code::L1012)].concat()
    };
    // bogies of 30 MN/m a wheelset (half of it one wheel's) under 400 kg, pitching at 0.89 m with 365 kg m^2
    let bounce = (30e6f64 / 400.0).sqrt() / (2.0 * PI);
    let pitch = (30e6f64 * 0.89 * 0.89 / 365.0).sqrt() / (2.0 * PI);
    let speed = |frequency: f64| frequency * 0.6 * 3.6;
    let lowest = speed(resonance(20e6).min(pitch).min(bounce)) * 0.9;
    let highest = speed(resonance(20e6).max(pitch).max(bounce)) * 1.1;
    for inside in [lowest + 1.0, 0.5 * (lowest + highest), highest - 1.0] {
        assert_eq!(at(inside).len(), 1, "{inside}: {:?}", at(inside));
    }
    assert!(at(lowest - 2.0).is_empty() && at(highest + 2.0).is_empty());
    let all = at(speed(bounce));
    assert!(all[0].contains("the bogie bounce of `wagon`") && all[0].contains("the bogie pitch of `wagon`"), "{all:?}");
}

#[test]
fn wagons_run_no_faster_than_wagons() {
    let at = |vehicle: &str, speed: f64| Scene { vehicle, speed, ..SCENE }.says(Code::L1027);
    assert!(at("vehicles.ore_wagon_20t", 200.0).is_empty());
    let fast = at("vehicles.ore_wagon_20t", 216.0);
    assert_eq!(
        fast,
        ["`wagon` runs at 216 km/h: its car body bounces at 1.6 Hz, as on the springs of a freight wagon"]
    );
    assert!(at("vehicles.ore_wagon_30t", 120.0).is_empty());
    let heavy = at("vehicles.ore_wagon_30t", 121.0);
    assert_eq!(heavy, ["`wagon` runs at 121 km/h: vehicles with 29.5 t per axle run at 120 km/h at most"]);
    assert!(at("vehicles.ice3_middle", 300.0).is_empty() && at("vehicles.manchester_coach", 200.0).is_empty());
}

#[test]
fn a_void_is_wide_where_no_wheel_bends_the_rail_down_to_the_support() {
    let at = |settlement: &str| Scene { settlement, ..SCENE }.says(Code::L1030);
    // five sleepers, as a step
    let under = |mm: f64| at(&format!("[0 .. 18.3 m: 0 mm, 18.3 .. 21.3 m: {mm} mm, 21.3 .. 42 m: 0 mm]"));
    let found = under(90.0);
    assert!(
        found.len() == 1 && found[0].starts_with("5 sleepers hang above supports that no wheel reaches"),
        "{found:?}"
    );
    assert!(under(8.0).is_empty());
    // the rail follows what is long enough
    assert!(at("smooth(0 .. 90 mm, over = 5 .. 37 m)").is_empty());
    // one sleeper: at its middle Q l^3 / 48 EI and, of the seats beside it, Q / k; with what 60 km/h add
    let wheel = 1.6 * 10e3 * 9.81;
    let closed = 1e3 * (wheel * 1.2f64.powi(3) / (48.0 * 210e9 * 3038.3e-8) + wheel * (1.0 / 40e6 + 1.0 / 40e6));
    let one = at("[0 .. 20.7 m: 0 mm, 20.7 .. 21.3 m: 11 mm, 21.3 .. 42 m: 0 mm]");
    let said = format!(" is 11 mm, but a wheel bends the rail down by {closed:.1} mm at most");
    assert!(
        one.len() == 1 && one[0].starts_with("1 sleeper hangs") && one[0].ends_with(&said),
        "{one:?}, expected {said}"
    );
}

#[test]
fn a_level_is_held_against_the_limit_of_its_speed() {
    let hump = |mm: f64, speed: f64| {
        let level = format!("[0 m: 0 mm, 19 m: 0 mm, 21 m: {mm} mm, 23 m: 0 mm, 42 m: 0 mm]");
        Scene { level: &level, speed, ..SCENE }.says(Code::L1031)
    };
    // the mean over 25 m of a triangle of 4 m is 0.08 of its height
    let found = hump(-20.0, 60.0);
    let said = "at x = 21 m the rail lies 18.4 mm above its mean level over 25 m: the alert limit at 60 km/h is 12 mm";
    assert_eq!(found, [said]);
    for (speed, limit) in [(80.0, 12.0), (120.0, 10.0), (160.0, 8.0), (200.0, 7.0)] {
        let height = limit / (1.0 - 8.0 / 101.0);
        assert!(hump(0.99 * height, speed).is_empty(), "{speed}");
        assert_eq!(hump(1.01 * height, speed).len(), 1, "{speed}");
    }
    // a slope is its own mean
    assert!(Scene { level: "[0 m: -40 mm, 42 m: 40 mm]", ..SCENE }.says(Code::L1031).is_empty());
}

#[test]
fn samples_see_what_a_wheel_does_on_the_track() {
    let frequency = resonance(40e6);
    let at = |every: f64| {
        let rest = format!("record {{ at = 30 sleepers, every = {every} s, quantities = rail_moment }}");
        Scene { rest: &rest, ..SCENE }.says(Code::L1025)
    };
    assert!(at(0.99 / (10.0 * frequency)).is_empty());
    assert_eq!(at(1.01 / (10.0 * frequency)).len(), 1);
    let missed = 100.0 * (1.0 - (PI * frequency * 0.01).cos());
    let said = format!("a wheel on the track ({frequency:.0} Hz): peaks are too small by up to {missed:.0} %");
    let found = at(0.01);
    assert!(found.len() == 1 && found[0].ends_with(&said), "{found:?}, expected {said}");
    // steps of 0.1 ms have one sample each
    assert_eq!(
        at(4e-5),
        ["samples every 0.04 ms are asked for, but the time step is 0.1 ms: the run gives one sample per step"]
    );
}

#[test]
fn waves_of_the_level_have_steps_and_elements() {
    // a smooth step of that length is a wave of 2 pi / sqrt(10) times as much
    let wave = |length: f64| 2.0 * PI * length / f64::sqrt(10.0);
    let at = |length: f64, solve: &str| {
        let level = format!("smooth(0 .. 0.002 mm, over = 20 .. {} m)", 20.0 + length);
        Scene { level: &level, rest: solve, ..SCENE }.says(Code::L1026)
    };
    let (speed, coarse, one) = (60.0 / 3.6, "solve { time_step = 2e-4 s }", "solve { elements_per_bay = 1 }");
    let length = 10.0 * speed * 2e-4 / wave(1.0);
    assert!(at(1.02 * length, coarse).is_empty());
    let found = at(0.92 * length, coarse);
    assert!(found.len() == 1 && found[0].contains("moves 3.3 mm per step, 9.2 steps per wave"), "{found:?}");
    // rail waves of four elements, 2.4 m
    let frequency = 2.0 * PI / 2.4f64.powi(2) * f64::sqrt(210e9 * 3038.3e-8 / 60.21);
    let length = speed / frequency / wave(1.0);
    assert!(at(1.02 * length, one).is_empty() && at(0.9 * length, "").is_empty());
    let found = at(0.98 * length, one);
    let said = format!("excite the rail at {:.0} Hz", frequency / 0.98);
    assert!(found.len() == 1 && found[0].contains(&said), "{found:?}, expected {said}");
}

#[test]
fn crests_unload_a_wheel_by_their_curvature() {
    // 4 mm over half a metre: z'' = 6 a / l^2 at the start of the fall
    let share = |speed: f64| 670.5 * (speed / 3.6).powi(2) * 6.0 * 4e-3 / 0.25 / (10e3 * 9.81);
    let at = |speed: f64| Scene { level: "smooth(0 .. 4 mm, over = 20 .. 20.5 m)", speed, ..SCENE }.says(Code::L1013);
    let bearable = 120.0 * (0.6 / share(120.0)).sqrt();
    assert!(at(bearable - 1.0).is_empty());
    let said = format!("loses about {:.0} % of its load at 120 km/h", share(120.0) * 100.0);
    let found = at(120.0);
    assert!(found.len() == 1 && found[0].ends_with(&said), "{found:?}, expected {said}");
    assert!(found[0].starts_with("over a crest of radius 10.4 m at x = 20 m a wheel of `wagon`"), "{found:?}");
    // a rise has its crest where it ends
    let rise = Scene { level: "smooth(4 .. 0 mm, over = 20 .. 20.5 m)", speed: 120.0, ..SCENE }.says(Code::L1013);
    assert!(rise[0].contains("at x = 20.5 m"), "{rise:?}");
}

#[test]
fn the_stress_of_the_rail_is_that_of_a_beam_on_springs() {
    let modulus = 3038.3e-8 / 0.086;
    let stress = |speed: f64| {
        let moment = 10e3 * 9.81 / (4.0 * lambda(10e6));
        (1.0 + 0.6 * (1.0 + (speed - 60.0) / 380.0)) * moment / modulus
    };
    let at = |speed| Scene { support: "10 MN/m per seat", speed, ..SCENE }.says(Code::L1014);
    let limit = 60.0 + 380.0 * ((172e6 / stress(60.0) * 1.6 - 1.0) / 0.6 - 1.0);
    assert!(at(limit - 2.0).is_empty());
    let found = at(limit + 50.0);
    assert!(
        found.len() == 1 && found[0].contains(&format!("about {:.0} MPa: ", stress(limit + 50.0) / 1e6)),
        "{found:?}"
    );
    let harder = Scene { rail: "rails.S49", support: "10 MN/m per seat", speed: limit - 2.0, ..SCENE };
    assert_eq!(harder.says(Code::L1014).len(), 1);
}

#[test]
fn the_pressure_on_the_ballast_is_the_seats_share_over_its_area() {
    let small = Scene { sleeper: "sleepers.B70 { base_area = 0.3 m^2 }", vehicle: "vehicles.ore_wagon_30t", ..SCENE };
    assert!(Scene { vehicle: SCENE.vehicle, ..small }.says(Code::L1015).is_empty());
    let found = Scene { speed: 160.0, ..small }.says(Code::L1015);
    let wheel = (111e3 + 2.0 * 800.0 + 4.0 * 1341.0) / 8.0 * 9.81;
    let factor = 1.0 + 0.6 * (1.0 + 100.0 / 380.0);
    let force = factor * wheel * lambda(40e6) * 0.3 + (60.21 * 0.6 + 145.0) * 9.81;
    let said = format!("press on the ballast with about {:.0} kPa: {:.0} kN on 0.15 m^2", force / 150.0, force / 1e3);
    assert!(found.len() == 1 && found[0].contains(&said), "{found:?}, expected {said}");
    // another sleeper's area doubles, its pressure halves
    assert!(
        Scene { speed: 160.0, sleeper: "sleepers.B70 { base_area = 0.6 m^2 }", ..small }.says(Code::L1015).is_empty()
    );
}

#[test]
fn supports_are_counted_beyond_what_was_measured() {
    let says = |support| Scene { support, ..SCENE }.says(Code::L1016);
    assert!(says("10 MN/m per seat").is_empty() && says("200 MN/m per seat").is_empty());
    // per sleeper is half per seat
    assert!(says("390 MN/m per sleeper").is_empty());
    assert_eq!(
        says("9 MN/m per seat"),
        ["70 of 70 supports of `open` are softer than any measured support: 9 MN/m per seat"]
    );
    let ramp = says("ramp(100 .. 310 MN/m, over = 1 .. 70 sleepers) per seat");
    assert_eq!(ramp, ["37 of 70 supports of `open` are stiffer than any measured support: 310 MN/m per seat"]);
}

#[test]
fn a_car_body_bounces_on_its_springs_in_series() {
    let with = |stiffness: &str| {
        let vehicle = format!("vehicles.ore_wagon_20t {{ secondary.stiffness = {stiffness} MN/m per bogie }}");
        Scene { vehicle: &vehicle, ..SCENE }.says(Code::L1017)
    };
    assert!(with("3.75").is_empty() && with("1").is_empty());
    let body = (80e3 - 2.0 * 800.0 - 4.0 * 1341.0) / 2.0;
    let spring: f64 = 1.0 / (1.0 / 0.1e6 + 1.0 / 30e6);
    let frequency = (2.0 * spring / body).sqrt() / (2.0 * std::f64::consts::PI);
    let said = format!("the car body of `wagon` bounces at {frequency:.2} Hz: {:.1} t over one rail", body / 1e3);
    assert!(with("0.2")[0].starts_with(&said), "{:?}, expected {said}", with("0.2"));
}

/// The figures of the rule are those of the table of stiffness that the run makes, far from the transition.
#[test]
fn a_jump_of_stiffness_is_that_of_the_runs_own_table() {
    for pad in ["60 MN/m", "300 MN/m"] {
        let text = format!(
            "use std
trackform open {{
  rail = rails.UIC60, pad.stiffness = 60 MN/m, sleeper = sleepers.B70, spacing = 0.6 m, support.stiffness = 50 MN/m per seat
}}
trackform deck : open {{ sleeper = none, support = none, slab = slabs.half_width_1600, pad.stiffness = {pad} }}
track line {{ sections = [open: 42 m, deck: 36 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }}
traffic {{ trains = ore, total = 4 axles }}
solve {{ elements_per_bay = 1, time_step = 2 ms }}
"
        );
        let scene = trackbed::Scene::from_text(&text);
        let run = scene.run().unwrap_or_else(|stopped| panic!("{stopped:?}"));
        let over = |x: f64| {
            let bay = run.rail.iter().filter(|row| row.axles == 0 && (row.x_m - x).abs() < 0.31);
            // over a seat it is largest
            (bay.map(|row| row.stiffness_N_per_m).fold(0.0, f64::max) / 1e5).round() / 10.0
        };
        let said = format!("jumps from {} to {} MN/m", over(-20.7), over(18.3));
        let found = scene.check().diagnostics;
        let found = found.iter().find(|d| d.code == Code::L1001).map(|d| d.message.clone()).unwrap_or_default();
        assert!(found.contains(&said), "pads of {pad}: {found}, expected {said}");
    }
}
