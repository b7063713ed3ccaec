//! A study that several processes share through its directory, without a scheduler: the answer is that of one process.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

mod common {
    pub mod coarse_cells;
    pub mod program;
    pub mod shared_packings;
    pub mod shared_study;
}
use common::program::{said, trackbed};
use common::shared_packings::{assert_same_run, packings, rig};
use common::shared_study::{POINTS, STUDY, assert_same_answer, kept_runs};

fn study(out: &Path, more: &[&str]) -> (Option<i32>, String) {
    let output = trackbed(&[&["study"], &STUDY[..], &["--out", out.to_str().unwrap()], more].concat());
    (output.status.code(), said(&output))
}

fn worker(out: &Path, tasks: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.args(["work", out.to_str().unwrap()]).args(tasks).env("NO_COLOR", "1");
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn workers_that_share_a_directory_give_the_answer_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let (alone, shared) = (folder.path().join("alone"), folder.path().join("shared"));
    assert_eq!(study(&alone, &[]).0, Some(0));
    let (code, told) = study(&shared, &["--executor", "workers"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(
        told.contains("tasks with 12 runs; start them on any machine")
            && told.contains("| xargs -P 4 -n 1 trackbed work"),
        "{told}"
    );
    assert!(!shared.join("study.csv").exists());
    let (code, told) = study(&shared, &[]);
    assert!(code == Some(1) && told.contains("E0802") && told.contains("--resume"), "it is under way: {told}");

    // one of two is killed in the middle; whoever comes later does the rest, and nothing twice
    let mut killed = worker(&shared, &[]).spawn().unwrap();
    while kept_runs(&shared) < 2 {
        thread::sleep(Duration::from_millis(5));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    let before = kept_runs(&shared);
    assert!((2..POINTS).contains(&before));
    let workers = [worker(&shared, &[]).spawn().unwrap(), worker(&shared, &[]).spawn().unwrap()];
    let outputs = workers.map(|worker| worker.wait_with_output().unwrap());
    let done: usize = outputs.iter().map(|output| said(output).matches(" s\n").count()).sum();
    assert_eq!(done, POINTS - before, "{:?}", outputs.iter().map(said).collect::<Vec<_>>());
    assert_eq!(kept_runs(&shared), POINTS);
    let (code, told) = study(&shared, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert_same_answer(&alone, &shared);
    assert_eq!(fs::read_dir(shared.join(".trackbed")).unwrap().flatten().filter(|e| e.path().is_dir()).count(), 0);

    let late = said(&worker(&shared, &[]).output().unwrap());
    assert!(late.contains("no study and no run is under way"), "{late}");
}

#[test]
fn a_worker_computes_the_tasks_that_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    assert_eq!(study(&out, &["--executor", "workers"]).0, Some(0));
    let output = worker(&out, &["0", "--threads", "1"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let first = kept_runs(&out);
    assert!((1..POINTS).contains(&first), "{first}");
    let output = worker(&out, &["0"]).output().unwrap();
    assert!(output.status.code() == Some(0) && said(&output).is_empty(), "it is done: {}", said(&output));
    let output = worker(&out, &["1000"]).output().unwrap();
    assert!(output.status.code() == Some(1) && said(&output).contains("holds no task 1000"), "{}", said(&output));
    assert_eq!(kept_runs(&out), first);
    let (code, told) = study(&out, &["--resume"]);
    assert_eq!(code, Some(0), "what is missing is computed here: {told}");
}

#[test]
fn a_worker_refuses_a_scene_that_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    let text = fs::read_to_string("scenarios/study_support.track").unwrap();
    fs::write(&scene, &text).unwrap();
    fs::copy("scenarios/transition.track", folder.path().join("transition.track")).unwrap();
    let out = folder.path().join("out");
    let arguments = ["study", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--executor", "workers"];
    let output = trackbed(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    fs::write(&scene, text.replace("study ", "let other = 1\nstudy ")).unwrap();
    let output = worker(&out, &["0"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said(&output).contains("E0809") && said(&output).contains("not the scene of the study"),
        "{}",
        said(&output)
    );
    assert_eq!(kept_runs(&out), 0);
}

/// Scripts are shown without a cluster; a study is not begun without one.
#[test]
fn a_machine_without_slurm_shows_its_scripts_and_begins_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let arguments = [&["study"], &STUDY[..], &["--out", out.to_str().unwrap()], more].concat();
        let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        let output = command.args(arguments).env("NO_COLOR", "1").env("PATH", "/nowhere").output().unwrap();
        (output.status.code(), said(&output))
    };
    let slurm = ["--executor", "slurm", "--cores", "2", "--partition", "long", "--jobs", "3"];
    let (code, told) = run(&[&slurm[..], &["--dry-run"]].concat());
    assert_eq!(code, Some(0), "{told}");
    for line in
        ["%3\n", "--mem=512M\n", "--cpus-per-task=2\n", "--partition=long\n", "SLURM_ARRAY_TASK_ID)) --threads 2\n"]
    {
        assert!(told.contains(line), "{line}: {told}");
    }
    assert!(!out.exists());
    let (code, told) = run(&slurm);
    assert!(code == Some(1) && told.contains("E0815") && told.contains("cannot start `sinfo`"), "{told}");
    assert!(!out.exists(), "nothing is begun");
    let (code, told) = run(&["--cores", "2"]);
    assert!(code == Some(2) && told.contains("`--cores` needs `--executor slurm`"), "{told}");
}

#[test]
fn packings_of_a_run_are_those_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    fs::write(&scene, packings()).unwrap();
    let [alone, killed, shared] = ["alone", "killed", "shared"].map(|name| folder.path().join(name));
    let arguments = |out: &Path, more: &[&'static str]| {
        let all = ["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()].map(String::from);
        all.into_iter().chain(more.iter().map(|text| text.to_string())).collect::<Vec<String>>()
    };
    let run = |out: &Path, more: &[&'static str]| {
        let arguments = arguments(out, more);
        let output = trackbed(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        (output.status.code(), said(&output))
    };
    let (code, told) = run(&alone, &[]);
    assert_eq!(code, Some(0), "{told}");

    // killed in a further packing, before anything of the run itself is kept
    let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    let mut child = child.args(arguments(&killed, &[])).stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
    while !killed.join("packings/2").exists() {
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let (code, told) = run(&killed, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert_same_run(&alone, &killed);

    // over the results of another scene
    assert_eq!(run(&shared, &["--set", "traffic.total=8 axles"]).0, Some(0));
    let (code, told) = run(&shared, &["--executor", "workers", "--force"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("with 3 runs; start them"), "{told}");
    let workers = [worker(&shared, &[]).spawn().unwrap(), worker(&shared, &[]).spawn().unwrap()];
    for worker in workers {
        let output = worker.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    }
    let manifest = |packing: &str| fs::read(shared.join(packing).join("manifest.json")).unwrap();
    assert_eq!(manifest("packings/3"), fs::read(alone.join("packings/3/manifest.json")).unwrap());
    assert_ne!(
        manifest(""),
        fs::read(alone.join("manifest.json")).unwrap(),
        "old results hold until the new ones are there"
    );
    let (code, told) = run(&shared, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("goes on after 16 axles"), "the run itself was computed too: {told}");
    assert_same_run(&alone, &shared);
}

#[test]
fn packings_of_a_rig_are_those_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    fs::write(&scene, rig("6 cycles")).unwrap();
    let cache = folder.path().join("beds").display().to_string();
    let [alone, shared, moved] = ["alone", "shared", "moved"].map(|name| folder.path().join(name));
    let run = |out: &Path, more: &[&str]| {
        let arguments = ["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--cache", &cache];
        let output = trackbed(&[&arguments, more].concat());
        (output.status.code(), said(&output))
    };
    let (code, told) = run(&alone, &[]);
    assert_eq!(code, Some(0), "{told}");
    let all = |out: &Path| fs::read(out.join("manifest.json")).unwrap();

    let (code, told) = run(&shared, &["--executor", "workers"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("with 2 runs; start them"), "{told}");
    // killed in the second packing: the first one is finished
    let mut child = worker(&shared, &[]).spawn().unwrap();
    while !shared.join(".trackbed/parts/1/.trackbed/checkpoint").exists() {
        assert!(child.try_wait().unwrap().is_none(), "killed too late: more cycles are needed");
        thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(shared.join(".trackbed/parts/0/manifest.json").exists());
    let copied = Command::new("cp").args(["-r", shared.to_str().unwrap(), moved.to_str().unwrap()]).status().unwrap();
    assert!(copied.success());

    // an edit of the scene is told, and nothing is computed from it
    fs::write(&scene, rig("7 cycles")).unwrap();
    let output = worker(&shared, &[]).spawn().unwrap().wait_with_output().unwrap();
    assert!(output.status.code() == Some(1) && said(&output).contains("E0809"), "{}", said(&output));
    fs::write(&scene, rig("6 cycles")).unwrap();

    // another worker goes on, and the run is made of the parts
    let output = worker(&shared, &[]).spawn().unwrap().wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("goes on after"), "{}", said(&output));
    let (code, told) = run(&shared, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert_eq!(all(&alone), all(&shared));
    assert!(!shared.join(".trackbed/parts").exists(), "parts end with the work");

    // or this process goes on itself
    let (code, told) = run(&moved, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("packing 2 of 2: seed 2") && told.contains("goes on after"), "{told}");
    assert_eq!(all(&alone), all(&moved));
}
