//! The book of `examples/book`: every link of its pages leads to a file of the book. Where mdBook is installed the book
//! is built too, and the links and anchors of its HTML are followed.

#[path = "../examples/book/links.rs"]
mod links;
#[path = "../examples/book/pages.rs"]
mod pages;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn markdown(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(markdown(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            found.push(path);
        }
    }
    found
}

/// Targets of the links of a page, outside its blocks of code.
fn targets(page: &str) -> Vec<&str> {
    let text = page.split("\n```").step_by(2);
    let links = text.flat_map(|text| text.split("](").skip(1).filter_map(|rest| rest.split_once(')')));
    links.map(|(target, _)| target).filter(|target| !target.contains("://")).collect()
}

/// Anchors of the headings of a page.
fn anchors(page: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(page).unwrap();
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let anchor = |line: &str| {
        let words = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        words.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect()
    };
    headings.map(anchor).collect()
}

#[test]
fn every_link_of_the_book_leads_to_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let count = pages::write(Path::new(env!("CARGO_MANIFEST_DIR")), folder.path()).unwrap();
    let (mut links, mut broken) = (0, Vec::new());
    for page in markdown(&folder.path().join("src")) {
        let text = fs::read_to_string(&page).unwrap();
        for target in targets(&text) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let to = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            links += 1;
            if !to.is_file() || !anchor.is_empty() && !anchors(&to).contains(anchor) {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "links that lead nowhere:\n{}", broken.join("\n"));
    assert!(count > 150 && links > 500, "{count} pages, {links} links");
    built(folder.path());
}

/// The book as HTML, where there is a program that makes it.
fn built(folder: &Path) {
    let mdbook = Command::new("mdbook").arg("build").arg(folder).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let Ok(status) = mdbook else { return eprintln!("no mdBook here: the HTML of the book is not built") };
    assert!(status.success(), "mdbook ended with {status}");
    let found = links::follow(&folder.join("html")).unwrap();
    assert!(found.broken.is_empty(), "links that lead nowhere:\n{}", found.broken.join("\n"));
    assert!(found.links > 1000 && found.bytes > 1_000_000, "{found:?}");
}
