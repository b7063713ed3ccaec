//! Stretches: what a span of the track says reaches its seats and nothing else, what cannot be is refused, and each
//! mitigation does to the track what it is there for.

use trackbed::check::NoModules;
use trackbed::diag::Code;
use trackbed::lint::Winkler;
use trackbed::lower::supports;
use trackbed::results::{RunRecorder, SleeperRow};
use trackbed::scenario::{Foot, Scenario, Seat, Support};
use trackbed::{Compiled, compile, execute};

const FORMS: &str = "use std
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform deck : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
";

/// Sleepers -70 .. -1, seats +1 .. +40, and 20 axle loads.
fn embankment(stretches: &str, listed: &str) -> String {
    format!(
        "{FORMS}{stretches}
track line {{ sections = [open: 70 sleepers, deck: 24 m], stretches = [{listed}] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }}
traffic {{ trains = ore, total = 4 axles }}
solve {{ elements_per_bay = 2, time_step = 2e-4 s }}
"
    )
}

/// Slab, 60 sleepers, slab.
fn bridge(stretches: &str, listed: &str) -> String {
    format!(
        "{FORMS}{stretches}
track line {{
  sections = [deck: 12 m, open: 60 sleepers, deck: 12 m]
  transitions = [west: stiff_to_soft, east: soft_to_stiff]
  stretches = [{listed}]
}}
"
    )
}

fn checked(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn scene(text: &str) -> Scenario {
    let compiled = checked(text);
    let wrong = |d: &trackbed::diag::Diagnostic| d.code.rule().is_none() && d.code != Code::E0601;
    assert!(!compiled.diagnostics.iter().any(wrong), "{}", told(&compiled));
    compiled.scenario.unwrap()
}

/// Code and message of what is wrong, physics rules apart.
fn mistakes(text: &str) -> Vec<(Code, String)> {
    let compiled = checked(text);
    let wrong = compiled.diagnostics.iter().filter(|d| d.code.rule().is_none() && d.code != Code::E0601);
    wrong.map(|d| (d.code, d.message.clone())).collect()
}

fn seat(scenario: &Scenario, transition: usize, number: i32) -> &Seat {
    scenario.track.seats.iter().find(|s| s.transition == transition && s.number == number).unwrap()
}

fn support(seat: &Seat) -> &Support {
    seat.support().unwrap()
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1e-9), "found {found}, expected {expected}");
}

#[test]
fn a_stretch_changes_its_seats_and_no_other() {
    let stretches = "
stretch firm { over = -10 .. 5 sleepers, pad.stiffness = 60 MN/m }
stretch wide { over = -6 .. -1 sleepers, sleeper.base_width = 400 mm, sleeper.mass = 390 kg per sleeper }
stretch soft { over = -20 .. -11 sleepers, usp = { bedding_modulus = ramp(0.1 .. 0.3 N/mm^3) } }
stretch stiff { over = -3 .. 0 m, support.stiffness = smooth(50 .. 90 MN/m per seat), settlement = ramp(1 .. 4 mm) }
";
    let scenario = scene(&embankment(stretches, "firm, wide, soft, stiff"));
    let plain = scene(&embankment("", ""));
    let at = |n: i32| seat(&scenario, 0, n);
    for n in (-70..=-21).chain(6..=40) {
        let (mut found, expected) = (at(n).clone(), seat(&plain, 0, n));
        // origins stand elsewhere in the file
        found.pad = expected.pad.clone();
        found.foot = expected.foot.clone();
        assert_eq!(found, *expected);
        close(*at(n).pad.as_ref().unwrap().stiffness, 40e6);
    }
    // a damping time of the pad's own goes with its stiffness, a damping stays
    close(*at(-10).pad.as_ref().unwrap().stiffness, 60e6);
    close(*at(5).pad.as_ref().unwrap().stiffness, 60e6);
    close(*at(-10).pad.as_ref().unwrap().damping, 5e3);
    assert_eq!(at(-1).sleeper.unwrap().base_width, 0.4);
    assert_eq!(at(-7).sleeper.unwrap().base_width, 0.3);
    let Foot::Sleeper { mass, .. } = &at(-6).foot else { panic!() };
    close(**mass, 195.0);
    // both end sleepers of a span get the end values
    let usp = |n: i32| *at(n).usp().unwrap().stiffness;
    close(usp(-20), 0.1e9 * 2.6 * 0.3 / 2.0);
    close(usp(-11), 0.3e9 * 2.6 * 0.3 / 2.0);
    close(usp(-14), (0.1 + 0.2 * 6.0 / 9.0) * 1e9 * 0.39);
    assert!(at(-21).usp().is_none() && at(-10).usp().is_none());
    // a span in metres runs on distance and stays on its side: -5 lies on its end, -1 is 0.6 m before the boundary
    close(*support(at(-5)).stiffness, 50e6);
    close(*support(at(-1)).stiffness, 50e6 + 40e6 * (0.64 * (3.0 - 1.6)));
    close(*at(-1).initial_settlement, 1e-3 + 3e-3 * 0.8);
    close(*at(1).initial_settlement, 0.0);
    close(*support(at(-1)).damping, 1e-3 * *support(at(-1)).stiffness);
    let names: Vec<&str> = scenario.track.stretches.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["firm", "wide", "soft", "stiff"]);
    assert_eq!(scenario.track.stretches[1].changes, "sleeper.base_width, sleeper.mass");
}

#[test]
fn stretches_compose_where_they_set_different_things() {
    let stretches = "
stretch soft { over = -20 .. -1 sleepers, usp = usps.medium }
stretch wide { over = -6 .. -1 sleepers, sleeper.base_width = 400 mm }
";
    let both = scene(&embankment(stretches, "soft, wide"));
    let turned = scene(&embankment(stretches, "wide, soft"));
    assert_eq!(both.track.seats, turned.track.seats);
    let stiffness = |n: i32| *seat(&both, 0, n).usp().unwrap().stiffness;
    close(stiffness(-7), 0.2e9 * 2.6 * 0.3 / 2.0);
    // the pad lies under the wider sleeper
    close(stiffness(-6), 0.2e9 * 2.6 * 0.4 / 2.0);
}

#[test]
fn a_stretch_is_mirrored_at_each_transition() {
    let text = bridge(
        "usp graded { bedding_modulus = ramp(0.1 .. 0.3 N/mm^3) }
stretch approach { from = [west, east], over = -10 .. -1 sleepers, usp = graded }",
        "approach",
    );
    let scenario = scene(&text);
    for n in -10..=-1 {
        let [west, east] = [0, 1].map(|t| *seat(&scenario, t, n).usp().unwrap().stiffness);
        close(west, east);
        close(east, (0.1 + 0.2 * f64::from(n + 10) / 9.0) * 0.39e9);
    }
    assert!(seat(&scenario, 0, -11).usp().is_none());
    let only = scene(&text.replace("[west, east], over", "west, over"));
    assert!(seat(&only, 1, -1).usp().is_none());
    assert_eq!(only.track.stretches.len(), 1);
}

#[test]
fn a_profile_of_the_trackform_keeps_its_own_ground() {
    let graded = FORMS.replace("stiffness = 50 MN/m per seat", "stiffness = ramp(40 .. 60 MN/m per seat)");
    let text = |stretches: &str, listed: &str| embankment(stretches, listed).replace(FORMS, &graded);
    let plain = scene(&text("", ""));
    let pads = scene(&text("stretch p { over = -10 .. -1 sleepers, pad.stiffness = ramp(50 .. 90 MN/m) }", "p"));
    for (a, b) in plain.track.seats.iter().zip(&pads.track.seats).filter(|(a, _)| a.is_ballasted()) {
        close(*support(a).stiffness, *support(b).stiffness);
    }
    close(*seat(&pads, 0, -10).pad.as_ref().unwrap().stiffness, 50e6);
    close(*seat(&pads, 0, -1).pad.as_ref().unwrap().stiffness, 90e6);
}

#[test]
fn stretches_extend_each_other() {
    let text = embankment(
        "stretch soft { usp = usps.medium }
stretch softer : soft { over = -8 .. -1 sleepers, usp.bedding_modulus = 0.1 N/mm^3 }",
        "softer",
    );
    let scenario = scene(&text);
    close(*seat(&scenario, 0, -8).usp().unwrap().stiffness, 0.1e9 * 0.39);
    let set = |path: &str, value: &str| {
        let set = trackbed::check::Override::parse(&format!("{path}={value}")).unwrap();
        compile("scene.track", &text, &NoModules, &[set]).scenario.unwrap()
    };
    close(*seat(&set("softer.usp.bedding_modulus", "0.3 N/mm^3"), 0, -8).usp().unwrap().stiffness, 0.3e9 * 0.39);
    assert!(seat(&set("line.stretches", "[]"), 0, -8).usp().is_none());
}

#[test]
fn spacing_is_laid_out_from_the_transition() {
    let stretch = "stretch closer { over = -4 .. -1 sleepers, spacing = ramp(0.6 .. 0.45 m) }";
    let scenario = scene(&embankment(stretch, "closer"));
    let x = |n: i32| seat(&scenario, 0, n).x;
    // each bay is that of the sleeper before it, seen from the transition
    for (n, expected) in
        [(-1, -0.45), (-2, -0.9), (-3, -1.4), (-4, -1.95), (-5, -2.55), (-70, -41.55), (1, 0.0), (2, 0.6)]
    {
        assert!((x(n) - expected).abs() < 1e-9, "sleeper {n} at {} m, expected {expected}", x(n));
    }
    close(scenario.track.start(), -42.15);
    close(scenario.track.shortest_bay(), 0.45);
    let by_length = scene(&embankment(stretch, "closer").replace("70 sleepers", "42 m"));
    close(by_length.track.start(), -42.0);
    assert_eq!(by_length.track.seats[0].number, -70);
    let metres = scene(&embankment("stretch closer { over = -3 .. 0 m, spacing = 0.5 m }", "closer"));
    let gaps: Vec<f64> = metres.track.seats.windows(2).rev().map(|pair| pair[1].x - pair[0].x).collect();
    let changed = gaps.iter().filter(|gap| (**gap - 0.5).abs() < 1e-9).count();
    // sleepers at 0.5 .. 3 m, each with its bay, and the bay to the boundary
    assert_eq!(changed, 7);
}

#[test]
fn spacing_between_two_transitions_meets() {
    let stretch = "stretch closer { from = [west, east], over = -10 .. -1 sleepers, spacing = 0.5 m }";
    let scenario = scene(&bridge(stretch, "closer"));
    let [west, east] = [scenario.track.transitions[0].x, scenario.track.transitions[1].x];
    // 60 sleepers make 61 bays, 11 of each end closer
    close(east - west, 61.0 * 0.6 - 22.0 * 0.1);
    close(seat(&scenario, 0, -11).x - west, 5.5);
    close(east - seat(&scenario, 1, -11).x, 5.5);
    let length = bridge(stretch, "closer").replace("60 sleepers", "34.4 m");
    assert_eq!(scene(&length).track.seats.len(), scenario.track.seats.len());
    let found = mistakes(&length.replace("34.4 m", "34.5 m"));
    assert_eq!(found.len(), 1);
    assert!(found[0].0 == Code::E0502 && found[0].1.contains("beside those that stretches change"), "{found:?}");
}

#[test]
fn auxiliary_rails_lie_over_their_stretch() {
    let rails = "auxiliary_rails = { rail = rails.S49, pad = pads.soft }";
    let scenario = scene(&embankment(&format!("stretch beside {{ over = -10 .. 5 sleepers, {rails} }}"), "beside"));
    let [span] = scenario.track.auxiliary_rails.as_slice() else { panic!("{:?}", scenario.track.auxiliary_rails) };
    // half a bay beyond the end sleepers, across the transition in one piece
    close(span.start, -6.3);
    close(span.end, 2.7);
    close(*span.rails.rail.mass, 49.39);
    let without = embankment("stretch gap { over = -10 .. -6 m, auxiliary_rails = none }", "gap")
        .replace("spacing = 0.6 m", &format!("spacing = 0.6 m, {rails}"));
    let ends: Vec<(f64, f64)> = scene(&without).track.auxiliary_rails.iter().map(|s| (s.start, s.end)).collect();
    assert_eq!(ends.len(), 3);
    assert_eq!((ends[0].1, ends[1].0, ends[1].1), (-10.0, -6.0, 0.0));
}

#[test]
fn what_cannot_be_is_refused() {
    let cases = [
        ("stretch a { over = -5 .. -1 sleepers }", "a", Code::E0417, "stretch `a` changes nothing"),
        ("stretch a { over = -0.5 .. -0.1 m, usp = usps.soft }", "a", Code::E0417, "no sleeper lies in stretch `a`"),
        (
            "stretch a { over = -5 .. 5 sleepers, usp = usps.soft }",
            "a",
            Code::E0418,
            "stretch `a` sets `usp`, but seats +1 .. +5 stand on a slab",
        ),
        (
            "stretch a { over = 1 .. 3 sleepers, settlement = 2 mm }",
            "a",
            Code::E0418,
            "stretch `a` sets `settlement`, but seats +1 .. +3 stand on a slab",
        ),
        (
            "stretch a { over = -5 .. -5 sleepers, auxiliary_rails = { rail = rails.S49, pad = pads.soft } }",
            "a",
            Code::E0418,
            "the auxiliary rails of stretch `a` lie on one sleeper",
        ),
        ("stretch a { over = -80 .. -1 sleepers, usp = usps.soft }", "a", Code::E0501, "no sleeper has the number -80"),
        ("stretch a { over = -6 .. 0 sleepers, usp = usps.soft }", "a", Code::E0501, "there is no sleeper 0"),
        ("stretch a { over = -1 .. -6 sleepers, usp = usps.soft }", "a", Code::E0505, "a span must ascend"),
        ("stretch a { usp = usps.soft }", "a", Code::E0403, "stretch `a` needs `over`"),
        ("stretch a { over = -5 .. -1 sleepers, usp = { thickness = 8 mm } }", "a", Code::E0403, "`bedding_modulus`"),
        ("stretch a { over = -5 .. -1 sleepers, upd = usps.soft }", "a", Code::E0402, "`stretch` has no field `upd`"),
        ("stretch a { over = -5 .. -1 sleepers, pad.stiffness = 60 kN }", "a", Code::E0302, "stiffness"),
        ("stretch a { over = -5 .. -1 sleepers, pad.stiffness = ramp(60 .. 9e9 MN/m) }", "a", Code::E0405, "5 .. 3000"),
        (
            "stretch a { over = -5 .. -5 sleepers, pad.stiffness = ramp(60 .. 90 MN/m) }",
            "a",
            Code::E0505,
            "a ramp runs",
        ),
        ("stretch a { from = north, over = -5 .. -1 sleepers, usp = usps.soft }", "a", Code::E0504, "`north`"),
        ("stretch a { over = -5 .. -1 sleepers, rail = rails.S49 }", "a", Code::E0411, "`rail`"),
        (
            "stretch a { over = -5 .. -1 sleepers, spacing = [-2 m: 0.5 m, 0 m: 0.6 m] }",
            "a",
            Code::E0506,
            "the spacing of stretch `a`",
        ),
        ("stretch a { over = -5 .. -1 sleepers, usp = usps.soft }", "a, b", Code::E0201, "nothing is called `b`"),
        ("stretch a { over = -5 .. -1 sleepers, usp = usps.soft }", "", Code::E0412, "nothing uses `a`"),
        ("stretch a { over = -5 .. -1 sleepers, usp = usps.soft }", "open", Code::E0406, "expected a stretch"),
        (
            "stretch a { over = -9 .. -5 sleepers, usp = usps.soft }
stretch b { over = -5 .. -1 sleepers, usp.bedding_modulus = 0.1 N/mm^3 }",
            "a, b",
            Code::E0512,
            "stretch `a` sets `usp` and stretch `b` `usp.bedding_modulus` at seat -5",
        ),
        (
            "stretch a { over = -9 .. -3 sleepers, pad.stiffness = 60 MN/m }
stretch b { over = -5 .. 5 sleepers, pad.stiffness = 80 MN/m }",
            "a, b",
            Code::E0512,
            "stretches `a` and `b` both set `pad.stiffness` at seats -5 .. -3",
        ),
        (
            "stretch a { over = -9 .. -3 sleepers, pad.stiffness = 60 MN/m }",
            "a, a",
            Code::E0512,
            "stretch `a` overlaps itself at seats -9 .. -3",
        ),
    ];
    for (stretches, listed, code, message) in cases {
        let found = mistakes(&embankment(stretches, listed));
        assert_eq!(found.len(), 1, "{stretches}: {found:?}");
        assert!(found[0].0 == code && found[0].1.contains(message), "{stretches}: {found:?}");
    }
    let found = mistakes(&bridge("stretch a { over = -5 .. -1 sleepers, usp = usps.soft }", "a"));
    assert!(found.len() == 1 && found[0].0 == Code::E0504, "{found:?}");
    let text = bridge("stretch a { from = [west, east], over = -40 .. -1 sleepers, usp = usps.soft }", "a");
    let found = mistakes(&text);
    assert_eq!(
        found,
        [(Code::E0512, "stretch `a` overlaps itself at seats -21 of `west` to -21 of `east`".to_string())]
    );
}

#[test]
fn mistakes_in_several_stretches_are_told_at_once() {
    let text = embankment(
        "stretch a { over = -5 .. 5 sleepers, usp = usps.soft }
stretch b { over = -90 .. -60 sleepers, pad.stiffness = 60 MN/m }
stretch c { over = -15 .. -11 sleepers, pad.stifness = 60 MN/m }
stretch d { over = -25 .. -21 sleepers }",
        "a, b, c, d",
    );
    let codes: Vec<Code> = mistakes(&text).into_iter().map(|m| m.0).collect();
    assert_eq!(codes, [Code::E0501, Code::E0402, Code::E0417], "the slab is found once the others are right");
    let text = text
        .replace("-90 .. -60", "-9 .. -8")
        .replace("stifness", "stiffness")
        .replace("-21 sleepers }", "-21 sleepers, pad.stiffness = 60 MN/m }");
    assert_eq!(mistakes(&text).into_iter().map(|m| m.0).collect::<Vec<_>>(), [Code::E0418]);
}

/// The last rows of a run of one wagon.
fn run(text: &str) -> Vec<SleeperRow> {
    let compiled = checked(text);
    assert!(!compiled.diagnostics.iter().any(|d| d.is_error()), "{}", told(&compiled));
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    let last = recorder.tables.sleepers.iter().map(|r| r.axles).max().unwrap();
    recorder.tables.sleepers.iter().filter(|r| r.axles == last).cloned().collect()
}

fn row(rows: &[SleeperRow], number: i32) -> &SleeperRow {
    rows.iter().find(|r| r.sleeper.parse() == Ok(number)).unwrap()
}

/// Stiffness at rail level of the stiffer side of the transition over that of the softer one.
fn jump(scenario: &Scenario) -> f64 {
    let stiffness =
        |seat: usize| Winkler::at_seat(&scenario.track, &supports(scenario), seat).unwrap().rail_stiffness();
    let first = scenario.track.seats_of(1).start;
    stiffness(first) / stiffness(first - 1)
}

#[test]
fn each_mitigation_does_what_it_is_for() {
    let plain = embankment("", "");
    let with = |fields: &str| embankment(&format!("stretch m {{ {fields} }}"), "m");
    let before = run(&plain);
    // springs in series
    let pads = run(&with("over = -12 .. -3 sleepers, usp = usps.medium"));
    let (k, usp) = (50e6, 0.2e9 * 0.39);
    close(row(&pads, -5).support_stiffness_N_per_m, k * usp / (k + usp));
    close(row(&pads, -20).support_stiffness_N_per_m, k);
    assert!(row(&pads, -7).max_sleeper_displacement_m > 1.2 * row(&before, -7).max_sleeper_displacement_m);
    // the axles of a bogie share their deflection, so that the load falls by less than the fourth root of the stiffness
    assert!(row(&pads, -7).max_contact_force_N < 0.985 * row(&before, -7).max_contact_force_N);
    // a stiffer support towards the slab, or softer pads on it: less of a jump
    let ramped = with("over = -20 .. -1 sleepers, support.stiffness = ramp(50 .. 120 MN/m per seat)");
    let softened = with("over = 1 .. 20 sleepers, pad.stiffness = 25 MN/m");
    let plain_jump = jump(&scene(&plain));
    assert!(jump(&scene(&ramped)) < 0.9 * plain_jump && jump(&scene(&softened)) < 0.9 * plain_jump);
    assert!(row(&run(&softened), 1).max_rail_seat_load_N < 0.95 * row(&before, 1).max_rail_seat_load_N);
    // wider sleepers: the same force on a larger base
    let wide = with("over = -12 .. -1 sleepers, sleeper.base_width = 400 mm");
    let scenario = scene(&wide);
    let area = |n: i32| scenario.track.bearing_area(seat(&scenario, 0, n)).unwrap();
    close(area(-5), 4.0 / 3.0 * area(-20));
    let pressure = |rows: &[SleeperRow], area: f64| row(rows, -5).max_contact_force_N / area;
    assert!(pressure(&run(&wide), area(-5)) < 0.8 * pressure(&before, area(-20)));
    // auxiliary rails hand load from sleeper to sleeper: less of a wheel under it, and less at the edge of the slab
    let rails =
        run(&with("over = -14 .. 6 sleepers, auxiliary_rails = { rail = rails.UIC60, count = 4, pad = pads.stiff }"));
    let of_wheels = |rows: &[SleeperRow]| row(rows, -6).max_contact_force_N - row(rows, -6).gravity_contact_force_N;
    assert!(of_wheels(&rails) < 0.99 * of_wheels(&before));
    assert!(row(&rails, 1).max_rail_seat_load_N < 0.97 * row(&before, 1).max_rail_seat_load_N);
    assert!((row(&rails, -40).max_contact_force_N / row(&before, -40).max_contact_force_N - 1.0).abs() < 1e-6);
    // closer sleepers share it
    let closer = run(&with("over = -16 .. -1 sleepers, spacing = 0.5 m"));
    let ratio = row(&closer, -8).max_rail_seat_load_N / row(&before, -8).max_rail_seat_load_N;
    // lambda s grows with s^(3/4)
    let expected = (0.5_f64 / 0.6).powf(0.75);
    assert!((ratio / expected - 1.0).abs() < 0.04, "{ratio}, expected {expected}");
}
