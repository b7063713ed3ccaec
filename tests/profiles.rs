//! Values that vary along the track, from the text to the seats: what a ramp, a list and a file mean, and what becomes
//! of under sleeper pads, initial settlement and the rest of the track's physics.

use std::collections::BTreeMap;
use std::path::Path;
use trackbed::check::{DataError, Folder, LARGEST_DATA_FILE, Modules};
use trackbed::diag::Code;
use trackbed::scenario::{Beam, Integrator, Loading, RailEnds, Scenario, Seat, Support, TimeStep, Train};
use trackbed::{Compiled, compile, execute, results};

/// Files in memory.
#[derive(Default)]
struct Files(BTreeMap<&'static str, String>);

impl Modules for Files {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.0.get(relative.to_str()?).map(|text| text.clone().into_bytes())
    }
}

/// 12 m of sleepers before 6 m of slab: sleepers -19 .. -1, seats +1 .. +10.
fn scene(open: &str, track: &str, rest: &str) -> String {
    format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = {{ stiffness = 50 MN/m per seat, damping_time = 1 ms }}
  {open}
}}
trackform deck : open {{
  sleeper = none, support = none, usp = none, settlement = 0 mm, slab = slabs.half_width_1600, pad = pads.ahmadi_2026
}}
track line {{ sections = [open: 12 m, deck: 12 m], {track} }}
{rest}
"
    )
}

fn with(text: &str, files: Files) -> Compiled {
    compile("scene.track", text, &files, &[])
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn codes(compiled: &Compiled) -> Vec<Code> {
    compiled.diagnostics.iter().map(|d| d.code).filter(|c| c.rule().is_none() && *c != Code::E0601).collect()
}

/// A scene in which nothing is wrong, whether or not the solver takes it.
fn sound(text: &str) -> Scenario {
    sound_with(text, Files::default())
}

fn sound_with(text: &str, files: Files) -> Scenario {
    let compiled = with(text, files);
    assert!(codes(&compiled).iter().all(|c| *c == Code::E0411), "{}", told(&compiled));
    compiled.scenario.unwrap_or_else(|| panic!("{}", compiled.diagnostics.len()))
}

fn seat(scenario: &Scenario, number: i32) -> &Seat {
    scenario.track.seats.iter().find(|s| s.number == number).unwrap()
}

fn support(scenario: &Scenario, number: i32) -> &Support {
    seat(scenario, number).support().unwrap()
}

fn train(scenario: &Scenario) -> &Train {
    match &scenario.loading {
        Some(Loading::Traffic(traffic)) => &traffic.train,
        other => panic!("{other:?}"),
    }
}

const TRAFFIC: &str =
    "train ore { vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }\ntraffic { trains = ore, total = 4 axles }";

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1e-12), "{a} {b}");
}

#[test]
fn each_seat_takes_the_value_of_its_place() {
    let settled = |value: &str, numbers: &[i32]| -> Vec<f64> {
        let scenario = sound(&scene(&format!("settlement = {value}"), "", ""));
        numbers.iter().map(|n| *seat(&scenario, *n).initial_settlement * 1e3).collect()
    };
    for (value, expected) in [
        ("2 mm", [2.0, 2.0, 2.0, 2.0]),
        // over the section in chainage: sleeper -19 lies 0.6 m, sleeper -1 11.4 m from its left end
        ("ramp(0 .. 12 mm)", [0.6, 6.6, 10.8, 11.4]),
        ("smooth(0 .. 12 mm, over = -12 .. 0 m)", [0.087, 6.897, 11.664, 11.913]),
        // before and after its span the ends hold; end sleepers get the end values
        ("ramp(3 .. 5 mm, over = -9 .. -1 sleepers)", [3.0, 3.0, 4.75, 5.0]),
        ("ramp(5 .. 3 mm, over = -9 .. -1 sleepers)", [5.0, 5.0, 3.25, 3.0]),
        ("[-12 m: 0, -6 m: 6, 0 m: 0] mm", [0.6, 5.4, 1.2, 0.6]),
        ("[-19 sleepers: 0 mm, -2 sleepers: 17 mm, -1 sleepers: 20 mm]", [0.0, 10.0, 17.0, 20.0]),
        ("[-19 .. -3 sleepers: 0 mm, -2 sleepers: 2 mm, -1 sleepers: 4 mm]", [0.0, 0.0, 2.0, 4.0]),
        ("[-12 .. -6 m: 1 mm, -6 .. 0 m: ramp(1 .. 7 mm)]", [1.0, 1.6, 5.8, 6.4]),
        // only seats are asked for: nothing stands in the last half metre
        ("[-12 .. -0.5 m: 1 mm]", [1.0, 1.0, 1.0, 1.0]),
    ] {
        let found = settled(value, &[-19, -9, -2, -1]);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 6e-4, "{value}: {found} {expected}");
        }
    }
}

#[test]
fn pads_and_supports_vary_with_their_damping() {
    let scenario = sound(
        &scene(
            "pad = { stiffness = ramp(40 .. 100 MN/m, over = -9 .. -1 sleepers), damping_time = 0.2 ms }
  support = { stiffness = [-12 .. -6 m: 30, -6 .. 0 m: ramp(30 .. 90 MN/m)] MN/m per sleeper, damping_time = 1 ms }",
            "",
            "",
        )
        .replacen("pad = pads.ahmadi_2026,", "", 1)
        .replacen("  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }\n", "", 1),
    );
    close(*seat(&scenario, -19).pad.as_ref().unwrap().stiffness, 40e6);
    close(*seat(&scenario, -1).pad.as_ref().unwrap().stiffness, 100e6);
    close(*seat(&scenario, -1).pad.as_ref().unwrap().damping, 20e3);
    close(*support(&scenario, -19).stiffness, 15e6);
    // per sleeper: half of 30 + 60 (5.4 / 6)
    close(*support(&scenario, -1).stiffness, 42e6);
    close(*support(&scenario, -1).damping, 42e3);
}

#[test]
fn profiles_have_names_and_can_be_taken_over() {
    let text = scene("settlement = sunk", "", "let sunk = ramp(0 mm .. deep)\nlet deep = 12 mm");
    close(*seat(&sound(&text), -9).initial_settlement, 6.6e-3);
    let text = scene(
        "pad.damping_time = 0.1 ms",
        "",
        "pad graded { stiffness = ramp(40 .. 100 MN/m) }\nlet k = graded.stiffness",
    )
    .replace("pad = pads.ahmadi_2026, sleeper", "pad = { stiffness = graded.stiffness }, sleeper")
    .replace("  pad.damping_time = 0.1 ms\n", "")
    .replace("\nlet k = graded.stiffness", "");
    close(*seat(&sound(&text), -9).pad.as_ref().unwrap().stiffness, (40.0 + 60.0 * 6.6 / 12.0) * 1e6);
    let basis = scene("", "", "support s { stiffness = ramp(40 .. 50 MN/m) per seat }\nlet x = 1")
        .replace("stiffness = 50 MN/m per seat,", "stiffness = s.stiffness,")
        .replace("\nlet x = 1", "");
    close(*support(&sound(&basis), -9).stiffness, (40.0 + 10.0 * 6.6 / 12.0) * 1e6);
}

#[test]
fn places_are_counted_from_the_transition_and_are_chainages_where_there_are_several() {
    let mirrored = "use std
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat }, settlement = VALUE
}
trackform deck : open { sleeper = none, support = none, settlement = 0 mm, slab = slabs.half_width_1600 }
";
    let one = format!(
        "{mirrored}track line {{ sections = [deck: 12 m, open: 12 m], transitions = [edge: stiff_to_soft] }}\n"
    );
    let scenario = sound(&one.replace("VALUE", "ramp(0 .. 4 mm, over = -5 .. -1 sleepers)"));
    close(*seat(&scenario, -1).initial_settlement, 4e-3);
    close(*seat(&scenario, -2).initial_settlement, 3e-3);
    close(*seat(&scenario, -8).initial_settlement, 0.0);
    let scenario = sound(&one.replace("VALUE", "[-12 m: 0 mm, -6 m: 0 mm, 0 m: 6 mm]"));
    close(*seat(&scenario, -1).initial_settlement, 5.4e-3);
    let two = format!(
        "{mirrored}track line {{ sections = [deck: 12 m, open: 20 sleepers, deck: 12 m], transitions = [west: stiff_to_soft, east: soft_to_stiff] }}\n"
    );
    let scenario = sound(&two.replace("VALUE", "[0 .. 6 m: 1 mm, 6 .. 12.6 m: 2 mm]"));
    let settled: Vec<f64> =
        scenario.track.seats.iter().filter(|s| s.is_ballasted()).map(|s| *s.initial_settlement).collect();
    assert_eq!(settled.len(), 20);
    // x = 6 m is sleeper 10 of the section: where two spans meet, the right one holds
    assert_eq!(settled.iter().filter(|s| **s == 1e-3).count(), 9);
    let counted = with(&two.replace("VALUE", "ramp(0 .. 4 mm, over = -5 .. -1 sleepers)"), Files::default());
    assert_eq!(codes(&counted), [Code::E0504], "{}", told(&counted));
}

#[test]
fn a_gap_is_named_in_metres_and_by_sleeper() {
    let message = |value: &str| {
        let compiled = with(&scene(&format!("settlement = {value}"), "", ""), Files::default());
        assert_eq!(codes(&compiled), [Code::E0506], "{}", told(&compiled));
        compiled.diagnostics[0].message.clone()
    };
    let what = "the settlement of trackform `open` is not given";
    assert_eq!(
        message("[-12 .. -6 m: 0 mm, -3 .. 0 m: 0 mm]"),
        format!("{what} from -6 m to -3 m (sleepers -9 .. -6)")
    );
    assert_eq!(
        message("[-19 .. -6 sleepers: 0 mm, -4 .. -1 sleepers: 0 mm]"),
        format!("{what} from -3.3 m to -2.7 m (sleeper -5)")
    );
    assert_eq!(message("[-12 m: 0 mm, -1.5 m: 3 mm]"), format!("{what} from -1.5 m to 0 m (sleepers -2 .. -1)"));
    assert_eq!(message("[-9 .. 0 m: 0 mm]"), format!("{what} from -12 m to -9 m (sleepers -19 .. -16)"));
    let level = with(&scene("", "irregularity = [-12 .. 11 m: 0 mm]", ""), Files::default());
    assert_eq!(level.diagnostics[0].message, "the irregularity of track `line` is not given from 11 m to 12 m");
}

/// A survey every half metre, with its column of levels.
fn survey(level: impl Fn(f64) -> f64) -> String {
    let rows: String = (-24..=24).map(|i| f64::from(i) * 0.5).map(|x| format!("{x}, {}\n", level(x))).collect();
    format!("# a survey\nx_m,level_mm\n\n{rows}")
}

#[test]
fn a_file_of_levels_is_a_smooth_curve() {
    let files = Files(BTreeMap::from([("data/level.csv", survey(|x| 2.0 * (x / 2.0).sin()))]));
    let scenario = sound_with(&scene("", "irregularity = file(\"data/level.csv\")", TRAFFIC), files);
    let profile = scenario.track.irregularity.unwrap();
    for i in -100..=100 {
        let x = f64::from(i) * 0.1003;
        assert!((profile.value(x) - 2e-3 * (x / 2.0).sin()).abs() < 1e-6, "{x}");
    }
    // other fields are straight between the rows
    let files = Files(BTreeMap::from([("s.csv", "x_km,sunk_m,bed_mm\n-0.012,0,0\n0,0.006,12\n".to_string())]));
    let scenario = sound_with(&scene("settlement = file(\"s.csv\", column = bed)", "", ""), files);
    close(*seat(&scenario, -9).initial_settlement, 6.6e-3);
    let files = Files(BTreeMap::from([("k.csv", "x_m,k_MN/m\n-12,40\n0,64\n".to_string())]));
    let text = scene("", "", "").replace("stiffness = 50 MN/m per seat,", "stiffness = file(\"k.csv\") per sleeper,");
    close(*support(&sound_with(&text, files), -9).stiffness, 0.5 * (40.0 + 24.0 * 6.6 / 12.0) * 1e6);
}

#[test]
fn every_mistake_of_a_file_has_its_line_and_column() {
    let mistakes = |text: &str| {
        let files = Files(BTreeMap::from([("level.csv", text.to_string())]));
        let compiled = with(&scene("", "irregularity = file(\"level.csv\")", ""), files);
        let place = |d: &trackbed::diag::Diagnostic| {
            let span = d.labels[0].span;
            let at = compiled.sources.position(span.file, span.start);
            (d.code, compiled.sources.get(span.file).name.clone(), at.line, at.column)
        };
        let found: Vec<_> = compiled.diagnostics.iter().filter(|d| d.code != Code::E0601).map(place).collect();
        let of_the_file = [Code::E0506, Code::E0509, Code::E0510];
        let told_where = |d: &trackbed::diag::Diagnostic| d.labels.len() > 1 || !of_the_file.contains(&d.code);
        assert!(compiled.diagnostics.iter().all(told_where), "{}", told(&compiled));
        found
    };
    let at = |code: Code, line: usize, column: usize| (code, "level.csv".to_string(), line, column);
    for (text, code, line, column) in [
        ("", Code::E0509, 1, 1),
        ("x_m;level_mm\n0;1\n", Code::E0509, 1, 1),
        ("x_m, level\n-12,0\n12,0\n", Code::E0509, 1, 6),
        ("x_m,level_furlong\n-12,0\n12,0\n", Code::E0509, 1, 5),
        ("place_m,level_mm\n-12,0\n12,0\n", Code::E0509, 1, 1),
        ("x_s,level_mm\n-12,0\n12,0\n", Code::E0509, 1, 1),
        ("x_m\n-12\n12\n", Code::E0509, 1, 1),
        ("x_m,level_mm,gauge_mm\n-12,0,0\n12,0,0\n", Code::E0509, 1, 1),
        ("x_m,level_s\n-12,0\n12,0\n", Code::E0302, 1, 5),
        ("x_m,level_mm\n-12,0\n0, none\n12,0\n", Code::E0510, 3, 4),
        ("x_m,level_mm\n-12,0\n0,NaN\n12,0\n", Code::E0510, 3, 3),
        ("x_m,level_mm\n-12,0\n0,1,5\n12,0\n", Code::E0510, 3, 1),
        ("x_m,level_mm\n-12,0\n0,1\n0,2\n12,0\n", Code::E0510, 4, 1),
        ("x_m,level_mm\n-12,0\n", Code::E0510, 1, 1),
        ("x_m,level_mm\n-12,0\n0,70\n12,0\n", Code::E0405, 3, 3),
        ("x_m,level_mm\n-12,0\n11,0\n", Code::E0506, 3, 1),
    ] {
        assert_eq!(mistakes(text), [at(code, line, column)], "{text}");
    }
    // all at once, and not without end
    let two = mistakes("x_m,level_mm\n-12,zero\n0,\n12,0\n");
    assert_eq!(two, [at(Code::E0510, 2, 5), at(Code::E0510, 3, 3)]);
    let noise: String = (0..500).map(|i| format!("{i},?\n")).collect();
    assert_eq!(mistakes(&format!("x_m,level_mm\n{noise}")).len(), 20);
    let large = Files(BTreeMap::from([("level.csv", " ".repeat(LARGEST_DATA_FILE as usize + 1))]));
    let compiled = with(&scene("", "irregularity = file(\"level.csv\")", ""), large);
    assert_eq!(codes(&compiled), [Code::E0508], "{}", told(&compiled));
}

#[test]
fn here_may_be_written_in_front_of_a_name() {
    for name in ["./level.csv", "././level.csv"] {
        let files = Files(BTreeMap::from([("level.csv", survey(|_| 0.0))]));
        sound_with(&scene("", &format!("irregularity = file(\"{name}\")"), ""), files);
    }
}

#[test]
fn data_lies_below_the_scene() {
    for name in [
        "../level.csv",
        "/etc/passwd",
        "data/../../level.csv",
        "C:level.csv",
        "data\\\\level.csv",
        "~/level.csv",
        "",
        "a//b",
        ".",
    ] {
        let compiled = with(&scene("", &format!("irregularity = file(\"{name}\")"), ""), Files::default());
        assert_eq!(codes(&compiled), [Code::E0508], "{name}: {}", told(&compiled));
    }
    let outside = tempfile::tempdir().unwrap();
    let inside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("level.csv"), survey(|_| 0.0)).unwrap();
    std::fs::write(inside.path().join("level.csv"), survey(|_| 0.0)).unwrap();
    std::fs::create_dir(inside.path().join("folder")).unwrap();
    let folder = Folder(inside.path().to_path_buf());
    assert!(folder.data(Path::new("level.csv")).is_ok());
    assert_eq!(folder.data(Path::new("other.csv")), Err(DataError::Missing));
    assert!(matches!(folder.data(Path::new("folder")), Err(DataError::Unreadable(_))));
    std::fs::File::create(inside.path().join("large.csv")).unwrap().set_len(LARGEST_DATA_FILE + 1).unwrap();
    assert_eq!(folder.data(Path::new("large.csv")), Err(DataError::TooLarge(LARGEST_DATA_FILE + 1)));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outside.path().join("level.csv"), inside.path().join("link.csv")).unwrap();
        assert_eq!(folder.data(Path::new("link.csv")), Err(DataError::Outside));
    }
    // the data is part of what a run is known by
    let print = |level: f64| {
        let files = Files(BTreeMap::from([("level.csv", survey(|_| level))]));
        trackbed::fingerprint(&with(&scene("", "irregularity = file(\"level.csv\")", ""), files).sources)
    };
    assert_ne!(print(0.0), print(1.0));
}

#[test]
fn a_speed_that_varies_has_its_largest_value_beside_it() {
    let scenario = sound(&scene(
        "",
        "",
        &TRAFFIC.replace("speed = 60 km/h", "speed = [-12 .. 0 m: ramp(36 .. 72 km/h), 0 .. 12 m: 54 km/h]"),
    ));
    let train = train(&scenario);
    close(*train.speed, 20.0);
    let profile = train.speed_profile.as_ref().unwrap();
    for (x, speed) in [(-12.0, 10.0), (-6.0, 15.0), (0.0, 15.0), (9.0, 15.0)] {
        close(profile.value(x), speed);
    }
    let scenario = sound(&scene("", "", TRAFFIC));
    assert!(self::train(&scenario).speed_profile.is_none());
}

#[test]
fn the_whole_physics_of_the_track_reaches_the_scene() {
    let text = scene(
        "auxiliary_rails = { rail = rails.S49, count = 2, pad = pads.soft }",
        "rail_ends = absorbing, irregularity = smooth(0 .. 1 mm)",
        &format!("{TRAFFIC}\nsolve {{ beam = timoshenko, integrator = hht, time_step = adaptive(1e-4) }}"),
    )
    .replace(
        "damping_time = 1 ms }",
        "damping_time = 1 ms, seating = { stiffness = 10 MN/m per sleeper, closure = 0.4 mm } }",
    );
    let compiled = with(&text, Files::default());
    assert!(!compiled.diagnostics.iter().any(|d| d.is_error()), "{}", told(&compiled));
    assert!(compiled.graph.is_some());
    let scenario = compiled.scenario.unwrap();
    let solve = &scenario.solve;
    assert_eq!((*solve.beam, solve.integrator), (Beam::Timoshenko, Integrator::Hht { alpha: 0.1 }));
    assert!(matches!(solve.time_step, TimeStep::Adaptive { tolerance } if *tolerance == 1e-4));
    assert_eq!(scenario.track.rail_ends, RailEnds::Absorbing);
    let rails = &scenario.track.auxiliary_rails[0].rails;
    // two rails on the track are one beside each rail
    close(*rails.rail.mass, 49.39);
    close(*rails.rail.bending_stiffness, 210e9 * 1816e-8);
    close(*rails.rail.shear_stiffness.unwrap(), 203e6);
    close(*rails.pad.stiffness, 70e6);
    let seating = support(&scenario, -1).seating.unwrap();
    close(*seating.stiffness, 5e6);
    close(*seating.closure, 0.4e-3);
    let four = text.replace("count = 2", "count = 4");
    let scenario = with(&four, Files::default()).scenario.unwrap();
    close(*scenario.track.auxiliary_rails[1].rails.rail.mass, 2.0 * 49.39);
}

#[test]
fn a_timoshenko_beam_needs_its_rails_shear_stiffness() {
    let text =
        scene("", "", "rail mine { mass = 60 kg/m, bending_stiffness = 6.4 MN m^2 }\nsolve { beam = timoshenko }")
            .replace("rail = rails.UIC60", "rail = mine");
    let compiled = with(&text, Files::default());
    assert_eq!(codes(&compiled), [Code::E0403], "{}", told(&compiled));
    let mistake = compiled.diagnostics.iter().find(|d| d.code == Code::E0403).unwrap();
    assert_eq!(mistake.message, "rail `mine` needs its `shear_stiffness` for `beam = timoshenko`");
    assert!(mistake.help.as_ref().unwrap().contains("shear_stiffness = 247 MN"), "{mistake:?}");
    let given =
        text.replace("bending_stiffness = 6.4 MN m^2 }", "bending_stiffness = 6.4 MN m^2, shear_stiffness = 240 MN }");
    let scenario = sound(&given);
    let rail = &scenario.track.sections[0].rail.as_ref().unwrap();
    close(*rail.shear_stiffness.unwrap(), 240e6);
    close(rail.rotary_inertia, 6.4e6 * 7850.0 / 210e9);
    let stated = given.replace(
        "mass = 60 kg/m, bending_stiffness = 6.4 MN m^2",
        "density = 7800 kg/m^3, area = 77 cm^2, youngs_modulus = 210 GPa, second_moment = 3038 cm^4",
    );
    close(sound(&stated).track.sections[0].rail.as_ref().unwrap().rotary_inertia, 7800.0 * 3038e-8);
}

/// Rows of the table of a run, by sleeper, at the first count.
fn run(text: &str) -> BTreeMap<String, results::SleeperRow> {
    let compiled = with(text, Files::default());
    assert!(!compiled.diagnostics.iter().any(|d| d.is_error()), "{}", told(&compiled));
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = results::RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    recorder.tables.sleepers.iter().filter(|r| r.axles == 0).map(|r| (r.sleeper.clone(), r.clone())).collect()
}

const COARSE: &str = "solve { elements_per_bay = 2, time_step = 4e-4 s }";

#[test]
fn an_under_sleeper_pad_is_a_spring_in_series() {
    let base = scene("usp = { bedding_modulus = 0.2 N/mm^3 }", "", &format!("{TRAFFIC}\n{COARSE}"));
    let padded = run(&base);
    // 0.2 N/mm^3 x 2.6 m x 0.3 m / 2 = 78 MN/m in series with 50 MN/m
    let series = 78.0 * 50.0 / 128.0;
    close(padded["-5"].support_stiffness_N_per_m, series * 1e6);
    // a support of that stiffness and damping is the same track
    let damping = (50.0 * 78.0 * 78.0 + 0.2 * 78.0 * 50.0 * 50.0) / (128.0 * 128.0); // kN s/m
    let same = base.replacen("usp = { bedding_modulus = 0.2 N/mm^3 }", "", 1).replace(
        "stiffness = 50 MN/m per seat, damping_time = 1 ms",
        &format!("stiffness = {series} MN/m per seat, damping = {damping} kN s/m per seat"),
    );
    for (sleeper, row) in run(&same) {
        assert!((row.max_contact_force_N - padded[&sleeper].max_contact_force_N).abs() < 1e-3, "{sleeper}");
    }
    let small = scene("usp = { bedding_modulus = 0.2 N/mm^3 }, sleeper = sleepers.B70 { base_area = 0.5 m^2 }", "", "")
        .replacen("sleeper = sleepers.B70, spacing", "spacing", 1);
    close(*seat(&sound(&small), -5).usp().unwrap().stiffness, 50e6);
}

#[test]
fn what_has_settled_at_the_start_is_in_the_tables_and_makes_sleepers_hang() {
    let rows = run(&scene(
        "settlement = [-19 .. -6 sleepers: 0 mm, -5 sleepers: 3 mm, -4 .. -1 sleepers: 0 mm]",
        "",
        &format!("{TRAFFIC}\n{COARSE}"),
    ));
    assert_eq!(rows["-5"].settlement_m, 3e-3);
    assert_eq!(rows["-6"].settlement_m, 0.0);
    // the rail carries the sleeper over the hole
    assert!(rows["-5"].void_m > 2e-3 && rows["-5"].gravity_contact_force_N == 0.0);
    assert!(rows["-6"].void_m == 0.0 && rows["-6"].gravity_contact_force_N > rows["-12"].gravity_contact_force_N);
    // a test load finds the same hole
    let load = "load jack { on = rail, at = -5 sleepers, force = 1 kN per rail }";
    let scene = scene("settlement = [-19 .. -6 sleepers: 0 mm, -5 sleepers: 3 mm, -4 .. -1 sleepers: 0 mm]", "", load);
    assert!(run(&scene)["-5"].void_m > 1e-3);
}

/// 600 m of sleepers with a random support.
fn long(random: &str, rest: &str) -> Vec<f64> {
    let text = scene("", "", rest)
        .replacen("stiffness = 50 MN/m per seat", &format!("stiffness = {random}"), 1)
        .replacen("open: 12 m", "open: 600 m", 1);
    let scenario = sound(&text);
    let ballasted = scenario.track.seats.iter().filter(|seat| seat.is_ballasted());
    ballasted.map(|seat| *support(&scenario, seat.number).stiffness).collect()
}

/// Mean, coefficient of variation and correlation of neighbours.
fn statistics(values: &[f64]) -> [f64; 3] {
    let mean = |of: &dyn Fn(usize) -> f64, n: usize| (0..n).map(of).sum::<f64>() / n as f64;
    let centre = mean(&|i| values[i], values.len());
    let away = |i: usize| values[i] - centre;
    let variance = mean(&|i| away(i).powi(2), values.len());
    [centre, variance.sqrt() / centre, mean(&|i| away(i) * away(i + 1), values.len() - 1) / variance]
}

#[test]
fn random_values_have_the_mean_the_scatter_and_the_correlation_that_were_asked_for() {
    for distribution in ["normal", "log_normal"] {
        let random = format!("random(50 MN/m, cov = 20 %, correlation = 1 m, distribution = {distribution}) per seat");
        let all: Vec<[f64; 3]> =
            (1..=12).map(|seed| statistics(&long(&random, &format!("solve {{ seed = {seed} }}")))).collect();
        let mean = |i: usize| all.iter().map(|s| s[i]).sum::<f64>() / 12.0;
        assert!((mean(0) / 50e6 - 1.0).abs() < 0.01, "{distribution}: mean {}", mean(0));
        assert!((mean(1) / 0.2 - 1.0).abs() < 0.03, "{distribution}: cov {}", mean(1));
        // exp(-0.36) of neighbours 0.6 m apart; of log-normal values a little less
        assert!((mean(2) - f64::exp(-0.36)).abs() < 0.02, "{distribution}: correlation {}", mean(2));
    }
    let sd = statistics(&long("random(100 MN/m, sd = 10 MN/m, correlation = 1 m) per sleeper", ""));
    assert!((sd[0] / 50e6 - 1.0).abs() < 0.03 && (sd[1] / 0.1 - 1.0).abs() < 0.1, "{sd:?}");
    let usual = statistics(&long("random(50 MN/m per seat)", ""));
    assert!((usual[0] / 50e6 - 1.0).abs() < 0.03 && (usual[1] / 0.1 - 1.0).abs() < 0.15 && usual[2] > 0.9, "{usual:?}");
}

#[test]
fn a_line_elsewhere_changes_no_random_value() {
    const RANDOM: &str = "support = { stiffness = random(50 MN/m, cov = 20 %) per seat }";
    let all = |text: &str| -> BTreeMap<i32, f64> {
        // what nothing uses is said, and matters nothing
        let scenario = with(text, Files::default()).scenario.unwrap();
        let ballasted = scenario.track.seats.iter().filter(|seat| seat.is_ballasted());
        ballasted.map(|seat| (seat.number, *support(&scenario, seat.number).stiffness)).collect()
    };
    let plain =
        scene("", "", "").replacen("support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }", RANDOM, 1);
    let first = all(&plain);
    assert!(first.values().any(|k| (k - 50e6).abs() > 1e6));
    assert_eq!(first, all(&plain));
    for (before, after) in [
        ("use std\n", "use std\n// a comment\nlet other = random(3 mm, cov = 5 %)\n"),
        ("sleeper = sleepers.B70,", "settlement = random(0 mm, sd = 1 mm), sleeper = sleepers.B70,"),
        (RANDOM, "support = { damping_time = 2 ms, stiffness = random(50 MN/m, cov = 20 %) per seat }"),
        ("track line", "solve { elements_per_bay = 6 }\ntrack line"),
        ("deck: 12 m", "deck: 24 m"),
    ] {
        assert_eq!(first, all(&plain.replacen(before, after, 1)), "{after}");
    }
    // a longer section adds sleepers at its far end
    let longer = all(&plain.replacen("open: 12 m", "open: 24 m", 1));
    assert!(longer.len() > first.len() && first.iter().all(|(number, k)| longer[number] == *k));
    // another seed, or another field, is another draw; a seed of its own does not ask the scene
    let seeded = |text: &str, seed: u32| all(&format!("{text}solve {{ seed = {seed} }}\n"));
    assert_eq!(first, seeded(&plain, 1));
    assert_ne!(first, seeded(&plain, 2));
    let own = plain.replacen("cov = 20 %", "cov = 20 %, seed = 7", 1);
    assert_eq!(seeded(&own, 1), seeded(&own, 2));
    assert_ne!(first, all(&own));
    assert_ne!(first, all(&plain.replace("open", "other")));
}

#[test]
fn random_levels_and_pieces_run_on_where_they_meet() {
    let level = |track: &str| sound(&scene("", track, "")).track.irregularity.unwrap();
    let whole = level("irregularity = random(0 mm, sd = 1 mm, correlation = 2 m)");
    let parts = level(
        "irregularity = [-12 .. -3 m: random(0 mm, sd = 1 mm, correlation = 2 m), -3 .. 12 m: random(0 mm, sd = 1 mm, correlation = 2 m)]",
    );
    let mut rough = 0.0_f64;
    for i in -480..480 {
        let x = f64::from(i) * 0.025;
        assert!((whole.value(x) - parts.value(x)).abs() < 1e-12, "{x}");
        rough = rough.max(whole.value(x).abs());
    }
    assert!((0.5e-3..4e-3).contains(&rough), "{rough}");
    // two sections that share a support share its field, to the seat
    let shared = scene("", "", "").replacen("stiffness = 50 MN/m per seat", "stiffness = ground", 1).replacen(
        "trackform deck",
        "let ground = random(50 MN/m, cov = 20 %) per seat\ntrackform deck",
        1,
    );
    let parts = shared.replacen("trackform deck", "trackform more : open { }\ntrackform deck", 1).replacen(
        "[open: 12 m, deck: 12 m]",
        "[more: 12 m, open: 12 m, deck: 12 m], transitions = [a: soft_to_stiff, b: soft_to_stiff]",
        1,
    );
    let whole = parts.replacen("more: 12 m, open: 12 m", "open: 12 m, more: 12 m", 1);
    let supports = |text: &str| -> Vec<f64> {
        let scenario = sound(text);
        scenario.track.seats.iter().filter_map(|seat| Some(*seat.support()?.stiffness)).collect()
    };
    assert_eq!(supports(&parts), supports(&whole));
}

#[test]
fn random_values_beyond_their_range_are_counted() {
    let text = scene("settlement = random(0 mm, sd = 60 mm, correlation = 0.5 m)", "", "");
    let compiled = with(&text, Files::default());
    let mistake =
        compiled.diagnostics.iter().find(|d| d.code == Code::E0605).unwrap_or_else(|| panic!("{}", told(&compiled)));
    assert!(
        mistake.message.contains(" of 20 random values (") || mistake.message.contains(" of 19 random values ("),
        "{}",
        mistake.message
    );
    assert!(
        mistake.message.ends_with("of the settlement of trackform `open` are outside -100 .. 100 mm"),
        "{}",
        mistake.message
    );
}

#[test]
fn arithmetic_acts_on_every_value_of_a_profile() {
    let stiffness = |lets: &str, value: &str| {
        let pad = format!("pad = {{ damping = 5 kN s/m, stiffness = {value} }}, sleeper");
        let scenario = sound(&scene("", "", lets).replacen("pad = pads.ahmadi_2026, sleeper", &pad, 1));
        let of = |number: i32| *seat(&scenario, number).pad.as_ref().unwrap().stiffness / 1e6;
        [of(-19), of(-10), of(-1)]
    };
    let plain = stiffness("let k = ramp(40 .. 60 MN/m)", "k");
    let close_to = |found: [f64; 3], act: &dyn Fn(f64) -> f64| {
        for (found, plain) in found.iter().zip(plain) {
            assert!((found - act(plain)).abs() < 1e-9, "{found} of {plain}");
        }
    };
    let lets = "let k = ramp(40 .. 60 MN/m)";
    let more = "let k = ramp(40 .. 60 MN/m)
let twice = 2 * k";
    let shares = "let k = ramp(40 .. 60 MN/m)
let part = 50 %";
    close_to(stiffness(lets, "2 * k"), &|k| 2.0 * k);
    close_to(stiffness(more, "twice / 4"), &|k| k / 2.0);
    close_to(stiffness(shares, "k * part + 5 MN/m"), &|k| 0.5 * k + 5.0);
    close_to(stiffness(lets, "100 MN/m - k"), &|k| 100.0 - k);
    close_to(stiffness(lets, "-(k - 100 MN/m)"), &|k| 100.0 - k);
    close_to(stiffness(lets, "k + ramp(0 .. 10 MN/m)"), &|k| k + (k - 40.0) / 2.0);
    // lists by places and by spans, entry by entry
    let pieces = "let k = [-12 .. -6 m: 40 MN/m, -6 .. 0 m: ramp(40 .. 60 MN/m)]
let more = [-12 .. -6 m: ramp(0 .. 10 MN/m), -6 .. 0 m: 5 MN/m]";
    let alone = pieces.lines().next().unwrap();
    let [far, _, near] = stiffness(alone, "2 * k");
    assert!((far - 80.0).abs() < 1e-9 && (115.0..=120.0).contains(&near), "{far} {near}");
    let [far, _, near] = stiffness(pieces, "k + more");
    assert!((40.0..42.0).contains(&far) && (62.0..=65.0).contains(&near), "{far} {near}");
    // products piece by piece, where one of the two is a number
    let factors = "let k = [-12 .. -6 m: 40 MN/m, -6 .. 0 m: ramp(40 .. 60 MN/m)]
let share = [-12 .. -6 m: ramp(1 .. 2), -6 .. 0 m: 1.5]";
    let [far, _, near] = stiffness(factors, "k * share");
    let [alone_far, _, alone_near] = stiffness(alone, "k");
    assert!((1.0..1.2).contains(&(far / alone_far)) && (near / alone_near - 1.5).abs() < 1e-9, "{far} {near}");
    let halves =
        "let k = [-12 .. -6 m: 40 MN/m, -6 .. 0 m: ramp(40 .. 60 MN/m)]\nlet part = [-12 .. -6 m: 4, -6 .. 0 m: 2]";
    let [far, _, near] = stiffness(halves, "k / part");
    assert!((far - 10.0).abs() < 1e-9 && (near - alone_near / 2.0).abs() < 1e-9, "{far} {near}");
    // a random profile is the same field, scaled
    let field = "let k = random(40 MN/m, sd = 2 MN/m, correlation = 3 m)";
    let (once, twice) = (stiffness(field, "k"), stiffness(field, "2 * k"));
    assert!(once.iter().zip(twice).all(|(k, twice)| (twice - 2.0 * k).abs() < 1e-9));
}

#[test]
fn profiles_that_do_not_combine_are_refused() {
    let with_settlement =
        |lets: &str, value: &str| with(&scene(&format!("settlement = {value}"), "", lets), Files::default());
    let refused = [
        ("let a = ramp(0 .. 1 mm)", "a * ramp(1 .. 2)", "in a product or quotient"),
        ("let a = [-12 m: 0 mm, 0 m: 1 mm]", "a * [-12 m: 1, 0 m: 2]", "both vary between places"),
        (
            "let a = [-12 .. -6 m: ramp(0 .. 1 mm), -6 .. 0 m: 1 mm]",
            "a * [-12 .. -6 m: ramp(1 .. 2), -6 .. 0 m: 1]",
            "both vary",
        ),
        (
            "let a = [-12 .. -6 m: 1 mm, -6 .. 0 m: 1 mm]",
            "a / [-12 .. -6 m: ramp(1 .. 2), -6 .. 0 m: 1]",
            "divided by a profile",
        ),
        ("let a = [-12 .. -6 m: 1 mm, -6 .. 0 m: 1 mm]", "a * [-12 .. -5 m: 2, -5 .. 0 m: 1]", "different places"),
        ("let a = ramp(1 .. 2 mm)", "1 mm / a", "divided by a profile"),
        ("let a = ramp(0 .. 1 mm)", "a + smooth(0 .. 1 mm)", "different forms"),
        ("let a = ramp(0 .. 1 mm, over = -6 .. 0 m)", "a + ramp(0 .. 1 mm)", "different spans"),
        ("let a = [-12 m: 0 mm, 0 m: 1 mm]", "a + [-12 m: 0 mm, -1 m: 1 mm, 0 m: 2 mm]", "different places"),
        ("let a = random(1 mm, cov = 10 %)", "a + 1 mm", "random profile"),
    ];
    for (lets, value, says) in refused {
        let compiled = with_settlement(lets, value);
        assert_eq!(codes(&compiled), [Code::E0428], "{value}: {}", told(&compiled));
        assert!(told(&compiled).contains(says), "{}", told(&compiled));
    }
    // other mistakes of arithmetic are said once, at their place
    for (lets, value, code) in [
        ("let a = ramp(0 .. 1 mm)", "a + 1 s", Code::E0305),
        ("let a = ramp(0 .. 1 mm)", "2 s * a", Code::E0302),
        ("let a = ramp(0 .. 1 mm)", "a + missing", Code::E0201),
        ("let a = 2 * a", "a", Code::E0203),
    ] {
        assert_eq!(codes(&with_settlement(lets, value)), [code], "{value}: {}", told(&with_settlement(lets, value)));
    }
}
