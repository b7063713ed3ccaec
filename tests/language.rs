//! The language guide is true: its scenes are scenes, and it names everything that the vocabulary has and plans.

use std::path::PathBuf;
use trackbed::check::Folder;
use trackbed::compile;
use trackbed::scenario::response::Response;
use trackbed::schema::{KINDS, PLANNED_KINDS};

fn guide() -> String {
    std::fs::read_to_string("docs/language.md").unwrap()
}

#[test]
fn the_scenes_of_the_guide_are_without_a_mistake() {
    let guide = guide();
    let blocks: Vec<&str> = guide.split("```track\n").skip(1).filter_map(|b| b.split("```").next()).collect();
    assert!(blocks.len() >= 3);
    for block in blocks {
        let compiled = compile("guide.track", block, &Folder(PathBuf::from("scenarios")), &[]);
        let told = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
        assert!(compiled.diagnostics.is_empty() && compiled.runnable().is_some(), "{block}\n{told}");
    }
}

#[test]
fn the_guide_names_the_whole_vocabulary() {
    let guide = guide();
    let (present, planned) = guide.split_once("## 10. Not in this version").unwrap();
    let names = |text: &str, name: &str| text.contains(&format!("`{name}`")) || text.contains(&format!("`{name} ="));
    for kind in KINDS {
        let row = present.lines().find(|l| l.starts_with(&format!("| `{}` |", kind.name)));
        let row = row.unwrap_or_else(|| panic!("no row for `{}`", kind.name));
        for field in kind.fields {
            assert!(names(row, field.name), "`{}` of `{}`", field.name, kind.name);
            for word in field.form.words() {
                let text = if word.planned { planned } else { present };
                assert!(text.contains(word.name), "word `{}` of `{}`", word.name, field.name);
            }
        }
        for field in kind.planned {
            assert!(names(planned, field) || planned.contains(&format!(".{field}`")), "`{field}` of `{}`", kind.name);
        }
    }
    for kind in PLANNED_KINDS {
        assert!(names(planned, kind), "`{kind}`");
    }
    for response in Response::ALL {
        assert!(names(present, response.name()), "`{}`", response.name());
    }
}
