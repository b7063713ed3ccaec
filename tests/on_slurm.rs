//! Studies and packings through a real Slurm: `tests/slurm/cluster.sh cargo test --test on_slurm -- --ignored
//! --test-threads 1`.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
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

/// A study on Slurm that goes on beside the test.
fn begun(out: &Path, more: &[&str]) -> Child {
    let arguments = [&["study"], &STUDY[..], &["--executor", "slurm", "--out", out.to_str().unwrap()], more].concat();
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).env("NO_COLOR", "1").spawn().unwrap()
}

fn wait_for(what: &str, mut is_so: impl FnMut() -> bool) {
    for _ in 0..6000 {
        if is_so() {
            return;
        }
        thread::sleep(Duration::from_millis(10));
    }
    panic!("waited a minute for {what}");
}

/// Job and place of tasks that Slurm has, in any state.
fn tasks(state: &str) -> Vec<String> {
    let output = Command::new("squeue").args(["-h", "-r", "-t", state, "-o", "%F_%K"]).output().unwrap();
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

/// One after the other: they count the tasks of the cluster.
#[test]
#[ignore = "needs a Slurm: tests/slurm/cluster.sh"]
fn a_study_on_slurm_is_the_study_on_this_machine() {
    let folder = tempfile::tempdir().unwrap();
    let [alone, slurm, killed, left, moved] =
        ["alone", "slurm", "killed", "left", "moved"].map(|name| folder.path().join(name));
    assert_eq!(study(&alone, &[]).0, Some(0));

    let (code, told) = study(&slurm, &["--executor", "slurm"]);
    assert_eq!(code, Some(0), "{told}");
    assert_same_answer(&alone, &slurm);
    assert!(tasks("all").len() >= 2, "{:?}", tasks("all"));

    // a task whose program is killed is given again
    let mut child = begun(&killed, &[]);
    wait_for("a task", || kept_runs(&killed) > 0 && !tasks("running").is_empty());
    // the worker itself: what `scancel` ends counts as cancelled
    let worker = format!("work {}", killed.display());
    assert!(Command::new("pkill").args(["-KILL", "--oldest", "--full", &worker]).status().unwrap().success());
    wait_for("its end", || child.try_wait().unwrap().is_some());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("given again"), "{}", said(&output));
    assert_same_answer(&alone, &killed);

    // who watches is killed: jobs go on, who comes next gives nothing twice, and a copy elsewhere gives the same tables
    let before = tasks("all").len();
    let mut child = begun(&left, &["--jobs", "1"]);
    wait_for("a run", || kept_runs(&left) > 0);
    child.kill().unwrap();
    child.wait().unwrap();
    let given = tasks("all").len() - before;
    assert!(kept_runs(&left) < POINTS);
    assert!(
        Command::new("cp").args(["-r", left.to_str().unwrap(), moved.to_str().unwrap()]).status().unwrap().success()
    );
    let (code, told) = study(&left, &["--executor", "slurm", "--resume", "--jobs", "1"]);
    assert_eq!(code, Some(0), "{told}");
    assert_eq!(tasks("all").len() - before, given, "nothing is given twice");
    assert_same_answer(&alone, &left);
    let (code, told) = study(&moved, &["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert_same_answer(&alone, &moved);

    // what a person cancels stays cancelled, and what Slurm refuses is told in its words
    let ended = folder.path().join("ended");
    let mut child = begun(&ended, &["--jobs", "1"]);
    wait_for("a run", || kept_runs(&ended) > 0);
    Command::new("scancel").arg("--name=speeds").status().unwrap();
    wait_for("its end", || child.try_wait().unwrap().is_some());
    let told = said(&child.wait_with_output().unwrap());
    assert!(told.contains("E0815") && told.contains("the last attempt was cancelled"), "{told}");
    let refused = folder.path().join("refused");
    let (code, told) = study(&refused, &["--executor", "slurm", "--partition", "nowhere"]);
    assert_eq!(code, Some(1));
    assert!(told.contains("E0815") && told.contains("`sbatch` refused") && told.contains("partition"), "{told}");
    let (code, told) = study(&refused, &["--executor", "slurm", "--resume"]);
    assert_eq!(code, Some(0), "with another partition it goes on: {told}");
    assert!(fs::metadata(refused.join("study.csv")).is_ok());
}

#[test]
#[ignore = "needs a Slurm: tests/slurm/cluster.sh"]
fn packings_of_a_rig_on_slurm_are_those_of_this_machine() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    fs::write(&scene, rig("60 cycles")).unwrap();
    let [alone, slurm] = ["alone", "slurm"].map(|name| folder.path().join(name));
    let arguments = |out: &Path| ["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()].map(String::from);
    let alone_output = trackbed(&arguments(&alone).each_ref().map(String::as_str));
    assert_eq!(alone_output.status.code(), Some(0), "{}", said(&alone_output));

    let before = tasks("all").len();
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    let command = command.args(arguments(&slurm)).args(["--executor", "slurm"]).env("NO_COLOR", "1");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // a task that is killed goes on from its checkpoint
    wait_for("a checkpoint", || slurm.join(".trackbed/parts/1/.trackbed/checkpoint").exists());
    let worker = format!("work {} 1", slurm.display());
    assert!(Command::new("pkill").args(["-KILL", "--full", &worker]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("given again"), "{}", said(&output));
    assert!(tasks("all").len() >= before + 2, "each packing is a task: {:?}", tasks("all"));
    let manifest = |out: &Path| fs::read(out.join("manifest.json")).unwrap();
    assert_eq!(manifest(&alone), manifest(&slurm));
}

#[test]
#[ignore = "needs a Slurm: tests/slurm/cluster.sh"]
fn packings_on_slurm_are_those_of_this_machine() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    fs::write(&scene, packings()).unwrap();
    let [alone, slurm] = ["alone", "slurm"].map(|name| folder.path().join(name));
    let run = |out: &Path, more: &[&str]| {
        let output = trackbed(&[&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat());
        (output.status.code(), said(&output))
    };
    let (code, told) = run(&alone, &[]);
    assert_eq!(code, Some(0), "{told}");
    let (code, told) = run(&slurm, &["--executor", "slurm"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("goes on after 16 axles"), "{told}");
    assert_same_run(&alone, &slurm);

    // whoever watches is killed while a task has the directory of the run: the next one watches the same tasks
    let again = folder.path().join("again");
    let arguments = ["run", scene.to_str().unwrap(), "--out", again.to_str().unwrap(), "--executor", "slurm"];
    let mut watch = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    let mut watch = watch.args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_for("a checkpoint of the run itself", || again.join(".trackbed/checkpoint").exists());
    watch.kill().unwrap();
    watch.wait().unwrap();
    let jobs = || {
        let told = Command::new("scontrol").args(["-o", "show", "jobs"]).output().unwrap().stdout;
        let logs = again.join(".trackbed/logs").display().to_string();
        String::from_utf8_lossy(&told).lines().filter(|job| job.contains(&logs)).count()
    };
    let before = jobs();
    let (code, told) = run(&again, &["--executor", "slurm", "--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(before > 0 && jobs() == before, "nothing is given twice: {told}");
    assert_same_run(&alone, &again);
}
