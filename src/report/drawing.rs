//! Drawings of a scene before it runs: the track to scale, its layers, its cross-sections, their gradings and their
//! grains.

use super::scene::draw_scene;
use super::svg::Svg;
use super::view::WIDTH;
use super::{Figure, cross_section, gradings, layers, templates};
use crate::scenario::Scenario;

/// Fields that only drawings read.
pub const DRAWN: &[&str] = &["rail.height", "usp.thickness"];

/// All drawings of a scene, one below the other, as one complete picture.
pub fn drawing_svg(scenario: &Scenario) -> String {
    let mut svg = Svg::default();
    let mut y = draw_scene(&mut svg, scenario);
    for draw in [layers::draw, cross_section::draw, gradings::draw, templates::draw] {
        let mut height = 0.0;
        svg.group(&format!(r#"transform="translate(0 {y:.1})""#), |svg| height = draw(svg, scenario));
        y += height;
    }
    svg.finish(WIDTH, y, &format!("{}: the scene to scale", scenario.title))
}

/// The drawings of the ground under the track, as figures of a report: the layers along it, and sections across it.
pub(super) fn ground_figures(scenario: &Scenario) -> Vec<Figure> {
    let figure = |draw: fn(&mut Svg, &Scenario) -> f64, [id, title, caption]: [&str; 3]| {
        let mut svg = Svg::default();
        let height = draw(&mut svg, scenario);
        let svg = svg.finish(WIDTH, height, title);
        let figure = Figure { id: id.to_owned(), title: title.to_owned(), caption: caption.to_owned(), svg };
        (height > 0.0).then_some(figure)
    };
    let along = [
        "layers",
        "The layers along the track",
        "To scale: each transition, with the stretches near it that change the layers. Shown are thickness and Young's \
         modulus of each layer, wedges, approach slabs and under sleeper pads. Thin pads are drawn thicker, so that \
         they can be seen.",
    ];
    let across = [
        "cross_sections",
        "Sections across the track",
        "To scale: each type of sleeper on each type of ground, at the sleeper of this type nearest to a transition.",
    ];
    [figure(layers::draw, along), figure(cross_section::draw, across)].into_iter().flatten().collect()
}
