//! The documents are true: their scenes check, their commands are understood and the quick ones run, and the reference
//! page is that of this vocabulary.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trackbed::check::{Folder, library};
use trackbed::{cli, compile, report};

/// `README.md` and every page of `docs/` and `docs/cookbook/`.
fn pages() -> Vec<(String, String)> {
    let folders = ["docs", "docs/cookbook"].map(|folder| fs::read_dir(folder).unwrap());
    let docs = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    let pages = docs.filter(|path| path.extension().is_some_and(|e| e == "md")).chain([PathBuf::from("README.md")]);
    let mut pages: Vec<_> =
        pages.map(|path| (path.display().to_string(), fs::read_to_string(&path).unwrap())).collect();
    pages.sort();
    pages
}

/// What stands behind the fences of a page, and the text inside each.
fn blocks(page: &str) -> Vec<(&str, &str)> {
    page.split("\n```").skip(1).step_by(2).map(|block| block.split_once('\n').unwrap_or((block, ""))).collect()
}

/// The scenes of a page: a fragment goes on where the last scene ended.
fn scenes(page: &str) -> Vec<String> {
    let mut scenes: Vec<String> = Vec::new();
    for (kind, text) in blocks(page) {
        match kind {
            "track" => scenes.push(text.to_string()),
            "track fragment" => {
                let whole = format!("{}\n{text}", scenes.last().expect("a fragment goes on with a scene"));
                scenes.push(whole);
            }
            _ => {}
        }
    }
    scenes
}

#[test]
fn every_scene_of_the_documents_checks() {
    let mut seen = 0;
    for (name, page) in pages() {
        for scene in scenes(&page) {
            let compiled = compile("page.track", &scene, &Folder("scenarios".into()), &[]);
            let told = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
            assert!(compiled.diagnostics.iter().all(|d| !d.is_error()), "{name}:\n{scene}\n{told}");
            assert!(compiled.scenario.is_some(), "{name}:\n{scene}");
            seen += 1;
        }
    }
    assert!(seen >= 9, "{seen} scenes");
}

/// The arguments of a command line; single quotes hold blanks together.
fn arguments(line: &str) -> Vec<String> {
    let line = line.split(" > ").next().unwrap_or_default();
    let parts = line.split('\'').enumerate().flat_map(|(i, part)| match i % 2 {
        0 => part.split_whitespace().map(str::to_string).collect::<Vec<_>>(),
        _ => vec![part.to_string()],
    });
    parts.collect()
}

/// Whole command lines of a page: indented, or behind a fence.
fn commands(page: &str) -> Vec<Vec<String>> {
    let shell = blocks(page).into_iter().filter(|(kind, _)| *kind == "sh").flat_map(|(_, text)| text.lines());
    let indented = page.lines().filter_map(|line| line.strip_prefix("    "));
    let own = |line: &str| {
        let line = line.trim_start_matches("$ ");
        ["trackbed ", "cargo run --release -- "].iter().find_map(|start| line.strip_prefix(start)).map(arguments)
    };
    shell.chain(indented).filter_map(own).collect()
}

/// A command with something in the place of what a reader fills in: edits and counts.
fn filled_in(code: &str) -> String {
    code.replace("...", "a=b").replace("NxM", "2x3").replace(" N", " 2")
}

/// What a command may leave out in running text.
const FILLED_IN: [&[&str]; 7] = [
    &[],
    &["FILE"],
    &["--out", "DIR"],
    &["FILE", "--out", "DIR"],
    &["DIR", "DIR"],
    &["FILE", "--measured", "CURVE"],
    &["bash"],
];

#[test]
fn every_command_of_the_documents_is_understood() {
    let mut odd = Vec::new();
    let mut seen = 0;
    for (name, page) in pages() {
        for command in commands(&page) {
            let understood = cli::understands(command.iter().map(String::as_str));
            assert_eq!(understood, Ok(()), "{name}: {command:?}");
            seen += 1;
        }
        // in running text a command may leave out what it works on
        for code in page.split('`').skip(1).step_by(2).filter_map(|code| code.strip_prefix("trackbed ")) {
            let given = arguments(&filled_in(code));
            let given: Vec<&str> = given.iter().map(String::as_str).collect();
            let with = |more: &&[&'static str]| cli::understands([&given[..], more].concat());
            let understood = with(&FILLED_IN[0]);
            let understood = understood.or_else(|said| FILLED_IN.iter().find_map(|more| with(more).ok()).ok_or(said));
            odd.extend(understood.err().map(|said| format!("{name}: `trackbed {code}`: {said}")));
            seen += 1;
        }
    }
    assert!(odd.is_empty(), "{}", odd.join("\n"));
    assert!(seen >= 20, "{seen} commands");
}

fn trackbed(folder: &Path, arguments: &[String]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .unwrap()
}

/// What makes a run of the tutorial short: the same track, few wheels, coarse steps.
const SHORT: [&str; 3] = ["traffic.total=4 axles", "solve.elements_per_bay=1", "solve.time_step=4e-4 s"];

#[test]
fn the_tutorial_can_be_followed() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenarios")).unwrap();
    for entry in fs::read_dir("scenarios").unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        fs::copy(&path, folder.path().join("scenarios").join(path.file_name().unwrap())).unwrap();
    }
    let page = fs::read_to_string("docs/tutorial.md").unwrap();
    let commands = commands(&page);
    assert!(commands.len() >= 4);
    for mut command in commands {
        if ["run", "study"].contains(&command[0].as_str()) {
            command.extend(SHORT.iter().flat_map(|set| ["--set".to_string(), set.to_string()]));
        }
        let output = trackbed(folder.path(), &command);
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command:?}\n{told}");
    }
    for file in ["track.svg", "pads/study.html", "best/report.html"] {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
}

#[test]
fn the_reference_page_is_that_of_this_vocabulary() {
    let page = fs::read_to_string("docs/reference.md").unwrap_or_default();
    assert!(
        page == report::reference(),
        "run `cargo run -- docs --format markdown > docs/reference.md`: the vocabulary, the library or the codes have changed"
    );
}

#[test]
fn every_entry_of_the_library_says_where_it_comes_from() {
    let entries = library();
    assert!(entries.len() >= 40, "{}", entries.len());
    for entry in entries {
        let name = format!("{}.{}", entry.module, entry.name);
        assert!(!entry.source.is_empty() && !entry.doc.is_empty(), "{name}");
        assert!(["read", "derived", "unchecked"].contains(&entry.evidence.as_str()), "{name}");
    }
}
