//! Scenes drawn at random from the schema: every field of the vocabulary takes part, most scenes are sound, and none
//! breaks the program.

#[path = "../fuzz/dice.rs"]
mod dice;
#[path = "../examples/soak/draw/mod.rs"]
mod draw;
#[path = "../examples/soak/trial.rs"]
#[allow(dead_code, reason = "the command tells more than the tests ask")]
mod trial;

use draw::{Aim, Known};
use std::collections::BTreeSet;
use std::path::Path;
use trackbed::schema::KINDS;
use trial::Outcome;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn known() -> Known {
    Known::read(trial::shipped(root()).iter().map(String::as_str))
}

#[test]
fn every_field_of_the_vocabulary_is_drawn() {
    let known = known();
    let mut drawn = BTreeSet::new();
    for k in 0..4000 {
        let text = draw::scene(&known, trial::aim(k), k);
        drawn.extend(
            text.split(['{', ',', '\n'])
                .filter_map(|part| part.split_once(" = "))
                .map(|(name, _)| name.rsplit('.').next().unwrap_or(name).trim().to_string()),
        );
    }
    for kind in KINDS {
        for field in kind.fields {
            assert!(drawn.contains(field.name), "no scene has `{}` of a {}", field.name, kind.name);
        }
    }
}

#[test]
fn drawn_scenes_are_checked_and_many_are_sound() {
    let (known, mut check) = (known(), trial::checked(root()));
    let (mut accepted, scenes) = (0, 150);
    for k in 0..scenes {
        let outcome = check(k, &draw::scene(&known, trial::aim(k), k));
        assert_eq!(outcome.failure(), None, "scene {k}");
        accepted += u64::from(matches!(outcome, Outcome::Accepted { .. }));
    }
    assert!(accepted * 10 > scenes * 3, "{accepted} of {scenes} scenes are sound");
}

#[test]
fn drawn_scenes_run() {
    let known = known();
    let mut run = trial::run(root(), 0.2);
    let (mut begun, mut k) = (0, 0);
    while begun < 5 {
        let outcome = run(k, &draw::scene(&known, Aim::Law, k));
        assert_eq!(outcome.failure(), None, "scene {k}");
        begun += u64::from(outcome.has_begun());
        k += 1;
        assert!(k < 400, "{begun} of {k} scenes run");
    }
}

/// What failed once does not fail again.
#[test]
fn kept_scenes_survive() {
    let (mut check, mut run) = (trial::checked(root()), trial::run(root(), 5.0));
    // no scene has failed as long as the folder is not there
    for path in std::fs::read_dir(root().join("fuzz/soak")).into_iter().flatten().map(|entry| entry.unwrap().path()) {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let outcome = if name.starts_with("check") { check(0, &text) } else { run(0, &text) };
        assert_eq!(outcome.failure(), None, "{name}");
    }
}
