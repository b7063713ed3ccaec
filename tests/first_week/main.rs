//! What a railway engineer types in a first week, kind by kind, over scenes of every sort: each slip gives one
//! diagnostic at its own line, with the way out; and where the way out offers a text, that text passes the checker when
//! it is typed as offered.

use trackbed::check::Folder;
use trackbed::diag::Code;
use trackbed::{Compiled, compile};

#[path = "../common/scene.rs"]
mod scene;

mod dimensions;
mod layout;
mod numbers;
mod paths;
mod quotes;
mod units;
mod words;

/// A scene, what stands in it, what is typed in its place, the code, what the way out says, and the part of what is
/// typed that the first text in backticks of the way out takes the place of (none where it offers no text). The mistake
/// stands in the first line of what is typed, or behind `▸`.
type Slip = (&'static str, &'static str, &'static str, Code, &'static str, &'static str);

/// An embankment meets a slab: law, study, tamping, stretches, profiles.
pub const S: &str = scene::SCENE;
/// Two transitions, approach slabs, two kinds of trains.
pub const B: &str = include_str!("../../scenarios/bridge.track");
/// Under sleeper pads.
pub const U: &str = include_str!("../../scenarios/usp.track");
/// A wedge, closer and wider sleepers, supports from layers.
pub const W: &str = include_str!("../../scenarios/wedge.track");
/// A study of pads.
pub const P: &str = include_str!("../../scenarios/study_pads.track");
/// A sleeper on a box of grains.
pub const X: &str = include_str!("../../scenarios/box_test.track");
/// A triaxial test.
pub const T: &str = include_str!("../../scenarios/triaxial.track");
/// A rail on fixed sleepers under a jack.
pub const J: &str = include_str!("../../scenarios/static_check.track");

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &Folder("scenarios".into()), &[])
}

/// What is told, a line a diagnostic.
fn told(compiled: &Compiled) -> String {
    let line = |d: &trackbed::diag::Diagnostic| {
        let place = d.labels[0].span;
        let line = compiled.sources.position(place.file, place.start).line;
        format!("  {:?} line {line}: {}\n    {}", d.code, d.message, d.help.as_deref().unwrap_or("no way out"))
    };
    compiled.diagnostics.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn slips() -> Vec<Slip> {
    [numbers::SLIPS, dimensions::SLIPS, units::SLIPS, words::SLIPS, paths::SLIPS, quotes::SLIPS, layout::SLIPS].concat()
}

/// What is wrong with what is said of a slip; nothing where it is right.
fn judged(&(scene, right, typed, code, way_out, over): &Slip) -> Result<(), String> {
    assert_eq!(scene.matches(right).count(), 1, "`{right}` stands once");
    let marked = scene.replace(right, typed);
    let at =
        marked.find('▸').unwrap_or(scene.find(right).unwrap() + (typed.len() - typed.trim_start_matches('\n').len()));
    let line = marked[..at].matches('\n').count() + 1;
    let typed = typed.replace('▸', "");
    let found = compiled(&scene.replace(right, &typed));
    let say = |what: String| Err(format!("`{typed}`: {what}\n{}", told(&found)));
    let [mistake] = found.diagnostics.as_slice() else {
        return say(format!("{} diagnostics", found.diagnostics.len()));
    };
    let place = mistake.labels[0].span;
    let (told_code, told_line) = (mistake.code, found.sources.position(place.file, place.start).line);
    let help = mistake.help.as_deref().unwrap_or_default();
    if (told_code, told_line) != (code, line) || !help.contains(way_out) {
        return say(format!("expected {code:?} in line {line} with: {way_out}"));
    }
    if over.is_empty() {
        return Ok(());
    }
    let offered = way_out.split('`').nth(1).expect("a text in backticks");
    assert!(typed.contains(over), "`{over}` stands in `{typed}`");
    let mended = compiled(&scene.replace(right, &typed.replacen(over, offered, 1)));
    match !trackbed::diag::has_errors(&mended.diagnostics) {
        true => Ok(()),
        false => Err(format!("`{typed}` mended with `{offered}`:\n{}", told(&mended))),
    }
}

#[test]
fn every_slip_of_the_first_week_is_said_once_with_a_way_out_that_works() {
    let slips = slips();
    assert!(slips.len() >= 187, "{}", slips.len());
    let wrong: Vec<String> = slips.iter().filter_map(|slip| judged(slip).err()).collect();
    assert!(wrong.is_empty(), "{} of {} are not right:\n\n{}", wrong.len(), slips.len(), wrong.join("\n\n"));
}

#[test]
fn the_scenes_themselves_are_without_a_slip() {
    for scene in [S, B, U, W, P, X, T, J] {
        let found = compiled(scene);
        assert!(found.diagnostics.is_empty(), "{}", told(&found));
    }
}
