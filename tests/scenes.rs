//! The shipped transition zone, run as a library: what the paper says of it, and what must hold in any case.

use trackbed::check::{Folder, NoModules, Override};
use trackbed::results::{self, RunRecorder, SleeperRow};
use trackbed::{compile, execute};

struct Scene {
    sleepers: Vec<SleeperRow>,
    histories: Vec<results::HistoryRow>,
    blocks: Vec<results::BlockRow>,
}

fn run(text: &str) -> Scene {
    let compiled = compile("scene.track", text, &NoModules, &[]);
    let errors: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let mut recorder = RunRecorder::new(&scenario, &plan);
    execute::execute(&plan, &mut recorder).unwrap();
    Scene {
        histories: recorder.all_histories(),
        sleepers: recorder.tables.sleepers.clone(),
        blocks: recorder.tables.blocks.clone(),
    }
}

/// The shipped scene, thinned so that a test suite can afford it: the same track and vehicle, half the elements and
/// twice the step.
fn transition() -> Scene {
    let text = std::fs::read_to_string("scenarios/transition.track").unwrap();
    run(&text.replace("elements_per_bay = 4", "elements_per_bay = 2").replace("1e-4 s", "2e-4 s"))
}

#[test]
fn the_transition_sinks_where_the_paper_says() {
    let scene = transition();
    let at = |axles: u64| scene.sleepers.iter().filter(move |r| r.axles == axles).collect::<Vec<_>>();
    let last = at(500);
    let deepest = last.iter().max_by(|a, b| a.settlement_m.total_cmp(&b.settlement_m)).unwrap();
    assert!((-5.0..-2.5).contains(&deepest.x_m), "largest settlement at {} m", deepest.x_m);
    // some sleepers next to the slab hang, and the rail's weight moves to their neighbours
    let hanging: Vec<i32> = last.iter().filter(|r| r.void_m > 1e-6).map(|r| r.sleeper.parse().unwrap()).collect();
    assert!(hanging.contains(&-1) && hanging.iter().all(|n| *n < 0), "hanging: {hanging:?}");
    // the rate of settlement falls
    let far = |axles: u64| at(axles).iter().find(|r| r.sleeper == "-20").unwrap().settlement_m;
    assert!(far(100) / 100.0 > 2.0 * (far(500) - far(100)) / 400.0);
    // the seat on the slab's edge carries the highest load
    let highest = last.iter().max_by(|a, b| a.max_rail_seat_load_N.total_cmp(&b.max_rail_seat_load_N)).unwrap();
    assert_eq!(highest.sleeper, "+1");
    // contact is never in tension, and contact is lost only where there is a sleeper
    assert!(last.iter().all(|r| r.max_contact_force_N >= 0.0 && r.contact_loss_s >= 0.0));
    // seats that see only some of the wheels settle as their neighbours do: no false step grows there
    let settled: Vec<f64> = last.iter().filter(|r| r.x_m < -10.0).map(|r| r.settlement_m).collect();
    let (min, max) = settled.iter().fold((f64::MAX, 0.0_f64), |(a, b), s| (a.min(*s), b.max(*s)));
    assert!(max < 1.15 * min, "far-field settlement from {min} to {max} m");
}

#[test]
fn a_uniform_track_keeps_its_wheel_forces() {
    let text = std::fs::read_to_string("scenarios/transition.track").unwrap();
    let text = text
        .replace("sections    = [open: 42 m, stiff: 24 m]", "sections = [open: 66 m]")
        .replace("  transitions = [edge: soft_to_stiff]\n", "")
        .replace("at         = [-20, -13, -5, -3, +1, +7] sleepers", "at = 50 sleepers")
        .replace("after      = [0, 100, 500] axles", "after = 0 axles")
        .replace("expect { that = [-5 m < place_of_max(settlement) < -2.5 m] }", "")
        .replace("total = 500 axles", "total = 20 axles");
    let scene = run(&text);
    let load = 20_000.0 / 2.0 * 9.81;
    let wheels: Vec<f64> =
        scene.histories.iter().filter(|r| r.quantity == "wheel_force" && r.axles == 0).map(|r| r.value).collect();
    assert!(wheels.len() > 1000);
    let worst = wheels.iter().map(|f| (f / load - 1.0).abs()).fold(0.0, f64::max);
    // sleepers pass under the wheels 93 times a second; nothing else acts
    assert!(worst < 0.01, "wheel forces leave the static load by {worst}");
    let mean = wheels.iter().sum::<f64>() / wheels.len() as f64;
    assert!((mean / load - 1.0).abs() < 1e-4, "mean {mean} N");
    assert_eq!(scene.blocks.len(), 2);
}

/// Every shipped scene without a complaint, and a wagon over it.
#[test]
fn the_mitigations_that_come_with_the_program_run() {
    for name in ["usp", "sleepers", "pads", "wedge", "bridge"] {
        let path = format!("scenarios/{name}.track");
        let text = std::fs::read_to_string(&path).unwrap();
        let folder = Folder("scenarios".into());
        let few = ["traffic.total=4 axles", "solve.elements_per_bay=2", "solve.time_step=2e-4 s"];
        let every = ["traffic.trains=freight", "at_the_ends.after=4 axles"].iter().filter(|_| name == "bridge");
        let few: Vec<&str> = few.into_iter().chain(every.copied()).collect();
        let few: Vec<Override> = few.iter().map(|set| Override::parse(set).unwrap()).collect();
        let whole = compile(&path, &text, &folder, &[]);
        assert!(whole.diagnostics.is_empty(), "{path}: {:?}", whole.diagnostics);
        let compiled = compile(&path, &text, &folder, &few);
        let (scenario, plan) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
        assert!(!scenario.track.stretches.is_empty());
        let mut recorder = RunRecorder::new(&scenario, &plan);
        execute::execute(&plan, &mut recorder).unwrap();
        let settled: Vec<f64> =
            recorder.tables.sleepers.iter().filter(|r| r.axles == 4).map(|r| r.settlement_m).collect();
        assert!(settled.iter().any(|s| *s > 0.0), "{path}");
    }
}

#[test]
fn the_scenes_of_the_readme_check() {
    let text = std::fs::read_to_string("README.md").unwrap();
    let blocks: Vec<&str> = text.split("```track\n").skip(1).filter_map(|b| b.split("```").next()).collect();
    assert!(!blocks.is_empty());
    for block in blocks {
        let compiled = compile("readme.track", block, &NoModules, &[]);
        let errors: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(errors.is_empty() && compiled.graph.is_some(), "{errors:?}");
    }
}
