//! What broke the parser, the formatter or the checker once, and some texts that nobody would write.

#[path = "../fuzz/mutate.rs"]
mod mutate;
#[path = "../fuzz/targets.rs"]
mod targets;

use std::path::Path;

fn each(target: fn(&str)) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    for entry in std::fs::read_dir(corpus).unwrap() {
        let path = entry.unwrap().path();
        target(&std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())));
    }
    let seeds = [include_str!("../scenarios/transition.track"), include_str!("../scenarios/static_check.track")];
    (0..1500).for_each(|k| target(&mutate::text(&seeds, k)));
}

#[test]
fn parsing_survives() {
    each(targets::parse);
}

#[test]
fn formatting_survives() {
    each(targets::format);
}

#[test]
fn checking_survives() {
    each(targets::check);
}
