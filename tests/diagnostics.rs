//! What a reader sees: every file in `tests/bad`, drawn; and that no span and no text upsets the drawing.

use proptest::prelude::*;
use std::path::Path;
use trackbed::check::Modules;
use trackbed::diag::render::{human, json};
use trackbed::diag::{Code, Diagnostic, Severity, Sources, Span};
use trackbed::syntax::parse;

fn drawn(name: &str, text: &str) -> String {
    let mut sources = Sources::default();
    let file = sources.add(name, text, false);
    human(&parse(file, text).1, &sources, false, 100)
}

#[test]
fn bad_files_are_explained() {
    let mut paths: Vec<_> = std::fs::read_dir("tests/bad").unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(paths.len() >= 10);
    for path in paths {
        let name = path.file_name().and_then(|n| n.to_str()).unwrap();
        let stem = path.file_stem().and_then(|n| n.to_str()).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        insta::assert_snapshot!(stem, drawn(name, &text));
    }
}

/// A survey with three mistakes.
struct Survey;

impl Modules for Survey {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        let rows = b"x_m,level_mm\n-12,0.4\n-6,0,9\n0,none\n-1,0.2\n12,0.1\n";
        (relative == Path::new("survey.csv")).then(|| rows.to_vec())
    }
}

#[test]
fn profiles_and_their_files_are_explained() {
    let text = r#"use std
trackform open {
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
  support    = { stiffness = [-12 .. -6 m: 40, -5 .. 0 m: ramp(40 .. 60 MN/m)] MN/m per seat }
  settlement = [-19 .. -4 sleepers: 0 mm, -4 .. -1 sleepers: 3 mm]
}
trackform deck : open { sleeper = none, support = none, usp = usps.soft, settlement = 0 mm, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, deck: 12 m], irregularity = file("survey.csv") }
load jack { on = rail, at = -1 m, force = 100 kN per rail }
"#;
    let compiled = trackbed::compile("scene.track", text, &Survey, &[]);
    insta::assert_snapshot!(human(&compiled.diagnostics, &compiled.sources, false, 100));
}

fn two_files() -> (Sources, Vec<Diagnostic>) {
    let mut sources = Sources::default();
    let main = sources.add("main.track", "use std\nsoil a { mass = 3 m }\n", false);
    let library = sources.add("std/soils.track", "// soils\nsoil a { }\n", true);
    let diagnostics = vec![
        Diagnostic::new(Code::E0202, "`a` is declared twice")
            .label(Span::new(main, 13, 14), "declared again here")
            .label(Span::new(main, 4, 7), "brought in here")
            .label(Span::new(library, 14, 15), "first declared here")
            .help("choose another name"),
        Diagnostic::new(Code::E0412, "`a` is used by nothing").label(Span::new(main, 13, 14), ""),
        Diagnostic::new(Code::E0601, "nothing to run").severity(Severity::Note),
    ];
    (sources, diagnostics)
}

#[test]
fn labels_in_another_file_get_their_own_excerpt() {
    let (sources, diagnostics) = two_files();
    insta::assert_snapshot!(human(&diagnostics, &sources, false, 100));
    assert_eq!(human(&[], &sources, false, 100), "");
    assert!(human(&diagnostics, &sources, true, 100).contains('\u{1b}'));
}

#[test]
fn diagnostics_are_data_too() {
    let (sources, diagnostics) = two_files();
    let data = json(&diagnostics, &sources);
    assert_eq!(
        data["diagnostics"][0],
        serde_json::json!({
            "code": "E0202", "severity": "error", "message": "`a` is declared twice", "file": "main.track",
            "start": { "line": 2, "column": 6 }, "end": { "line": 2, "column": 7 }, "help": "choose another name",
            "fixes": [],
        })
    );
    assert_eq!(
        data["diagnostics"][2],
        serde_json::json!({
            "code": "E0601", "severity": "note", "message": "nothing to run", "file": null,
            "start": null, "end": null, "help": null, "fixes": [],
        })
    );
}

#[test]
fn a_long_line_is_shown_in_part() {
    let text = format!("let a = [{}, *, {}]\n", vec!["1"; 5000].join(", "), vec!["2"; 5000].join(", "));
    let drawn = drawn("long.track", &text);
    assert!(drawn.contains("expected a value, found `*`"), "{drawn}");
    assert!(drawn.lines().all(|line| line.chars().count() < 300), "{drawn}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_span_upsets_the_drawing(
        text in prop::collection::vec(prop::sample::select(vec![
            "a", "b = ", "é", "\n", "\r\n", "\r", "\t", "\u{1b}[31m", "漢字", "\u{301}", "👩‍🔧", " ", "\u{200b}", "\0", "{", "}",
            "a long piece of text that is repeated until its line is far too long to be shown in full, and then some more of it, ",
        ]), 0..25),
        labels in prop::collection::vec((0..3_u32, 0..80_usize, 0..80_usize, any::<bool>(), "\\PC{0,5}"), 0..5),
        width in 0..120_usize,
        colour in any::<bool>(),
    ) {
        let mut sources = Sources::default();
        let file = sources.add("a.track", text.concat(), false);
        sources.add("empty.track", "", false);
        let mut diagnostic = Diagnostic::new(Code::E0101, "odd").help("none");
        for (other, start, end, far, label) in labels {
            let place = |at: usize| if far { at * 50_000_000 } else { at };
            let span = Span { file: trackbed::diag::FileId(file.0 + other), start: place(start) as u32, end: place(end) as u32 };
            diagnostic = diagnostic.label(span, label);
        }
        let diagnostics = [diagnostic];
        let shown = human(&diagnostics, &sources, colour, width);
        prop_assert!(shown.contains("odd") && shown.ends_with("1 error\n"));
        json(&diagnostics, &sources);
    }
}
