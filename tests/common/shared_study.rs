//! A study of a few seconds that processes share: speeds over a shipped scene, with fewer axles and coarser.

use std::fs;
use std::path::Path;

/// What follows `trackbed study`, but for its directory.
pub const STUDY: [&str; 7] = [
    "scenarios/study_speed.track",
    "--set",
    "traffic.total=20 axles",
    "--set",
    "solve.elements_per_bay=2",
    "--set",
    "solve.time_step=2e-4 s",
];

/// Its points.
pub const POINTS: usize = 12;

/// Fails where two directories do not hold the same answer, to the bit.
pub fn assert_same_answer(one: &Path, other: &Path) {
    for name in ["study.csv", "study.json", "study.html", "design.json", "points.json", "manifest.json"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(other.join(name)).unwrap(), "{name}");
    }
}

/// Runs that the study in a directory has kept.
pub fn kept_runs(out: &Path) -> usize {
    let entries = fs::read_dir(out.join(".trackbed/pieces"));
    let names = entries.into_iter().flatten().flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with("-0") && !name.starts_with(['.', 't'])).count()
}
