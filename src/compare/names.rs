//! Short names of directories, each unlike the others.

use std::path::{Component, Path, PathBuf};

/// The shortest ends of paths by which they can be told apart; equal paths get numbers.
pub fn of_paths(paths: &[PathBuf]) -> Vec<String> {
    let parts: Vec<Vec<String>> = paths.iter().map(|path| parts(path)).collect();
    let longest = parts.iter().map(Vec::len).max().unwrap_or(0).max(1);
    for length in 1..=longest {
        let names: Vec<String> =
            parts.iter().map(|parts| parts[parts.len().saturating_sub(length)..].join("/")).collect();
        if are_distinct(&names) {
            return names;
        }
    }
    let name = |(index, path): (usize, &PathBuf)| format!("{} ({})", path.display(), index + 1);
    paths.iter().enumerate().map(name).collect()
}

fn parts(path: &Path) -> Vec<String> {
    let named = path.components().filter(|part| matches!(part, Component::Normal(_) | Component::ParentDir));
    let parts: Vec<String> = named.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    if parts.is_empty() { vec![".".to_owned()] } else { parts }
}

fn are_distinct(names: &[String]) -> bool {
    names.iter().enumerate().all(|(index, name)| !names[..index].contains(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_as_short_as_they_can_be() {
        let names = |paths: &[&str]| of_paths(&paths.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(names(&["out/soft", "out/stiff/"]), ["soft", "stiff"]);
        assert_eq!(names(&["a/out", "b/out"]), ["a/out", "b/out"]);
        assert_eq!(names(&["out", "out"]), ["out (1)", "out (2)"]);
        assert_eq!(names(&[".", "../other"]), [".", "other"]);
    }
}
