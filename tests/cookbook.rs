//! The cookbook: each question has a scene that checks without a warning and asks for a study, and a page with excerpts
//! of that scene.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use trackbed::check::Folder;
use trackbed::compile;
use trackbed::diag::render;

/// Names of the files of a folder with an ending, without the ending.
fn names(folder: &str, ending: &str) -> BTreeSet<String> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let wanted = paths.filter(|path| path.extension().is_some_and(|e| e == ending));
    wanted.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect()
}

fn scene(name: &str) -> String {
    fs::read_to_string(format!("scenarios/cookbook/{name}.track")).unwrap()
}

#[test]
fn every_scene_has_its_page_and_every_page_its_scene() {
    let scenes = names("scenarios/cookbook", "track");
    let mut pages = names("docs/cookbook", "md");
    assert!(pages.remove("README"));
    assert_eq!(scenes, pages);
    assert_eq!(scenes.len(), 12);
    let list = fs::read_to_string("docs/cookbook/README.md").unwrap();
    for name in &scenes {
        assert!(list.contains(&format!("]({name}.md)")), "{name} is not in the list");
    }
}

#[test]
fn scenes_check_without_a_warning_and_ask_for_a_study() {
    for name in names("scenarios/cookbook", "track") {
        let compiled = compile("scene.track", &scene(&name), &Folder("scenarios/cookbook".into()), &[]);
        let told = render::human(&compiled.diagnostics, &compiled.sources, false, 120);
        assert!(compiled.diagnostics.is_empty(), "{name}:\n{told}");
        assert!(compiled.graph.is_some() && compiled.studies.len() == 1, "{name}");
    }
}

#[test]
fn excerpts_are_lines_of_the_scene_and_answers_are_figures() {
    for name in names("scenarios/cookbook", "track") {
        let page = fs::read_to_string(Path::new("docs/cookbook").join(format!("{name}.md"))).unwrap();
        let text = scene(&name);
        let lines: BTreeSet<&str> = text.lines().map(str::trim).collect();
        let data = fs::read_to_string(format!("scenarios/cookbook/{name}.csv")).unwrap_or_default();
        for block in page.split("\n```text\n").skip(1).filter_map(|rest| rest.split_once("\n```")) {
            for line in block.0.lines().map(str::trim).filter(|line| !line.is_empty()) {
                let known = lines.contains(line) || data.lines().any(|row| row.trim() == line);
                assert!(known, "{name}: `{line}` is not in the scene");
            }
        }
        assert!(page.contains(&format!("trackbed study scenarios/cookbook/{name}.track --out ")), "{name}");
        let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains(|c: char| c.is_ascii_digit()));
        assert!(rows.count() >= 3, "{name} has no table of figures");
        assert!(page.contains("What the model leaves out"), "{name}");
    }
}
