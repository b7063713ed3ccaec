//! The standard library is complete and says where it comes from; the vocabulary documents itself, and its defaults
//! are values of the language.

use std::collections::BTreeMap;
use trackbed::check::NoModules;
use trackbed::diag::{Code, FileId, render};
use trackbed::schema::{self, COMMON, Field, KINDS, Kind, Need, Role};
use trackbed::syntax::tree::{Declaration, Item, ValueKind};
use trackbed::{Compiled, compile};

/// Every declaration of the library, by module.
fn entries() -> Vec<(String, Declaration)> {
    let mut found = Vec::new();
    for file in std::fs::read_dir("stdlib").unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|e| e != "track") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let (tree, mistakes) = trackbed::syntax::parse(FileId(0), &text);
        assert!(mistakes.is_empty(), "{path:?}");
        let module = path.file_stem().unwrap().to_str().unwrap().to_string();
        for item in tree.items {
            if let Item::Declaration(declaration) = item {
                found.push((module.clone(), declaration));
            }
        }
    }
    found.sort_by_key(|(module, d)| (module.clone(), d.span.start));
    found
}

/// A scene in which one part is exchanged.
fn scene(kind: &str, entry: &str) -> String {
    let mut parts = BTreeMap::from([
        ("rail", "rails.UIC60"),
        ("pad", "pads.medium"),
        ("sleeper", "sleepers.B70"),
        ("usp", "none"),
        ("slab", "slabs.half_width_1600"),
        ("vehicle", "vehicles.ore_wagon_20t"),
        ("law", "laws.varandas_2014"),
        ("grading", "gradings.ballast_31_63"),
        ("granular", "ballasts.granite_31_63"),
        ("soil", "soils.sandy_gravel"),
    ]);
    assert!(parts.insert(kind, entry).is_some(), "a scene has no place for a {kind}");
    let part = |kind: &str| parts[kind];
    format!(
        "use std
granular under : {} {{ shape = spheres }}
granular sieved : ballasts.granite_31_63 {{ grading = {} }}
trackform open {{
  rail = {}, pad = {}, sleeper = {}, spacing = 0.6 m, support = {{ stiffness = 40 MN/m per seat }}, usp = {}
  layers = [under: 0.5 m, sieved: 0.5 m, {}: 2 m]
}}
trackform deck : open {{ sleeper = none, support = none, usp = none, slab = {} }}
track line {{ sections = [open: 90 m, deck: 60 m] }}
train one {{ vehicles = [{}: 2], speed = 60 km/h }}
traffic {{ trains = one, total = 400 axles }}
solve {{ law = {} }}
",
        part("granular"),
        part("grading"),
        part("rail"),
        part("pad"),
        part("sleeper"),
        part("usp"),
        part("soil"),
        part("slab"),
        part("vehicle"),
        part("law"),
    )
}

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn told(compiled: &Compiled) -> String {
    render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn has_errors(compiled: &Compiled) -> bool {
    codes(compiled).iter().any(|c| c.severity() == trackbed::diag::Severity::Error || *c == Code::E0410)
}

/// What is found, but for fields that are missing: a track alone is never complete.
fn codes(compiled: &Compiled) -> Vec<Code> {
    compiled.diagnostics.iter().map(|d| d.code).filter(|c| *c != Code::E0403).collect()
}

#[test]
fn every_entry_is_complete() {
    let entries = entries();
    assert!(entries.len() > 15);
    for (module, declaration) in entries {
        let name = declaration.name.as_ref().unwrap().text.clone();
        let compiled = compiled(&scene(&declaration.kind.text, &format!("{module}.{name}")));
        assert!(compiled.graph.is_some(), "{module}.{name}\n{}", told(&compiled));
    }
}

#[test]
fn every_entry_says_where_it_comes_from() {
    for (module, declaration) in entries() {
        let name = &declaration.name.as_ref().unwrap().text;
        let field = |wanted: &str| declaration.fields.iter().find(|f| f.path.text() == wanted).map(|f| &f.value.kind);
        match field("source") {
            Some(ValueKind::Text(source)) => assert!(source.len() > 10, "{module}.{name}: {source}"),
            _ => panic!("{module}.{name} has no source"),
        }
        let Some(ValueKind::Path(evidence)) = field("evidence") else { panic!("{module}.{name} has no evidence") };
        assert!(["read", "derived", "unchecked"].contains(&evidence.text().as_str()), "{module}.{name}");
        assert!(!declaration.docs.is_empty(), "{module}.{name} says in a line what it is");
    }
}

#[test]
fn every_module_is_brought_in_by_name() {
    for module in entries().into_iter().map(|(module, _)| module).collect::<std::collections::BTreeSet<_>>() {
        let compiled = compiled(&format!("use std.{module}\n"));
        assert!(compiled.diagnostics.is_empty(), "{module}: {}", told(&compiled));
    }
}

#[test]
fn the_page_of_a_kind_mentions_everything_about_it() {
    for kind in KINDS {
        let page = schema::page(kind);
        for field in kind.fields.iter().chain(COMMON) {
            assert!(page.contains(&format!("  {}", field.name)), "{} {}", kind.name, field.name);
            for word in field.form.words().into_iter().filter(|w| !w.planned) {
                assert!(page.contains(word.name), "{} {} {}", kind.name, field.name, word.name);
                for argument in word.arguments {
                    assert!(page.contains(argument.name), "{} {}", word.name, argument.name);
                }
            }
            if let Need::Default(text) = field.need {
                assert!(page.contains(&format!("default {text}")), "{} {}", kind.name, field.name);
            }
        }
        for planned in kind.planned {
            assert!(page.contains(planned), "{} {planned}", kind.name);
            assert!(kind.field(planned).is_none(), "{} {planned} is read and planned", kind.name);
        }
        for path in kind.alternatives.iter().flat_map(|a| a.ways.iter().copied().flatten()) {
            assert!(page.contains(path), "{} {path}", kind.name);
        }
    }
    let index = schema::index();
    assert!(KINDS.iter().all(|k| index.contains(k.name)));
}

/// Where a kind that only stands inside another is written.
fn inside(kind: &Kind, fields: &str) -> String {
    match (kind.role, kind.name) {
        (Role::Nested, "primary_suspension") => format!("vehicle v {{ primary = {{ {fields} }} }}\n"),
        (Role::Nested, "secondary_suspension") => format!("vehicle v {{ secondary = {{ {fields} }} }}\n"),
        (Role::Nested, "seating") => format!("support s {{ seating = {{ {fields} }} }}\n"),
        (Role::Nested, name @ ("packing" | "bond")) => format!("granular g {{ {name} = {{ {fields} }} }}\n"),
        (Role::Nested, "approach_slab") => format!("stretch s {{ approach_slab = {{ {fields} }} }}\n"),
        (Role::Nested, "auxiliary_rails") => format!("trackform t {{ auxiliary_rails = {{ {fields} }} }}\n"),
        (Role::Nested, name) => format!("vehicle v {{ {name} = {{ {fields} }} }}\n"),
        (_, name) => format!("{name} x {{ {fields} }}\n"),
    }
}

fn fits(kind: &Kind, fields: &str) {
    let compiled = compiled(&format!("use std\n{}", inside(kind, fields)));
    assert!(!has_errors(&compiled), "{}: {fields}\n{}", kind.name, told(&compiled));
}

#[test]
fn defaults_are_values_that_fit() {
    let mut seen = 0;
    let mut try_default = |kind: &Kind, field: &Field| {
        if let Need::Default(text) = field.need {
            fits(kind, &format!("{} = {text}", field.name));
            seen += 1;
        }
        for word in field.form.words().into_iter().filter(|w| !w.planned) {
            for argument in word.arguments {
                if let Need::Default(text) = argument.need {
                    fits(kind, &format!("{} = {}({} = {text})", field.name, word.name, argument.name));
                    seen += 1;
                }
            }
        }
    };
    for kind in KINDS {
        for field in kind.fields {
            try_default(kind, field);
        }
        for (field, text) in kind.alternatives.iter().filter_map(|a| a.default) {
            fits(kind, &format!("{field} = {text}"));
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn a_hole_names_what_belongs_there() {
    for kind in KINDS {
        for field in kind.fields {
            let text = inside(kind, &format!("{} = ?", field.name));
            let compiled = compiled(&format!("use std\n{text}"));
            // a response, a rule or a comparison is no value to be given later, but a hole there is not worse
            assert_eq!(codes(&compiled), [Code::E0410], "{text}{}", told(&compiled));
            let message = compiled.diagnostics.iter().find(|d| d.code == Code::E0410).map_or("", |d| &d.message);
            assert!(message.starts_with("`?` stands for ") && !message.ends_with([' ', ',']), "{message}");
        }
    }
}
