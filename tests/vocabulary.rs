//! `trackbed docs`: the vocabulary by name and by word, as text and as data.

use serde_json::Value;

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

fn told(arguments: &[&str]) -> String {
    let output = trackbed(&[&["docs"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

fn data(arguments: &[&str]) -> Value {
    serde_json::from_str(&told(&[arguments, &["--format", "json"]].concat())).unwrap()
}

#[test]
fn a_module_lists_its_entries_and_an_entry_its_numbers() {
    let module = told(&["usps"]);
    for entry in ["usps.stiff", "usps.medium", "usps.soft", "usps.polyurethane"] {
        assert!(module.contains(entry), "{module}");
    }
    let entry = told(&["usps.medium"]);
    for part in ["bedding_modulus = 0.20 N/mm^3", "evidence: unchecked", "source: middle of the class", "usps.medium {"]
    {
        assert!(entry.contains(part), "{part} is missing:\n{entry}");
    }
    // what it extends is there too
    let wagon = told(&["vehicles.ore_wagon_20t"]);
    assert!(
        wagon.contains("axle_load = 20 t") && wagon.contains("ore_wagon_30t") && wagon.contains("spacing = 6.77 m"),
        "{wagon}"
    );
}

#[test]
fn kinds_fields_responses_and_codes_have_pages() {
    assert!(told(&["usp"]).contains("bedding_modulus"));
    assert!(told(&["usp.bedding_modulus"]).contains("N/mm^3"));
    assert!(told(&["settlement_step"]).contains("tables in m"));
    assert_eq!(told(&["E0302"]), String::from_utf8(trackbed(&["explain", "E0302"]).stdout).unwrap());
}

#[test]
fn a_word_finds_kinds_fields_the_library_and_codes() {
    let found = told(&["bedding"]);
    for name in ["usp.bedding_modulus", "Fields"] {
        assert!(found.contains(name), "{name} is missing:\n{found}");
    }
    // two words must both be there, and a kind's own name can be searched for
    assert!(told(&["--search", "bedding modulus"]).contains("usp.bedding_modulus"));
    let sleepers = told(&["--search", "sleeper"]);
    for heading in ["Kinds", "Fields", "Entries of the standard library", "Responses", "Codes"] {
        assert!(sleepers.contains(heading), "{heading} is missing:\n{sleepers}");
    }
    let names = data(&["bedding"]);
    let names: Vec<&str> =
        names["found"].as_array().unwrap().iter().filter_map(|topic| topic["name"].as_str()).collect();
    assert!(names.contains(&"bedding_modulus"), "{names:?}");
}

#[test]
fn the_whole_vocabulary_is_data() {
    let all = data(&[]);
    let named = |list: &str, name: &str| {
        let list = all[list].as_array().unwrap();
        list.iter().find(|entry| entry["name"] == name).cloned().unwrap_or_else(|| panic!("{name} is missing"))
    };
    let usp = named("kinds", "usp");
    let modulus = usp["fields"].as_array().unwrap().iter().find(|field| field["name"] == "bedding_modulus").unwrap();
    assert_eq!(modulus["unit"], "N/mm^3");
    assert!(modulus["range"][0].as_f64() < modulus["range"][1].as_f64());
    assert_eq!(named("library", "usps.medium")["fields"]["bedding_modulus"], "0.20 N/mm^3");
    assert_eq!(named("responses", "settlement")["unit"], "m");
    assert_eq!(named("codes", "L1001")["rule"], "stiffness_jump");
    assert_eq!(data(&["usps.medium"])["topic"], "entry");
    assert_eq!(data(&["usps"])["entries"].as_array().unwrap().len(), 5);
}

#[test]
fn a_word_that_nothing_has_is_an_error_with_a_way_out() {
    let output = trackbed(&["docs", "sleper"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("did you mean `sleeper`?"), "{}", said(&output));
    let output = trackbed(&["docs", "--search", "xyzzy"]);
    assert_eq!(output.status.code(), Some(2));
    let output = trackbed(&["docs", "usps", "--format", "markdown"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}
