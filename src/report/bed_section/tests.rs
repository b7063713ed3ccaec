//! Sections of beds, read back as XML.

use super::*;
use crate::results::{Grain, example};

fn beds(axles: u64, moved: f64) -> BedsAtCount {
    let grain = |k: u32| Grain {
        place: [-6.0 + 0.05 * f64::from(k), 0.75, -0.1],
        radius: 0.025,
        body: k,
        velocity: [0.0; 3],
        displacement: Some([0.0, 0.0, -moved]),
        coordination: 2,
        largest_force: 100.0,
    };
    let grains: Vec<Grain> = (0..120).map(grain).collect();
    let link = |pair: &[Grain]| Link {
        from: pair[0].place,
        to: pair[1].place,
        bodies: (pair[0].body, Some(pair[1].body)),
        force: [100.0 + f64::from(pair[0].body), 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
        overlap: 1e-6,
    };
    let links = grains.windows(2).map(link).collect();
    BedsAtCount { axles, under_train: false, grains, links }
}

#[test]
fn each_count_is_a_layer_and_the_last_one_is_shown() {
    let mut run = example::transition();
    let counts: std::collections::BTreeSet<u64> = run.sleepers.iter().map(|row| row.axles).collect();
    run.beds = counts.iter().map(|axles| beds(*axles, 1e-6 * *axles as f64)).collect();
    let last = *counts.last().unwrap();
    run.beds.insert(counts.len() - 1, BedsAtCount { under_train: true, ..beds(0, 0.0) });
    assert!(run.beds.iter().any(|beds| beds.axles == last && !beds.under_train));
    let figure = bed_section(&run).unwrap();
    // forces under a train where they are known, of the bed at rest elsewhere
    assert_eq!(figure.svg.matches("under the leading bogie of the next train").count(), 1);
    assert_eq!(figure.svg.matches("Contact forces without a train").count(), counts.len() - 1);
    let document = roxmltree::Document::parse(&figure.svg).unwrap();
    let layers: Vec<_> = document.descendants().filter(|node| node.attribute("class") == Some("layer")).collect();
    assert_eq!(layers.len(), counts.len());
    assert!(layers.iter().rev().skip(1).all(|layer| layer.attribute("display") == Some("none")));
    assert_eq!(layers.last().unwrap().attribute("display"), None);
    for layer in layers {
        let count = |name: &str| layer.descendants().filter(|node| node.has_tag_name(name)).count();
        assert_eq!(count("circle"), 120);
        let sleepers = layer.descendants().filter(|node| node.attribute("class") == Some("sleeper")).count();
        assert_eq!(sleepers, 10, "6 m of sleepers 0.6 m apart");
    }
    // sleeper -3 hangs in the example
    let void = document.descendants().filter(|node| node.attribute("class") == Some("void"));
    assert!(void.filter_map(|node| node.attribute("height")).any(|height| height.parse::<f64>().unwrap() > 1.0));
    assert!(figure.caption.contains("the void is enlarged"), "{}", figure.caption);
    assert!(figure.svg.contains("[&quot;as built&quot;,"), "the script reads the counts");
}

#[test]
fn a_track_without_grains_has_no_section() {
    assert_eq!(bed_section(&example::transition()), None);
}
