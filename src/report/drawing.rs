//! A scene before it runs, to be looked at: the track to scale, its layers, its cross-sections, their gradings and their grains.

use super::scene::draw_scene;
use super::svg::Svg;
use super::view::WIDTH;
use super::{cross_section, gradings, layers, templates};
use crate::scenario::Scenario;

/// Fields that only drawings read.
pub const DRAWN: &[&str] = &["rail.height", "usp.thickness"];

/// Everything that can be drawn of a scene, one below the other, as one picture that is valid on its own.
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
