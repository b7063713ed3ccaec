//! The house rules of `ARCHITECTURE.md`: every folder imports from lower floors only, and the tree in that page is the
//! tree in `src/`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Floors of the folders of `src/`; one imports from lower floors and its own folder only. `lib.rs` stands above all of them.
const FLOORS: &[(&str, u32)] = &[
    ("diag", 0),
    ("units", 0),
    ("linalg", 0),
    ("solvers", 1),
    ("syntax", 2),
    ("schema", 2),
    ("scenario", 3),
    ("store", 3),
    ("check", 4),
    ("graph", 4),
    ("lower", 5),
    ("nodes", 5),
    ("lint", 6),
    ("execute", 6),
    ("compile", 7),
    ("results", 7),
    ("study", 8),
    ("trials", 8),
    ("embed", 8),
    ("report", 9),
    ("editor", 10),
    ("cli", 11),
];

/// What is planned and run knows SI numbers and no word of the language.
const KNOW_NO_SCENE: &[&str] = &["graph", "nodes", "execute"];
const SCENE: &[&str] = &["scenario", "schema", "syntax", "check"];

/// To be deleted with the first commit that gives `store` files of its own: until then it re-exports what `results` holds.
const ALLOWED_UNTIL_STORE_IS_THERE: &[(&str, &str)] = &[("store", "results")];

/// Solvers that know `linalg` and nothing else of the program, each other neither.
const SOLVERS: &[&str] = &["track", "granular", "continuum", "superstructure", "settlement", "foundation"];

fn floor(folder: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == folder).map(|(_, floor)| *floor)
}

fn sources(dir: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The code of a file without its comments.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    text.lines().map(|l| l.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// Second names of every `crate::a::b` path, groups included.
fn imports(code: &str) -> Vec<(String, Option<String>)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        if rest.starts_with('{') {
            let group = &rest[1..rest.find('}').unwrap_or(rest.len())];
            found.extend(group.split(',').map(|p| (p.trim().split("::").next().unwrap_or("").to_string(), None)));
            continue;
        }
        let path: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
        let mut names = path.split("::").filter(|n| !n.is_empty());
        if let Some(first) = names.next() {
            found.push((first.to_string(), names.next().map(str::to_string)));
        }
    }
    found
}

#[test]
fn folders_import_from_lower_floors_only() {
    let src = Path::new("src");
    let mut broken = Vec::new();
    for path in sources(src) {
        let relative = path.strip_prefix(src).unwrap();
        let parts: Vec<_> = relative.components().map(|c| c.as_os_str().to_string_lossy().into_owned()).collect();
        if parts.len() < 2 {
            assert!(["main.rs", "lib.rs"].contains(&parts[0].as_str()), "{} stands in no folder", relative.display());
            continue;
        }
        let own = &parts[0];
        let own_floor = floor(own).unwrap_or_else(|| panic!("src/{own} has no floor"));
        for (folder, inner) in imports(&code(&path)) {
            let Some(other) = floor(&folder) else {
                broken.push(format!("{}: `crate::{folder}` is no folder: {own} imports lib.rs", relative.display()));
                continue;
            };
            let allowed = ALLOWED_UNTIL_STORE_IS_THERE.contains(&(own.as_str(), folder.as_str()));
            if folder != *own && other >= own_floor && !allowed {
                broken.push(format!("{}: {own} ({own_floor}) imports {folder} ({other})", relative.display()));
            }
            let solver = SOLVERS.contains(&parts[1].trim_end_matches(".rs"));
            if own == "solvers" && solver && folder == "solvers" {
                let inner = inner.unwrap_or_default();
                if inner != parts[1].trim_end_matches(".rs") {
                    broken.push(format!("{}: a solver imports solvers::{inner}", relative.display()));
                }
            }
            if own == "solvers" && !["linalg", "solvers"].contains(&folder.as_str()) {
                broken.push(format!("{}: a solver imports {folder}", relative.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn plans_and_their_execution_know_no_scene() {
    for folder in KNOW_NO_SCENE {
        for path in sources(&Path::new("src").join(folder)) {
            for (other, _) in imports(&code(&path)) {
                assert!(!SCENE.contains(&other.as_str()), "{} imports {other}", path.display());
            }
        }
    }
}

#[test]
fn pest_and_miette_stay_in_their_folders() {
    for path in sources(Path::new("src")) {
        let text = code(&path);
        let shown = path.display().to_string().replace('\\', "/");
        assert!(
            !(text.contains("pest::") || text.contains("pest_derive")) || shown.starts_with("src/syntax/"),
            "{shown} names pest"
        );
        assert!(!text.contains("miette::") || shown.starts_with("src/diag/"), "{shown} names miette");
    }
}

#[test]
fn only_the_command_line_prints_or_exits() {
    for path in sources(Path::new("src")) {
        let text = code(&path);
        let shown = path.display().to_string().replace('\\', "/");
        if shown.starts_with("src/cli/") || shown == "src/main.rs" || shown.contains("/tests/") {
            continue;
        }
        for word in ["println!", "print!(", "eprintln!", "process::exit", "std::env::"] {
            assert!(!text.contains(word), "{shown} uses {word}");
        }
    }
}

#[test]
fn the_tree_of_the_architecture_page_is_the_tree_of_the_source() {
    let page = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let block = page.split("```").nth(1).expect("ARCHITECTURE.md shows a tree");
    let described: BTreeSet<String> = block
        .lines()
        .filter_map(|l| l.split_whitespace().next())
        .filter(|w| w.ends_with('/') && *w != "src/")
        .map(|w| w.trim_end_matches('/').to_string())
        .collect();
    let real: BTreeSet<String> = fs::read_dir("src")
        .unwrap()
        .map(Result::unwrap)
        .filter(|e| e.path().is_dir())
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(described, real);
}

#[test]
fn files_hold_one_idea() {
    for path in sources(Path::new("src")) {
        let lines = fs::read_to_string(&path).unwrap().lines().count();
        let table = path.ends_with("schema/kinds.rs");
        assert!(table || lines <= 800, "{} has {lines} lines", path.display());
        let first = fs::read_to_string(&path).unwrap();
        assert!(first.starts_with("//!"), "{} does not say what it is for", path.display());
    }
}
