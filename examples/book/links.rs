//! Follows every link of a folder of HTML pages.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

/// What was found.
#[derive(Debug, Default)]
pub struct Found {
    /// Links inside the folder.
    pub links: usize,
    /// Page and target of each link that leads nowhere.
    pub broken: Vec<String>,
    /// Size of all files.
    pub bytes: u64,
}

/// Follows the links of all pages below a folder, as far as they stay in it.
pub fn follow(folder: &Path) -> io::Result<Found> {
    let mut files = BTreeMap::new();
    gather(folder, folder, &mut files)?;
    let mut found = Found { bytes: files.values().map(|file| file.bytes).sum(), ..Found::default() };
    for (name, file) in &files {
        for target in &file.targets {
            let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
            let place = if path.is_empty() { name.clone() } else { joined(name, path) };
            found.links += 1;
            let known = files.get(&place);
            if known.is_none_or(|file| !anchor.is_empty() && !file.anchors.contains(anchor)) {
                found.broken.push(format!("{}: {target}", name.display()));
            }
        }
    }
    Ok(found)
}

/// A file of the book; targets and anchors are of pages.
struct File {
    bytes: u64,
    targets: BTreeSet<String>,
    anchors: BTreeSet<String>,
}

fn gather(root: &Path, folder: &Path, files: &mut BTreeMap<PathBuf, File>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            gather(root, &path, files)?;
            continue;
        }
        let name = path.strip_prefix(root).unwrap_or(&path).to_owned();
        let bytes = path.metadata()?.len();
        let is_page = path.extension().is_some_and(|e| e == "html");
        // the page of a missing page says where the root is, and the printed book repeats all pages
        let text = if is_page && !["404.html", "print.html"].iter().any(|n| name == Path::new(n)) {
            fs::read_to_string(&path)?
        } else {
            String::new()
        };
        let local =
            |target: &String| !target.contains("://") && !target.starts_with("mailto:") && !target.starts_with("data:");
        let targets = [attributes(&text, " href=\""), attributes(&text, " src=\"")].concat();
        let targets = targets.into_iter().filter(local).filter(|target| !target.is_empty()).collect();
        let anchors = attributes(&text, " id=\"").into_iter().collect();
        files.insert(name, File { bytes, targets, anchors });
    }
    Ok(())
}

/// The values of an attribute.
fn attributes(text: &str, start: &str) -> Vec<String> {
    text.split(start)
        .skip(1)
        .filter_map(|rest| rest.split_once('"'))
        .map(|(value, _)| value.replace("&amp;", "&"))
        .collect()
}

/// The place to which a relative path leads from a page.
fn joined(page: &Path, path: &str) -> PathBuf {
    let mut place = PathBuf::new();
    let start = page.parent().unwrap_or(Path::new(""));
    for part in start.join(path).components() {
        match part {
            Component::ParentDir => drop(place.pop()),
            Component::CurDir => {}
            other => place.push(other),
        }
    }
    place
}
