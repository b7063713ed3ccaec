//! The house rules of `ARCHITECTURE.md`: every folder imports from lower floors only, and the tree in that page is the
//! tree in `src/`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Floors of the folders of `src/`; one imports from lower floors and its own folder only. `lib.rs` stands above all of
/// them.
const FLOORS: &[(&str, u32)] = &[
    ("diag", 0),
    ("units", 0),
    ("linalg", 0),
    ("solvers", 1),
    ("syntax", 2),
    ("schema", 2),
    ("graph", 2),
    ("scenario", 3),
    ("store", 3),
    ("check", 4),
    ("lower", 5),
    ("nodes", 5),
    ("lint", 6),
    ("execute", 6),
    ("compile", 7),
    ("results", 7),
    ("compare", 8),
    ("study", 8),
    ("trials", 8),
    ("embed", 8),
    ("report", 9),
    ("cluster", 9),
    ("editor", 10),
    ("cli", 11),
];

/// What is planned and run knows SI numbers and no word of the language.
const KNOW_NO_SCENE: &[&str] = &["graph", "nodes", "execute"];
const SCENE: &[&str] = &["scenario", "schema", "syntax", "check"];

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
            if folder != *own && other >= own_floor {
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

/// Comments can be read beside a page of code: rustfmt leaves them as they are.
#[test]
fn comments_are_not_wider_than_code() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["src", "tests", "examples", "benches", "fuzz"];
    let mut wide = Vec::new();
    for path in folders.iter().flat_map(|folder| sources(&root.join(folder))) {
        let text = fs::read_to_string(&path).unwrap();
        let comments = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("//"));
        // tables and addresses cannot be broken
        let breakable = comments.filter(|(_, line)| !line.contains("| ") && !line.contains("://"));
        wide.extend(
            breakable
                .filter(|(_, line)| line.chars().count() > 120)
                .map(|(row, _)| format!("{}:{}", path.display(), row + 1)),
        );
    }
    assert!(wide.is_empty(), "comments of more than 120 columns:\n{}", wide.join("\n"));
}

/// The name of a function alone does not say what `Length::of` or `profile.at` gives.
#[test]
fn names_say_what_they_are() {
    for path in sources(Path::new("src")) {
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for (number, line) in lines.iter().enumerate() {
            let place = format!("{}:{}", path.display(), number + 1);
            for word in ["of", "at"] {
                let named = [format!("pub fn {word}("), format!("pub fn {word}<"), format!("pub(super) fn {word}(")];
                assert!(
                    !named.iter().any(|name| line.contains(name.as_str())),
                    "{place} has a function called `{word}`"
                );
            }
            let first = line.starts_with("///") && (number == 0 || !lines[number - 1].starts_with("///"));
            let subject = line.trim_start_matches('/').split_whitespace().next().unwrap_or("");
            assert!(
                !first || !["Of", "That", "As"].contains(&subject),
                "{place} does not say its subject first: {line}"
            );
        }
    }
}

/// Files import each other in one direction, so that each can be read on its own. Parts of one module (`mod.rs` and its
/// files) are read together.
#[test]
fn files_have_no_circles() {
    let files: Vec<PathBuf> = sources(Path::new("src"));
    let module = |path: &Path| -> Vec<String> {
        let relative = path.strip_prefix("src").unwrap().with_extension("");
        let mut names: Vec<String> =
            relative.components().map(|c| c.as_os_str().to_string_lossy().into_owned()).collect();
        names.retain(|name| name != "mod" && name != "lib");
        names
    };
    let modules: BTreeSet<Vec<String>> = files.iter().map(|path| module(path)).collect();
    let mut edges: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = BTreeMap::new();
    for path in &files {
        let own = module(path);
        let used = used(&code(path), &own);
        let leaves = used.iter().filter_map(|names| {
            (1..=names.len()).rev().map(|n| names[..n].to_vec()).find(|names| modules.contains(names))
        });
        // a folder stands for all its files: only paths to a file of its own count
        let leaves = leaves.filter(|names| *names != own && !is_folder(names));
        let leaves = leaves.collect();
        edges.insert(own, leaves);
    }
    for start in edges.keys().filter(|names| !is_folder(names)) {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(names) = open.pop() {
            for next in edges.get(names).into_iter().flatten() {
                assert!(next != start, "`{}` and `{}` import each other", start.join("::"), names.join("::"));
                if seen.insert(next) {
                    open.push(next);
                }
            }
        }
    }
}

fn is_folder(names: &[String]) -> bool {
    Path::new("src").join(names.iter().collect::<PathBuf>()).is_dir()
}

/// Absolute module paths of what a file imports, as far as its `use` lines and paths name them.
fn used(code: &str, own: &[String]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for statement in code.split(';').filter_map(|part| part.rsplit_once("use ").map(|(_, path)| path.trim())) {
        let (mut base, mut rest) = (Vec::new(), statement);
        if let Some(path) = rest.strip_prefix("crate::") {
            rest = path;
        } else if rest.starts_with("super::") {
            base = own[..own.len() - 1].to_vec();
            rest = rest.strip_prefix("super::").unwrap();
            while let Some(path) = rest.strip_prefix("super::") {
                base.pop();
                rest = path;
            }
        } else {
            continue;
        }
        for path in alternatives(rest) {
            let names = path.split("::").map(|name| name.split(" as ").next().unwrap_or("").trim().to_owned());
            found.push(base.iter().cloned().chain(names).collect());
        }
    }
    found
}

/// `a::{b, c::{d}}` as `a::b` and `a::c::d`.
fn alternatives(path: &str) -> Vec<String> {
    let Some((head, group)) = path.split_once('{') else { return vec![path.trim().to_owned()] };
    let group = group.rsplit_once('}').map_or(group, |(inner, _)| inner);
    let (mut parts, mut depth, mut from) = (Vec::new(), 0, 0);
    for (i, sign) in group.char_indices() {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&group[from..i]);
                from = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&group[from..]);
    let whole = parts.into_iter().filter(|part| !part.trim().is_empty()).flat_map(|part| alternatives(part.trim()));
    whole.map(|part| format!("{}{part}", head.trim())).collect()
}
