//! The parser on whole files: the scenes of the guide, planted mistakes, and texts that nobody would write.

use proptest::prelude::*;
use trackbed::diag::{Code, Diagnostic, FileId};
use trackbed::syntax::parse;
use trackbed::syntax::tree::{Declaration, Item, Tree, Value, ValueKind};

const SCENES: [(&str, &str); 6] = [
    ("box_test", include_str!("scenes/box_test.track")),
    ("bridge", include_str!("scenes/bridge.track")),
    ("static_check", include_str!("scenes/static_check.track")),
    ("transition", include_str!("scenes/transition.track")),
    ("usp", include_str!("scenes/usp.track")),
    ("wedge", include_str!("scenes/wedge.track")),
];

fn read(text: &str) -> (Tree, Vec<Diagnostic>) {
    parse(FileId(0), text)
}

/// The code and line of each mistake.
fn mistakes(text: &str) -> Vec<(Code, usize)> {
    let line = |d: &Diagnostic| text[..d.labels[0].span.start as usize].matches('\n').count() + 1;
    read(text).1.iter().map(|d| (d.code, line(d))).collect()
}

fn declaration<'t>(tree: &'t Tree, name: &str) -> &'t Declaration {
    let named = |item: &'t Item| match item {
        Item::Declaration(d) if d.name.as_ref().map_or(&d.kind, |n| n).text == name => Some(d),
        _ => None,
    };
    tree.items.iter().find_map(named).unwrap_or_else(|| panic!("no {name}"))
}

/// A value with its structure in parentheses and prefix operators.
fn shape(value: &Value) -> String {
    let list = |values: &mut dyn Iterator<Item = String>| values.collect::<Vec<_>>().join(" ");
    match &value.kind {
        ValueKind::Number { value, unit } => match unit {
            Some(unit) => format!("{value}<{}>", unit.text),
            None => format!("{value}"),
        },
        ValueKind::Text(text) => format!("{text:?}"),
        ValueKind::Hole => "?".to_owned(),
        ValueKind::List { entries, unit } => {
            let entry = |e: &trackbed::syntax::tree::Entry| match &e.key {
                Some(key) => format!("{}:{}", shape(key), shape(&e.value)),
                None => shape(&e.value),
            };
            let unit = unit.as_ref().map_or(String::new(), |u| format!("<{}>", u.text));
            format!("[{}]{unit}", list(&mut entries.iter().map(entry)))
        }
        ValueKind::Call { word, arguments } => {
            let argument = |a: &trackbed::syntax::tree::Argument| match &a.name {
                Some(name) => format!("{}={}", name.text, shape(&a.value)),
                None => shape(&a.value),
            };
            format!("{}({})", word.text, list(&mut arguments.iter().map(argument)))
        }
        ValueKind::Object { base, fields } => {
            let base = base.as_ref().map_or(String::new(), |b| b.text());
            let field = |f: &trackbed::syntax::tree::Field| format!("{}={}", f.path.text(), shape(&f.value));
            format!("{base}{{{}}}", list(&mut fields.iter().map(field)))
        }
        ValueKind::Path(path) => path.text(),
        ValueKind::Range(from, to) => format!("(.. {} {})", shape(from), shape(to)),
        ValueKind::Per(value, basis) => format!("(per {} {})", shape(value), basis.text),
        ValueKind::Binary(a, operator, b) => format!("({} {} {})", operator.symbol(), shape(a), shape(b)),
        ValueKind::Negate(value) => format!("(- {})", shape(value)),
        ValueKind::Compare { operands, operators } => {
            let operators = list(&mut operators.iter().map(|o| o.symbol().to_owned()));
            format!("({operators} | {})", list(&mut operands.iter().map(shape)))
        }
        ValueKind::Error => "ERROR".to_owned(),
    }
}

fn shape_of(value: &str) -> String {
    let text = format!("let v = {value}\n");
    let (tree, diagnostics) = read(&text);
    assert_eq!(diagnostics, [], "{value}");
    match &tree.items[..] {
        [Item::Let(only)] => shape(&only.value),
        other => panic!("{value}: {other:?}"),
    }
}

#[test]
fn the_scenes_of_the_guide_are_read_without_a_mistake() {
    for (name, text) in SCENES {
        let (tree, diagnostics) = read(text);
        assert_eq!(diagnostics, [], "{name}");
        assert!(tree.items.len() >= 7, "{name}");
        let windows = text.replace('\n', "\r\n");
        let (tree_of_windows, diagnostics) = read(&windows);
        assert_eq!(diagnostics, [], "{name} with CRLF");
        assert_eq!(tree.items.len(), tree_of_windows.items.len());
    }
    let (tree, _) = read(SCENES[3].1);
    let open = declaration(&tree, "open");
    assert_eq!(open.fields.len(), 6);
    assert_eq!(shape(&open.fields[1].value), "{stiffness=40<MN/m> damping=5<kN s/m>}");
    assert_eq!(shape(&open.fields[4].value), "[ballast:300<mm> subballast:300<mm> subgrade:1<m>]");
}

#[test]
fn operators_bind_as_the_guide_says() {
    for (text, expected) in [
        ("1 + 2 * 3 ^ 2", "(+ 1 (* 2 (^ 3 2)))"),
        ("1 - 2 - 3", "(- (- 1 2) 3)"),
        ("-2 ^ 2", "(- (^ 2 2))"),
        ("2 ^ 3 ^ 2", "(^ 2 (^ 3 2))"),
        ("2 ^ -1", "(^ 2 (- 1))"),
        ("+1", "1"),
        ("9.81 m/s^2 * wagon.bogie.mass", "(* 9.81<m/s^2> wagon.bogie.mass)"),
        ("5 m / 2", "(/ 5<m> 2)"),
        ("-count .. -1 sleepers", "(.. (- count) (- 1<sleepers>))"),
        ("0.25 .. 0.10 N/mm^3 per seat", "(per (.. 0.25 0.1<N/mm^3>) seat)"),
        ("-5 m < place_of_max(settlement) < -2.5 m", "(< < | (- 5<m>) place_of_max(settlement) (- 2.5<m>))"),
        ("a <= b", "(<= | a b)"),
        ("(1 + 2) * 3", "(* (+ 1 2) 3)"),
        ("clumps(2 .. 3, ratio = 0.8)", "clumps((.. 2 3) ratio=0.8)"),
        ("[0, 100, 500] axles", "[0 100 500]<axles>"),
        ("[a: 1 m, b.c: 2 .. 3 m]", "[a:1<m> b.c:(.. 2 3<m>)]"),
        ("pads.soft { stiffness = 60 MN/m }", "pads.soft{stiffness=60<MN/m>}"),
        ("[[], [wedge]]", "[[] [wedge]]"),
        ("?", "?"),
        ("\"a \\\"b\\\" \\\\\"", r#""a \"b\" \\""#),
        ("10_000 cycles", "10000<cycles>"),
        ("300mm", "300<mm>"),
        ("1.3e7", "13000000"),
        ("4 J/(kg K)", "4<J/(kg K)>"),
        ("1 m² + 2 m2 + 3 m^-1.5", "(+ (+ 1<m²> 2<m2>) 3<m^-1.5>)"),
        ("3 % + 2 µm", "(+ 3<%> 2<µm>)"),
        ("1 +\n 2 ..\n 3", "(.. (+ 1 2) 3)"),
        ("[\n 1\n 2,\n\n 3\n]", "[1 2 3]"),
        ("f(\n a = 1\n b = 2\n)", "f(a=1 b=2)"),
        ("useful + total + persons", "(+ (+ useful total) persons)"),
    ] {
        assert_eq!(shape_of(text), expected, "{text}");
    }
}

#[test]
fn spans_hold_exactly_what_they_name() {
    let text = "/// Soft.\n/// Very.\nsoil a : b.c { // x\n  /// Grain.\n  x = -2 mm + 3 m²   // y\n  y=[1, 2] mm\t\n}  // end\nuse a.b as c // z\n";
    let (tree, diagnostics) = read(text);
    assert_eq!(diagnostics, []);
    let of = |span: trackbed::diag::Span| &text[span.start as usize..span.end as usize];
    let soil = declaration(&tree, "a");
    assert_eq!(soil.docs, ["Soft.", "Very."]);
    assert!(of(soil.span).starts_with("soil a") && of(soil.span).ends_with('}'));
    assert_eq!(soil.base.as_ref().map(|b| of(b.span)), Some("b.c"));
    assert_eq!(soil.fields[0].docs, ["Grain."]);
    assert_eq!(of(soil.fields[0].span), "x = -2 mm + 3 m²");
    assert_eq!(of(soil.fields[1].span), "y=[1, 2] mm");
    let ValueKind::Binary(left, _, right) = &soil.fields[0].value.kind else { panic!() };
    assert_eq!((of(left.span), of(right.span)), ("-2 mm", "3 m²"));
    let ValueKind::List { unit: Some(unit), .. } = &soil.fields[1].value.kind else { panic!() };
    assert_eq!(of(unit.span), "mm");
    let Item::Use(import) = &tree.items[1] else { panic!() };
    assert_eq!(of(import.span), "use a.b as c");
}

/// Mistakes that each fill their own lines in a block, with the codes they are due and, if any, their help.
const PLANTED: [(&str, Code, Option<&str>); 22] = [
    ("a = 0,3 m", Code::E0105, Some("write `0.3 m`")),
    ("a := 3 m", Code::E0105, Some("write `a = 3 m`")),
    ("a => 3 m", Code::E0105, Some("write `a = 3 m`")),
    ("a : 3 m", Code::E0105, Some("write `a = 3 m`")),
    ("a = 3 m;", Code::E0105, Some("write `a = 3 m`")),
    ("a = 3 m # why", Code::E0105, Some("write `// why`")),
    ("a = 'text'", Code::E0105, Some("write `\"text\"`")),
    ("a = 1 /* why */", Code::E0105, Some("write `// why`, with nothing behind it on its line")),
    ("a { b = 1 }", Code::E0105, Some("write `a = { b = 1 }`")),
    ("a = 1 to 2 m", Code::E0105, Some("write `1 .. 2 m`")),
    ("a = .5 m", Code::E0105, Some("write `0.5 m`")),
    ("a = [b = 1 m]", Code::E0105, Some("write `b: 1 m`")),
    ("a = f(b: 1 m)", Code::E0105, Some("write `b = 1 m`")),
    ("a = 2 * * 3", Code::E0101, None),
    ("a 3 m", Code::E0101, Some("write `a = 3 m`")),
    ("a =", Code::E0101, None),
    ("a = { b = 1, c = * }", Code::E0101, None),
    ("a = [1, 2", Code::E0104, None),
    ("a = f(1, 2", Code::E0104, None),
    ("a = [1, 2)", Code::E0104, Some("write `]` instead of `)`")),
    ("a = \"text", Code::E0106, Some("write `\"text\"`")),
    ("a = 3 m^12", Code::E0103, None),
];

#[test]
fn each_planted_mistake_is_found_alone_at_its_line_with_its_help() {
    for (mistake, code, help) in PLANTED {
        let text = format!("soil a {{\n  x = 1\n  {mistake}\n  y = 2\n}}\nlet z = 3\n");
        assert_eq!(mistakes(&text), [(code, 3)], "{mistake}");
        let (tree, diagnostics) = read(&text);
        assert_eq!(diagnostics[0].help.as_deref().filter(|_| help.is_some()), help, "{mistake}");
        let paths: Vec<String> = declaration(&tree, "a").fields.iter().map(|f| f.path.text()).collect();
        assert_eq!(paths, ["x", "a", "y"], "{mistake}: nothing else is lost");
        assert_eq!(tree.items.len(), 2, "{mistake}");
    }
}

#[test]
fn two_planted_mistakes_are_both_found() {
    for (first, first_code, _) in PLANTED {
        for (second, second_code, _) in PLANTED {
            let text = format!("soil a {{\n  {first}\n  x = 1\n  {second}\n}}\nsoil b {{\n  {first}\n}}\n");
            let expected = [(first_code, 2), (second_code, 4), (first_code, 7)];
            assert_eq!(mistakes(&text), expected, "{text}");
        }
    }
}

#[test]
fn all_planted_mistakes_together_are_all_found() {
    let mut text = "soil a {\n".to_owned();
    let mut expected = Vec::new();
    for (i, (mistake, code, _)) in PLANTED.iter().enumerate() {
        text.push_str(&format!("  {mistake}\n  x{i} = 1\n"));
        expected.push((*code, 2 + 2 * i));
    }
    text.push_str("}\nsoil b { x = }\n");
    expected.push((Code::E0101, 3 + 2 * PLANTED.len()));
    assert_eq!(mistakes(&text), expected, "{text}");
}

#[test]
fn mistakes_between_declarations_leave_the_others_alone() {
    for (mistake, code) in [
        ("soil a = soils.sand", Code::E0105),
        ("x = 3 m", Code::E0105),
        ("soil a b { x = 1 }", Code::E0101),
        ("soil a", Code::E0101),
        ("let x 3", Code::E0101),
        ("let x =", Code::E0101),
        ("use 3", Code::E0101),
        ("let per = 3", Code::E0207),
        ("soil a { x = 1 }}", Code::E0104),
        ("soil a {\n  x = 1", Code::E0104),
        ("soil a {\n  b = {\n    x = 1\n}", Code::E0104),
        ("?", Code::E0101),
        ("soil a : { x = 1 }", Code::E0101),
    ] {
        let text = format!("use std\n{mistake}\nsoil b {{ y = * }}\nlet d = 2\n");
        let found = mistakes(&text);
        assert_eq!(found.len(), 2, "{text}{found:?}");
        assert_eq!(found[0].0, code, "{text}");
        let (tree, _) = read(&text);
        assert_eq!(declaration(&tree, "b").fields.len(), 1);
        assert!(matches!(tree.items.last(), Some(Item::Let(_))), "{text}");
    }
}

#[test]
fn what_is_broken_stays_in_the_tree_as_an_error() {
    let (tree, _) = read("soil a { x = * 3, y = 3 ), z = [1, *, 3], w = 0,3 m }");
    let shapes: Vec<String> =
        declaration(&tree, "a").fields.iter().map(|f| format!("{}={}", f.path.text(), shape(&f.value))).collect();
    assert_eq!(shapes, ["x=ERROR", "y=3", "z=[1 ERROR 3]", "w=ERROR"]);
}

#[test]
fn empty_files_are_fine() {
    for text in ["", "\n", "// only a comment", "\r\n\r\n", "  \t ", ",\n,"] {
        let (tree, diagnostics) = read(text);
        assert_eq!((tree.items.len(), diagnostics.len()), (0, 0), "{text:?}");
    }
}

#[test]
fn the_bounds_are_kept() {
    let nested = |n: usize| format!("let a = {}1{}", "[".repeat(n), "]".repeat(n));
    assert_eq!(mistakes(&nested(64)), []);
    assert_eq!(mistakes(&nested(65)), [(Code::E0103, 1)]);
    assert_eq!(mistakes(&"(".repeat(1 << 20)), [(Code::E0103, 1)]);
    assert_eq!(mistakes(&format!("let a = {}1", "2 ^ ".repeat(65))), [(Code::E0103, 1)]);
    assert_eq!(mistakes(&format!("let a = {}1", "2 ^ ".repeat(64))), []);
    assert_eq!(mistakes(&format!("let a = {}1", "1 m^2 + ".repeat(200))), []);
    assert_eq!(mistakes(&format!("let a = {}1", "1 + ".repeat(600))), [(Code::E0103, 1)]);
    assert_eq!(mistakes("let a = 1e999"), [(Code::E0103, 1)]);
    assert_eq!(mistakes("let a = 2 ^ 10"), [(Code::E0103, 1)]);
    assert_eq!(mistakes(&" ".repeat((8 << 20) + 1)), [(Code::E0103, 1)]);
    let (tree, diagnostics) = read(&"soil { }\n".repeat(100_001));
    assert_eq!((tree.items.len(), diagnostics.len(), diagnostics[0].code), (100_000, 1, Code::E0103));
    let (_, diagnostics) = read(&"let a = *\n".repeat(2000));
    assert_eq!(diagnostics.len(), 501);
}

/// A grammar that reads a part twice per level would need longer than the age of the universe.
#[test]
fn deep_nesting_is_read_once() {
    let pairs = [
        ("[", "]"),
        ("(", ")"),
        ("{ a = ", "}"),
        ("f(", ")"),
        ("f(a = ", ")"),
        ("[a: ", "]"),
        ("-(", ")"),
        ("{ a ", "}"),
        ("{ a : ", "}"),
        ("{ a b ", "}"),
        ("[k = ", "]"),
        ("{ a = 3 ", "* }"),
        ("[1 ", "]"),
        ("f(* ", ")"),
        ("1 .. [", "] per x *"),
        ("1 m (", ")"),
        ("a { b = [", "] }"),
        ("[{ a = (", ")}]"),
    ];
    for (open, close) in pairs {
        let levels = 60 / open.matches(['(', '[', '{']).count();
        for inside in ["1", "*", "1 2", "", "\"", "]"] {
            read(&format!("let v = {}{inside}{}\n", open.repeat(levels), close.repeat(levels)));
            read(&format!("let v = {}{inside}{}\nlet w = 1", open.repeat(levels), close.repeat(levels / 2)));
        }
    }
}

#[test]
fn odd_bytes_by_the_kilobyte_end_in_diagnostics() {
    for unit in
        ["(", "{", "a {", ")", "}", "^", "2^-", "-", "\0", "'", "\"", "„", "/* \n", "# ", ";", "soil a {\n", "a."]
    {
        let text = unit.repeat(20_000 / unit.len());
        assert!(!read(&text).1.is_empty(), "{unit:?}");
    }
}

#[test]
fn ten_thousand_lines_are_read_at_once() {
    let scene = format!("{}\n", SCENES[3].1);
    let text = scene.repeat(10_000 / scene.lines().count() + 1);
    let start = std::time::Instant::now();
    let (tree, diagnostics) = read(&text);
    println!("{} lines in {:?}", text.lines().count(), start.elapsed());
    assert_eq!(diagnostics, []);
    assert!(tree.items.len() > 3000);
}

fn inside(text: &str, diagnostics: &[Diagnostic]) {
    for label in diagnostics.iter().flat_map(|d| &d.labels) {
        let (start, end) = (label.span.start as usize, label.span.end as usize);
        assert!(text.get(start..end).is_some(), "{label:?} in {text:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_text_is_survived(text in "\\PC*") {
        inside(&text, &read(&text).1);
    }

    #[test]
    fn any_soup_of_tokens_is_survived(tokens in prop::collection::vec(prop::sample::select(vec![
        "{", "}", "[", "]", "(", ")", "=", ":", "..", "^", "-", "*", "/", ",", "\n", "\r\n", "soil", "a", "use ", "let ", " per ", " as ",
        "1", "0.5", ".5", "5.", " mm", "m^2", "\"t\"", "\"", "'", "//", "///", "/*", "*/", "#", ";", "=>", ":=", "?", "≤", "“", "\u{a0}", "é", " ",
        "\nsoil b {", "x = ", " to ", "<", "%", "²", "_", "\\", ".", "a.b", "0,3 m",
    ]), 0..60)) {
        let text = tokens.concat();
        inside(&text, &read(&text).1);
    }

    #[test]
    fn mutated_scenes_are_survived(
        scene in 0..SCENES.len(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, "[\\[\\](){}=:,;\"'#\n^*/. a1é-]{0,3}"), 1..6),
    ) {
        let mut text: Vec<char> = SCENES[scene].1.chars().collect();
        for (at, cut, put) in cuts {
            let at = at.index(text.len());
            let end = (at + cut).min(text.len());
            text.splice(at..end, put.chars());
        }
        let text: String = text.into_iter().collect();
        inside(&text, &read(&text).1);
    }
}
