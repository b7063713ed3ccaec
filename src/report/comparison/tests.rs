//! Pages of comparisons.

use super::*;
use crate::compare::{Content, Made, edits, numbers, points, seat_differences};
use crate::results::{Run, example};
use std::path::PathBuf;

fn compared(runs: Vec<(&str, Run)>) -> Comparison {
    let subject = |(name, run): (&str, Run)| Subject {
        name: name.to_owned(),
        path: PathBuf::from(name),
        made: Made {
            title: run.scenario.title.clone(),
            version: "0.1.0".to_owned(),
            file: "scene.track".to_owned(),
            sha256: "0123456789abcdef".to_owned(),
            seed: Some(1),
        },
        resolved: Some(format!("track line {{ sections = [{name}: 42 m] }}\n")),
        content: Content::Run(Box::new(run)),
    };
    let subjects: Vec<Subject> = runs.into_iter().map(subject).collect();
    let (numbers, seats, points) = (numbers(&subjects), seat_differences(&subjects), points(&subjects));
    Comparison { kind: Kind::Run, edits: edits(&subjects), numbers, seats, points, subjects }
}

#[test]
fn the_page_shows_every_run_in_every_figure() {
    let (run, mut stiff) = (example::transition(), example::transition());
    stiff.sleepers.iter_mut().for_each(|row| row.settlement_m *= 0.5);
    stiff.summary.scalars.get_mut("max_settlement").unwrap().value *= 0.5;
    let comparison = compared(vec![("<soft>", run), ("stiff", stiff)]);
    let ids: Vec<String> = figures(&comparison).into_iter().map(|figure| figure.id).collect();
    assert!(["settlement", "rail_seat_load", "rail_level"].iter().all(|id| ids.contains(&(*id).to_owned())), "{ids:?}");
    for figure in figures(&comparison) {
        let document = roxmltree::Document::parse(&figure.svg).unwrap_or_else(|e| panic!("{}: {e}", figure.id));
        let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
        assert!(texts.contains(&"<soft>") && texts.contains(&"stiff"), "{}: {texts:?}", figure.id);
    }
    let page = comparison_page(&comparison);
    assert!(page.contains("&lt;soft&gt;") && !page.contains("<soft>"));
    assert!(page.contains("(\u{2212}50 %)") && page.contains("line.sections") && page.ends_with("</html>\n"));
    let shown = &page[..page.find("<script>").unwrap()];
    assert!(!shown.contains("NaN"));
}
