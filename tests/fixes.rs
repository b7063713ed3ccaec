//! Help that is an edit can be applied by a program: it takes the mistake away, and stands in the JSON of `check`.

use serde_json::Value;
use std::fs;
use trackbed::check::NoModules;
use trackbed::diag::{Code, FileId};
use trackbed::{Compiled, compile};

mod common {
    #[allow(dead_code, reason = "other tests ask more of it")]
    pub mod fixes;
    #[allow(dead_code, reason = "other tests ask more of it")]
    pub mod program;
}
use common::fixes::useless;
use common::program::trackbed;

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

/// The failing examples of all pages that are one file.
fn examples() -> impl Iterator<Item = (String, String)> {
    Code::ALL.iter().filter_map(|code| {
        let fails = code.page().split("\n## Fails\n").nth(1)?.split("\n## Passes\n").next()?;
        let block = fails.split("```").nth(1)?;
        let text = block.strip_prefix("track\n").filter(|text| !text.starts_with("// file: "))?;
        Some((code.to_string(), text.to_owned()))
    })
}

fn bad_files() -> impl Iterator<Item = (String, String)> {
    let mut paths: Vec<_> = fs::read_dir("tests/bad").unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap()))
}

#[test]
fn every_edit_takes_its_mistake_away() {
    let (mut edits, mut wrong) = (0, Vec::new());
    for (name, text) in examples().chain(bad_files()) {
        let found = compiled(&text);
        edits += found.diagnostics.iter().map(|d| d.fixes.len()).sum::<usize>();
        wrong.extend(useless(&text, &found, compiled).into_iter().map(|what| format!("{name}: {what}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(edits >= 40, "{edits} edits");
}

#[test]
fn an_edit_of_a_name_that_is_used_twice_mends_both_places() {
    let text = "use std\npad a { stiffness = 40 MN/m }\nlet stiff = 2\nlet x = stif * 3 mm\nlet y = stif * 2 mm\n\
                trackform open { rail = rails.UIC60, pad = a, sleeper = sleepers.B70, spacing = x + y }\n";
    let found = compiled(text);
    let unknown = found.diagnostics.iter().find(|d| d.code == Code::E0201).unwrap();
    let mended = unknown.fixes[0].applied(FileId(0), text);
    assert!(!mended.contains("stif "), "{mended}");
}

#[test]
fn edits_stand_in_the_json_of_a_check() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.track");
    let text = "pad ours { stifness = 40 MN/m }\n";
    fs::write(&path, text).unwrap();
    let output = trackbed(&["check", "--format", "json", path.to_str().unwrap()]);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fix = &json["diagnostics"][0]["fixes"][0];
    assert_eq!(fix["title"], "write `stiffness`");
    let edit = &fix["edits"][0];
    let place = edit["start"].as_u64().unwrap() as usize..edit["end"].as_u64().unwrap() as usize;
    assert_eq!((&text[place], edit["text"].as_str()), ("stifness", Some("stiffness")));
}
