//! The program in a shell: completions, manual pages, help with examples, quiet and strict commands, standard input,
//! colour.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use trackbed::cli;

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

const FINE: &str = "scenarios/static_check.track";
/// It has a warning, L1001.
const WARNED: &str = "scenarios/transition.track";

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn code(output: &Output) -> Option<i32> {
    output.status.code()
}

/// The commands, as `--help` lists them.
fn commands() -> Vec<String> {
    let help = out(&trackbed(&["--help"]));
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    listed
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .map(str::to_string)
        .collect()
}

#[test]
fn every_help_has_examples_that_are_understood() {
    let names = commands();
    assert!(names.len() >= 20, "{names:?}");
    for name in names.iter().filter(|name| *name != "help") {
        let help = out(&trackbed(&[name, "--help"]));
        let examples: Vec<&str> = help.lines().skip_while(|line| *line != "Examples:").skip(1).collect();
        assert!(!examples.is_empty(), "{name} has no examples:\n{help}");
        let mut seen = 0;
        for line in examples.iter().filter_map(|line| line.trim().strip_prefix("trackbed ")) {
            let line = line.split(['>', '<', '|', '&']).next().unwrap_or_default();
            let parts = line.split('\'').enumerate().flat_map(|(i, part)| match i % 2 {
                0 => part.split_whitespace().map(str::to_string).collect::<Vec<_>>(),
                _ => vec![part.to_string()],
            });
            let given: Vec<String> = parts.collect();
            assert_eq!(cli::understands(given.iter().map(String::as_str)), Ok(()), "{name}: {line}");
            seen += 1;
        }
        assert!(seen > 0, "{name}: {examples:?}");
    }
}

#[test]
fn shells_complete_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = out(&trackbed(&["completions", shell]));
        for name in commands() {
            assert!(script.contains(&name), "{shell} does not know {name}");
        }
    }
    // a shell reads its script, and completes with it
    let script = out(&trackbed(&["completions", "bash"]));
    let ask = format!(
        "{script}\nCOMP_WORDS=(trackbed resol)\nCOMP_CWORD=1\n_trackbed trackbed resol trackbed\nprintf '%s' \"${{COMPREPLY[*]}}\""
    );
    let shell = Command::new("bash").args(["--norc", "-c", &ask]).output().unwrap();
    assert_eq!(out(&shell), "resolve", "{}", String::from_utf8_lossy(&shell.stderr));
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man");
    let output = trackbed(&["man", "--out", pages.to_str().unwrap()]);
    assert_eq!(code(&output), Some(0), "{}", said(&output));
    for name in commands().iter().filter(|name| *name != "help") {
        let page = fs::read_to_string(pages.join(format!("trackbed-{name}.1"))).unwrap_or_default();
        assert!(page.starts_with(".ie") || page.contains(".TH"), "{name}: {page}");
        assert!(page.contains("Examples:"), "{name} has no examples in its page");
    }
    let page = fs::read_to_string(pages.join("trackbed.1")).unwrap();
    assert!(page.contains("trackbed\\-run(1)"), "{page}");
}

#[test]
fn a_quiet_command_prints_errors_and_what_was_asked_for() {
    let loud = trackbed(&["check", WARNED]);
    assert!(said(&loud).contains("L1001") && out(&loud).contains("no errors"));
    let quiet = trackbed(&["check", "-q", WARNED]);
    assert_eq!((code(&quiet), out(&quiet).as_str(), quiet.stderr.len()), (Some(0), "", 0), "{}", said(&quiet));
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    let output = trackbed(&["--quiet", "run", FINE, "--out", run.to_str().unwrap()]);
    assert_eq!((code(&output), out(&output).as_str(), output.stderr.len()), (Some(0), "", 0), "{}", said(&output));
    assert!(run.join("report.html").is_file());
    // errors are told, and so is the requested output
    let missing = trackbed(&["-q", "check", "missing.track"]);
    assert!(code(&missing) == Some(2) && said(&missing).contains("missing.track"), "{}", said(&missing));
    assert!(out(&trackbed(&["-q", "plan", WARNED])).contains("estimate"));
}

#[test]
fn warnings_can_be_denied() {
    let output = trackbed(&["check", "--deny", "warnings", WARNED]);
    assert!(code(&output) == Some(1) && said(&output).contains("error L1001"), "{}", said(&output));
    assert_eq!(code(&trackbed(&["check", "--deny", "warnings", FINE])), Some(0));
    let listed = trackbed(&["check", "--deny", "warnings", "--format", "json", WARNED]);
    let found: serde_json::Value = serde_json::from_slice(&listed.stdout).unwrap();
    assert_eq!(found["diagnostics"][0]["severity"], "error");
}

#[test]
fn several_scenes_are_checked_at_once() {
    let output = trackbed(&["check", FINE, WARNED]);
    assert_eq!(code(&output), Some(0), "{}", said(&output));
    assert_eq!(out(&output).matches("no errors").count(), 2);
    // one that is wrong and one that is missing leave the others checked
    let folder = tempfile::tempdir().unwrap();
    let wrong = folder.path().join("wrong.track");
    fs::write(&wrong, "track line { sections = [open: 4 m] }\n").unwrap();
    let wrong = wrong.to_str().unwrap();
    let output = trackbed(&["check", wrong, FINE]);
    assert!(code(&output) == Some(1) && out(&output).contains("static_check"), "{}", said(&output));
    let output = trackbed(&["check", "missing.track", wrong, FINE]);
    assert!(code(&output) == Some(2) && said(&output).contains("E0201") && out(&output).contains("static_check"));
    let listed = trackbed(&["check", "--format", "json", wrong, WARNED]);
    let found: serde_json::Value = serde_json::from_slice(&listed.stdout).unwrap();
    let files: Vec<&str> = found["diagnostics"].as_array().unwrap().iter().filter_map(|d| d["file"].as_str()).collect();
    assert!(files.iter().any(|file| file.ends_with("wrong.track")) && files.contains(&WARNED), "{files:?}");
}

/// Runs the program with a text on its standard input.
fn fed(arguments: &[&str], text: &str, folder: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    program.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    program.wait_with_output().unwrap()
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let text = fs::read_to_string(WARNED).unwrap();
    let output = fed(&["check", "-"], &text, Path::new("scenarios"));
    assert!(code(&output) == Some(0) && out(&output).contains("-: no errors"), "{}", said(&output));
    // its modules lie in the working directory
    let using = fs::read_to_string("scenarios/pads.track").unwrap();
    assert_eq!(code(&fed(&["check", "-"], &using, Path::new("scenarios"))), Some(0));
    assert_eq!(code(&fed(&["check", "-"], &using, Path::new("src"))), Some(1));
    let output = fed(&["check", "-"], "track {", Path::new("scenarios"));
    assert!(code(&output) == Some(1) && said(&output).contains("-:1:"), "{}", said(&output));
}

#[test]
fn colour_is_as_asked() {
    let coloured = |how: &[&str]| said(&trackbed(&[&["check", WARNED], how].concat())).contains('\u{1b}');
    assert!(coloured(&["--color", "always"]));
    assert!(coloured(&["--colour", "always"]));
    assert!(!coloured(&["--color", "never"]));
    assert!(!coloured(&[]), "a pipe gets no colour");
}
