//! The formatter: what it writes, and what it never changes.

use proptest::prelude::*;
use trackbed::diag::{Code, FileId};
use trackbed::syntax::{format, parse};

const SCENES: [&str; 6] = [
    include_str!("scenes/box_test.track"),
    include_str!("scenes/bridge.track"),
    include_str!("scenes/static_check.track"),
    include_str!("scenes/transition.track"),
    include_str!("scenes/usp.track"),
    include_str!("scenes/wedge.track"),
];

/// The tree without its places, blanks in units taken as one.
fn tree(text: &str) -> String {
    let (tree, diagnostics) = parse(FileId(0), text);
    assert_eq!(diagnostics, [], "{text}");
    let printed = format!("{tree:?}");
    let mut out = String::new();
    let mut rest = printed.as_str();
    while let Some(at) = rest.find("span: Span {") {
        out.push_str(&rest[..at]);
        rest = rest[at..].split_once('}').map_or("", |(_, rest)| rest);
    }
    out.push_str(rest);
    out.replace("\\t", " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn comments(text: &str) -> Vec<String> {
    let inside_text = |line: &str, at: usize| line[..at].matches('"').count() % 2 == 1;
    let comment = |line: &str| {
        line.match_indices("//")
            .map(|(i, _)| i)
            .find(|i| !inside_text(line, *i))
            .map(|i| line[i..].trim_end().to_owned())
    };
    text.lines().filter_map(comment).collect()
}

/// Formats, and checks what must hold of any text.
fn check(text: &str) -> Option<String> {
    let once = format(text).ok()?;
    assert_eq!(format(&once).as_deref(), Ok(once.as_str()), "idempotent on\n{text}\nwhich became\n{once}");
    assert_eq!(tree(&once), tree(text), "the same tree for\n{text}\nwhich became\n{once}");
    assert_eq!(comments(&once), comments(text), "no comment lost of\n{text}\nwhich became\n{once}");
    assert!(once.lines().all(|l| l.trim_end() == l), "no blanks at line ends in\n{once}");
    assert!(!once.contains("\n\n\n") && !once.starts_with('\n'), "few empty lines in\n{once}");
    Some(once)
}

#[test]
fn the_scenes_keep_their_meaning_and_almost_their_form() {
    for text in SCENES {
        let formatted = check(text).unwrap_or_else(|| panic!("refused:\n{text}"));
        let code = |text: &str| -> Vec<String> {
            text.lines()
                .map(|l| l.split("  //").next().unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" "))
                .collect()
        };
        assert_eq!(code(&formatted), code(text));
    }
}

#[test]
fn a_tangle_is_laid_out() {
    let tangle = "\n\nsoil   a\n{ x=2*k,y = 3 m ^ 2, // c\n\n\n  long_name =\n 4mm , z=-( 1+ -2)\n a=b;
 list=[a:1,\n b : 2 ] mm\n o = { }\n  /// doc\n w = f(a=1 ,2)\n}\n\n\n\n// x\nlet a=1 // one\nlet bcd=[{\n a = 1\n}] // two
solve:base.x{x=1}\n  use   std   as  b\nlet c = 1 + // why\n 2\nlet d = 5kN   s/m*2\nstudy s {\n x = [\n\n // in\n a:1 ..2\n\n ]\n\n}"
        .replace(" a=b;\n", "");
    insta::assert_snapshot!(check(&tangle).unwrap());
}

#[test]
fn a_text_with_mistakes_is_refused_with_them() {
    let refused = format("soil a { x = * }\nsoil b { y := 1 }").unwrap_err();
    assert_eq!(refused.iter().map(|d| d.code).collect::<Vec<_>>(), [Code::E0101, Code::E0105]);
    assert_eq!(format("").as_deref(), Ok(""));
    assert_eq!(format("\r\n  use std\r\n").as_deref(), Ok("use std\n"));
}

/// The text of a value, with blanks and line breaks where they may stand.
fn value() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "1",
        "0.5",
        "1_000",
        "300mm",
        "3  m",
        "2 kN  s/m",
        "4 J/(kg K)",
        "7 %",
        "1 m²",
        "a",
        "a.b.c",
        "?",
        "\"a, // b\"",
        "\"\"",
    ])
    .prop_map(str::to_owned);
    let gap = || prop::sample::select(vec!["", " ", "  ", "\t"]);
    let wide = || prop::sample::select(vec!["", " ", "\n", "\n\n  ", " // note\n", "\n // alone\n"]);
    let sep =
        || prop::sample::select(vec![",", ", ", "\n", " ,\n", "\n\n\n", " // why\n", ", // why\n", "\n // own\n\n"]);
    leaf.prop_recursive(4, 40, 4, move |inner| {
        let items = (
            prop::collection::vec(inner.clone(), 0..4),
            sep(),
            wide(),
            prop::sample::select(vec!["", " mm", " axles"]),
        );
        let list = items.prop_map(|(items, sep, end, unit)| format!("[{end}{}{end}]{unit}", items.join(sep)));
        let pairs =
            (prop::collection::vec(inner.clone(), 0..3), sep(), gap(), wide()).prop_map(|(items, sep, gap, wide)| {
                let items: Vec<String> = items.iter().map(|v| format!("k.l{gap}:{wide}{v}")).collect();
                format!("[{}]", items.join(sep))
            });
        let object =
            (prop::collection::vec(inner.clone(), 0..4), sep(), gap(), wide()).prop_map(|(items, sep, gap, wide)| {
                let items: Vec<String> =
                    items.iter().enumerate().map(|(i, v)| format!("{}{gap}={wide}{v}", "x".repeat(i + 1))).collect();
                format!("b{gap}{{{wide}{}{wide}}}", items.join(sep))
            });
        let call =
            (prop::collection::vec(inner.clone(), 0..3), sep(), gap(), wide()).prop_map(|(items, sep, gap, wide)| {
                let items: Vec<String> = items.iter().map(|v| format!("n{gap}={gap}{v}")).collect();
                format!("f{gap}({wide}{}{wide})", items.join(sep))
            });
        let binary = (
            inner.clone(),
            prop::sample::select(vec!["+", "-", " - ", " * ", " / ", " ^ ", "..", "<", ">="]),
            wide(),
            gap(),
            inner.clone(),
        )
            .prop_map(|(a, operator, wide, gap, b)| format!("({a}){gap}{operator}{wide}({b})"));
        let signed = (inner.clone(), gap()).prop_map(|(a, gap)| format!("-{gap}({a}) per{gap} seat"));
        let loose = (inner.clone(), inner).prop_map(|(a, b)| format!("{a} * {b} + -{a}"));
        prop_oneof![list, pairs, object, call, binary, signed, loose]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn any_value_keeps_its_meaning(value in value(), header in prop::sample::select(vec!["let v =", "soil a {\n x =", "soil a { x ="])) {
        let close = if header.contains('{') { "\n}" } else { "" };
        check(&format!("{header} {value}{close}\n// end"));
    }

    #[test]
    fn scattered_scenes_keep_their_meaning(
        scene in 0..SCENES.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop::sample::select(vec![
            " ", "\n", "\n\n\n", ",", " // note\n", "\n// own\n", "\n/// doc\n", "\t",
        ])), 0..8),
    ) {
        let mut text = SCENES[scene].to_owned();
        for (at, put) in changes {
            // Only where a blank stands, so that most results can be read.
            let blanks: Vec<usize> = text.match_indices([' ', '\n']).map(|(i, _)| i).collect();
            text.insert_str(blanks[at.index(blanks.len())], put);
        }
        check(&text);
    }
}

/// Most of what the strategies make must be readable, or they test nothing.
#[test]
fn the_strategies_make_texts_that_can_be_read() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::deterministic();
    let readable = (0..200)
        .filter(|_| value().new_tree(&mut runner).is_ok_and(|v| format(&format!("let v = {}\n", v.current())).is_ok()))
        .count();
    assert!(readable > 100, "{readable} of 200");
}
