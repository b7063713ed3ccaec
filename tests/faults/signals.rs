//! Ctrl-C and SIGTERM in every coupled tier: the run keeps its state, says how to go on, and goes on to the same files.

use super::{Place, coarse_cells, in_one_line, same_results, wait_for};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};

const SOLVE: &str = "solve { substructure = cells, passages = continuous, update_every = 8 axles, tolerance = 20 % }";

/// The coarse scene of cells on another ground.
fn on_grains(solve: &str, axles: u32) -> String {
    assert!(coarse_cells::SCENE.contains(SOLVE));
    coarse_cells::SCENE.replace(SOLVE, solve).replace("total = 40 axles", &format!("total = {axles} axles"))
}

/// Stops a run as soon as it has kept a state, by Ctrl-C, stops it by SIGTERM as soon as it goes on, kills it, and lets
/// it come to its end.
fn stops_is_killed_and_goes_on(scene: &str) {
    let place = Place::new(scene);
    let checkpoint = place.path("cut/.trackbed/checkpoint");
    let mut child = place.start("cut", &[]);
    wait_for(&mut child, &checkpoint);
    is_stopped(child, "-INT");
    let mut child = place.start("cut", &["--resume"]);
    goes_on(&mut child);
    is_stopped(child, "-TERM");
    let mut child = place.start("cut", &["--resume"]);
    goes_on(&mut child);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(checkpoint.exists() && !place.path("cut/summary.json").exists());
    place.finish("cut", &["--resume"]);
    place.finish("whole", &[]);
    same_results(&place.path("whole"), &place.path("cut"));
}

/// Waits until a run says that it has taken up what was kept.
fn goes_on(child: &mut Child) {
    let (mut told, mut byte) = (Vec::new(), [0]);
    while !String::from_utf8_lossy(&told).contains("goes on after ") {
        let read = child.stderr.as_mut().unwrap().read(&mut byte).unwrap();
        assert!(read > 0, "{}", String::from_utf8_lossy(&told));
        told.push(byte[0]);
    }
}

/// Fails unless a run that gets a signal ends by itself and says how to go on.
fn is_stopped(child: Child, signal: &str) {
    Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    let told = in_one_line(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("the state is kept in") && told.contains("run the same command with `--resume`"), "{told}");
}

#[test]
fn cells_stop_and_go_on() {
    stops_is_killed_and_goes_on(&coarse_cells::SCENE.replace("total = 40 axles", "total = 16 axles"));
}

#[test]
#[ignore = "takes more than a minute"]
fn grains_that_exchange_with_the_track_stop_and_go_on() {
    stops_is_killed_and_goes_on(&on_grains(
        "solve { substructure = full, window = -1.8 .. 1.2 m, support_from = passage }",
        8,
    ));
}

#[test]
#[ignore = "takes more than a minute"]
fn vehicles_on_grains_stop_and_go_on() {
    stops_is_killed_and_goes_on(&on_grains(
        "solve { substructure = full, window = -1.8 .. 1.2 m, coupling = monolithic }",
        4,
    ));
}

/// Packing takes minutes on a large bed and is not waited for.
#[test]
fn a_run_stops_while_its_bed_is_packed() {
    let finer = coarse_cells::SCENE.replace("[50 mm: 0 %, 65 mm: 100 %]", "[25 mm: 0 %, 35 mm: 100 %]");
    let place = Place::new(&finer);
    let mut child = place.start("out", &[]);
    let is_packing = || fs::read_dir(place.path("beds")).is_ok_and(|mut entries| entries.next().is_some());
    while !is_packing() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it packed");
        std::thread::yield_now();
    }
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    let told = in_one_line(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("stopped before there was a state to keep"), "{told}");
    let beds = fs::read_dir(place.path("beds")).unwrap().map(|entry| entry.unwrap().path());
    assert!(!beds.into_iter().any(|path| path.extension().is_some_and(|end| end == "bed")), "it has packed to the end");
}

/// A passage over a long track in very short steps, hours of computing, from which no run can go on.
fn long_passage() -> String {
    super::on_a_law(40)
        .replace("open: 12 m, stiff: 12 m", "open: 600 m, stiff: 600 m")
        .replace("elements_per_bay = 2, time_step = 2e-4 s", "elements_per_bay = 32, time_step = 1e-6 s")
}

/// Waits until a command is at work in its directory, asks it to stop, and gives what it said.
fn stopped_at_work(mut child: Child, out: &Path) -> String {
    wait_for(&mut child, &out.join(".trackbed"));
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", in_one_line(&output));
    in_one_line(&output)
}

/// Whatever it is at: a run that does not stop by itself is ended from outside.
#[test]
fn a_run_ends_in_a_passage_of_hours() {
    let place = Place::new(&long_passage());
    let told = stopped_at_work(place.start("out", &[]), &place.path("out"));
    assert!(told.contains("stopped before there was a state to keep"), "{told}");
}

#[test]
fn a_study_ends_in_a_passage_of_hours() {
    let study = "study two_pads { vary = [stiff.pad.stiffness: [60, 80] MN/m], minimise = max(rail_seat_load) }\n";
    let place = Place::new(&(long_passage() + study));
    let [scene, out] = ["scene.track", "out"].map(|name| place.path(name).display().to_string());
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.args(["study", &scene, "--out", &out]).env("NO_COLOR", "1").stdout(Stdio::piped()).stderr(Stdio::piped());
    let told = stopped_at_work(command.spawn().unwrap(), &place.path("out"));
    assert!(told.contains("stopped: 0 of 3 points are kept"), "{told}");
}
