//! What a run's answers rest on is said beside them: in `summary.json` and on the first page.

use std::process::Command;

const SCENE: &str = r#"use std
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform bridge : open { support.stiffness = 120 MN/m per seat }
track line { sections = [open: 21 m, bridge: 21 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }
traffic { trains = ore, total = 40 axles }
solve { law = [laws.varandas_2014, laws.nasrollahi_2023], update_every = 20 axles, elements_per_bay = 2, time_step = 2e-4 s }
scenario { allow = [stiffness_jump: "to be seen"] }
"#;

#[test]
fn warnings_assumptions_and_spread_stand_on_the_first_page() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.track");
    std::fs::write(&scene, SCENE).unwrap();
    let out = folder.path().join("out");
    let run =
        Command::new(env!("CARGO_BIN_EXE_trackbed")).arg("run").arg(&scene).arg("--out").arg(&out).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let summary: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap();
    let reliance = &summary["reliance"];
    let texts = |group: &str, field: Option<&str>| -> Vec<String> {
        let list = reliance[group].as_array().unwrap_or_else(|| panic!("{reliance}"));
        list.iter().map(|item| field.map_or(item, |field| &item[field]).as_str().unwrap().to_owned()).collect()
    };
    // the warnings are those of `check`, with their lines
    let check = Command::new(env!("CARGO_BIN_EXE_trackbed")).arg("check").arg(&scene).output().unwrap();
    let said = String::from_utf8_lossy(&check.stderr).to_string() + &String::from_utf8_lossy(&check.stdout);
    let codes = texts("warnings", Some("code"));
    assert!(codes.contains(&"L1034".to_owned()), "{codes:?}");
    assert!(codes.iter().all(|code| said.contains(code.as_str())), "{codes:?}\n{said}");
    assert_eq!(codes.len(), said.matches("warning L").count() + said.matches("warning E").count(), "{said}");
    assert!(texts("warnings", Some("place")).iter().any(|place| place.starts_with("scene.track:")));
    assert_eq!(texts("silenced", Some("reason")), ["to be seen"]);
    // the spread is that of the tables
    let spread = summary["law_spread"]["value"].as_f64();
    let first = &texts("confidence", None)[0];
    match spread {
        Some(_) => {
            assert!(first.starts_with("ratio of the largest to the smallest settlement of the 2 laws: "), "{first}")
        }
        None => assert!(first.contains("differ by a factor of ten"), "{first}"),
    }
    let assumed = texts("assumptions", None).join("\n");
    for text in [
        "from the force on its own ballast",
        "springs of 50 to 120 MN/m",
        "level as built",
        "part of each train",
        "3 passages represent 10 trains",
    ] {
        assert!(assumed.contains(text), "{text}: {assumed}");
    }
    assert!(texts("unchecked", Some("name")).iter().any(|name| name == "sleepers.B70"), "{reliance}");
    // the page says the same before its contents
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    let (start, end) = (page.find("Before these numbers are used").unwrap(), page.find("id=\"contents\"").unwrap());
    let section = &page[start..end];
    for text in ["L1034", "scene.track:", "to be seen", "sleepers.B70", "level as built"] {
        assert!(section.contains(text), "{text}: {section}");
    }
    // and the headline says why the structure lies lower
    assert!(summary["settlement_step"]["value"].as_f64().unwrap() < 0.0);
    assert!(page[..start].contains("does not model the subgrade"), "{}", &page[..start]);
}
