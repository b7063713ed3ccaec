//! Files that are not what they seem, and outputs that take nothing: refused with a reason, never followed, never
//! waited for.
#![cfg(unix)]

use std::fs;
use std::fs::Permissions;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn trackbed(arguments: &[&str]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    program.args(arguments).env("NO_COLOR", "1").env("COLUMNS", "140");
    program
}

/// Its exit code and all that it printed.
fn told(output: Output) -> (Option<i32>, String) {
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), said.concat())
}

/// Checks a scene that uses `part.track` beside it.
fn check(folder: &Path) -> (Option<i32>, String) {
    std::fs::write(folder.join("scene.track"), "use part as p\n").unwrap();
    told(trackbed(&["check", "scene.track"]).current_dir(folder).output().unwrap())
}

#[test]
fn a_module_that_links_out_of_the_folder_is_not_read() {
    let (folder, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    std::fs::write(outside.path().join("secret"), "password = 1234\n").unwrap();
    symlink(outside.path().join("secret"), folder.path().join("part.track")).unwrap();
    let (code, said) = check(folder.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("`part.track` is a link to a file outside the main file's folder"), "{said}");
    assert!(!said.contains("password"), "nothing of its text is shown: {said}");
}

#[test]
fn a_module_that_is_a_pipe_or_a_device_is_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("part.track");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let (code, said) = check(folder.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("`part.track` cannot be read: it is a folder or a device"), "{said}");
    std::fs::remove_file(&pipe).unwrap();
    std::fs::File::create(&pipe).unwrap().set_len(1 << 40).unwrap();
    let (_, said) = check(folder.path());
    assert!(said.contains("`part.track` has 1048576 MiB, more than 8 MiB"), "{said}");
}

#[test]
fn a_scene_without_an_end_is_left_off() {
    let (code, said) = told(trackbed(&["check", "/dev/zero"]).output().unwrap());
    assert_eq!(code, Some(2));
    assert!(said.contains("cannot read `/dev/zero`: it has more than 64 MiB"), "{said}");
}

#[test]
fn output_that_is_lost_is_told() {
    let full = || Stdio::from(std::fs::File::options().write(true).open("/dev/full").unwrap());
    let output = trackbed(&["docs"]).stdout(full()).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
    let (code, said) = told(output);
    assert_eq!(code, Some(1));
    assert!(said.contains("standard output is incomplete: No space left on device"), "{said}");
}

#[test]
fn no_answer_is_written_over_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    std::fs::copy("scenarios/bridge.track", &scene).unwrap();
    let text = std::fs::read(&scene).unwrap();
    for command in ["resolve", "draw"] {
        let output = trackbed(&[command, "scene.track", "--out", "./scene.track"]).current_dir(folder.path()).output();
        let (code, said) = told(output.unwrap());
        assert_ne!(code, Some(0));
        assert!(said.contains("`./scene.track` is the scene itself; name another file"), "{said}");
        assert_eq!(std::fs::read(&scene).unwrap(), text);
    }
}

#[test]
fn a_file_that_is_laid_out_stays_the_same_file() {
    let (folder, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (link, file) = (folder.path().join("scene.track"), elsewhere.path().join("kept.track"));
    std::fs::write(&file, "let   a=1 m\n").unwrap();
    std::fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
    symlink(&file, &link).unwrap();
    let (code, said) = told(trackbed(&["fmt", "scene.track"]).current_dir(folder.path()).output().unwrap());
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "let a = 1 m\n");
    assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
    assert!(link.symlink_metadata().unwrap().is_symlink());
    let left: Vec<_> = std::fs::read_dir(elsewhere.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "no temporary file is left: {left:?}");
}

/// Two billion pebbles: no machine holds them, and the plan knows it before it allocates any.
#[test]
fn a_run_larger_than_the_memory_is_not_started() {
    let folder = tempfile::tempdir().unwrap();
    let scene = [
        "scenarios/box_test.track",
        "--set",
        "box.sections=[bed: 50000 sleepers]",
        "--set",
        "box.bed_width=20 m per track",
    ];
    let out = folder.path().join("out");
    let run = [&["run"], &scene[..], &["--out", out.to_str().unwrap()]].concat();
    let (code, said) = told(trackbed(&run).output().unwrap());
    assert_eq!(code, Some(1));
    assert!(said.contains("E0813") && said.contains("GB of memory, and this machine has"), "{said}");
    assert!(said.contains("`--over-memory` starts the"), "{said}");
    assert!(!out.exists(), "nothing is begun");
    let text = fs::read_to_string("scenarios/box_test.track").unwrap()
        + "study wide { vary = [stone.friction: [0.5, 0.7]], minimise = max(settlement) }\n";
    let several = folder.path().join("several.track");
    fs::write(&several, text).unwrap();
    let study = [&["study", several.to_str().unwrap(), "--jobs", "2"], &scene[1..], &["--out", out.to_str().unwrap()]];
    let (code, said) = told(trackbed(&study.concat()).output().unwrap());
    assert_eq!(code, Some(1));
    assert!(said.contains("E0813") && said.contains("2 points at a time need about"), "{said}");
    assert!(said.contains("run fewer points at a time with `--jobs`") && !out.exists(), "{said}");
    let limited = [&["check"], &scene[..], &["--set", "solve.memory=1 GiB"]].concat();
    let (_, said) = told(trackbed(&limited).output().unwrap());
    assert!(
        said.contains("L1022") && said.contains("more than the limit of 1024 MiB"),
        "a rig is held to the memory of its scene: {said}"
    );
}

/// A law that settles 1 mm an axle: a level track follows it down without a complaint of its own.
#[test]
fn a_track_that_sinks_out_of_its_ballast_stops_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let law = |beta: &str| format!("solve.law={{ form = sato(beta = {beta}) }}");
    let run = |law: &str| {
        let scene = ["scenarios/transition.track", "--set", law, "--set", "line.sections=[open: 42 m, open: 24 m]"];
        let traffic = ["--set", "traffic.total=600 axles", "--force"];
        told(
            trackbed(&[&["run"], &scene[..], &traffic[..], &["--out", out.to_str().unwrap()]].concat())
                .output()
                .unwrap(),
        )
    };
    let (code, said) = run(&law("1 mm"));
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("E0814") && said.contains("more than the thickness of the ballast below it"), "{said}");
    assert!(said.contains("lies in `open`"), "the place is marked: {said}");
    let (_, said) = run(&law("1e-3 mm"));
    assert!(!said.contains("E0814") && said.contains("report.html"), "{said}");
}

/// Checks a scene of its own.
fn check_text(text: &str) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.track"), text).unwrap();
    told(trackbed(&["check", "scene.track"]).current_dir(folder.path()).output().unwrap())
}

#[test]
fn very_many_mistakes_are_counted() {
    let wrong: String = (0..3000).map(|k| format!("material m{k} {{ density = no_{k} }}\n")).collect();
    let (code, said) = check_text(&wrong);
    assert_eq!(code, Some(1));
    assert!(said.contains("5500 more errors are not shown"), "{}", &said[said.len() - 400..]);
}

/// Unknown names among many known ones: the first are told what may have been meant, the others only that they are
/// unknown, because each comparison takes time.
#[test]
fn very_many_unknown_names_are_told_without_a_search_for_each() {
    let wrong: String = (0..4000).map(|k| format!("rail m{k:04} : r{k:04} {{}}\n")).collect();
    let (code, said) = check_text(&wrong);
    assert_eq!(code, Some(1));
    let told = |k: usize| said.split("\n\nerror").find(|part| part.contains(&format!("called `r{k:04}`"))).unwrap();
    assert!(told(0).contains("did you mean `m0000`?"), "{}", told(0));
    assert!(!told(499).contains("did you mean"), "{}", told(499));
    assert!(said.contains("3500 more errors are not shown"), "{}", &said[said.len() - 400..]);
}

#[test]
fn a_module_of_many_names_is_not_listed_whole() {
    let folder = tempfile::tempdir().unwrap();
    let lets: String = (0..1000).map(|k| format!("let a{k:03} = {k} mm\n")).collect();
    fs::write(folder.path().join("lengths.track"), lets).unwrap();
    let text = "use lengths\nrail r { mass = lengths.other }\n";
    fs::write(folder.path().join("scene.track"), text).unwrap();
    let (_, said) = told(trackbed(&["check", "scene.track"]).current_dir(folder.path()).output().unwrap());
    assert!(said.contains("it has a000, a001") && said.contains("and 970 more"), "{said}");
}

#[test]
fn lets_count_among_declarations() {
    let lets: String = (0..100_001).map(|k| format!("let a{k} = 1\n")).collect();
    let (code, said) = check_text(&lets);
    assert_eq!(code, Some(1));
    assert!(said.contains("more than 100000 declarations and `let`s in one file"), "{}", &said[..400]);
}

#[test]
fn a_circle_of_lets_that_nothing_uses_is_told() {
    let (_, said) = check_text("let a = b\nlet b = a\n");
    assert!(said.contains("E0203") || said.contains("nothing uses `a`"), "{said}");
}

#[test]
fn fresh_wins_over_the_folder_of_the_environment() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.track"), "track line { sections = [] }").unwrap();
    let scene = folder.path().join("scene.track");
    let output = trackbed(&["pack", scene.to_str().unwrap(), "--fresh"]).env("TRACKBED_CACHE", folder.path()).output();
    let (_, said) = told(output.unwrap());
    assert!(!said.contains("cannot be used with"), "{said}");
}
