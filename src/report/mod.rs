//! Pictures and pages of a run: the scene to scale, and results along the track, in time and against the axles.
//!
//! [`page`] is the whole report in one file without external parts; [`figures`] are its pictures, each a complete SVG;
//! [`drawing_svg`] draws a scene that has not been run. Nothing here computes physics: the numbers are those of the
//! run's tables.

mod along;
mod ballast_response;
mod bed;
mod bed_section;
mod bed_tests;
mod blocks;
mod chart;
mod check;
mod colour_map;
mod comparison;
mod counts;
mod cross_section;
mod curves;
mod drawing;
mod exchange_map;
mod exchanges;
mod gradings;
mod grain;
mod grain_map;
mod hanging;
mod headline;
mod histories;
mod laws;
mod layers;
mod level;
mod limits;
mod moments;
mod number;
mod over_axles;
mod packed;
mod packed_readings;
mod packings;
mod page;
mod panels;
mod pebbles;
mod plane;
mod pressure;
mod prose;
mod readings;
mod reference;
mod reliance;
mod runs_chart;
mod scene;
mod seat_clock;
mod series;
mod specimens;
mod stability;
mod stiffness;
mod study;
mod svg;
mod symbols;
mod table;
mod templates;
mod thin;
mod vehicle;
mod view;
mod vocabulary;
mod wheels;
mod work_precision;

pub use bed::{BedView, Colour, Side, bed_svg};
pub use bed_tests::BedTestsPage;
pub use comparison::comparison_page;
pub use drawing::{DRAWN, drawing_svg};
pub use exchange_map::exchange_map_svg;
pub use grain_map::grain_map_svg;
pub use packed::BedPage;
pub use page::{page, page_so_far, standing};
pub use pebbles::{PebbleRow, grain_pebbles_svg};
pub use reference::reference;
pub use runs_chart::{runs_chart_page, runs_chart_svg};
pub use scene::scene_svg;
pub use specimens::{Fitted, specimens_svg};
pub use stability::stability_svg;
pub use study::study_page;
pub use templates::grain_templates_svg;
pub use vocabulary::{Topic, listing, nearest_topic, vocabulary};
pub use work_precision::chart_svg;

use crate::results::Run;
use crate::scenario::Loading;

/// One picture of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Short name, fit for a file name and an anchor.
    pub id: String,
    pub title: String,
    /// Description of the picture, in a sentence or two.
    pub caption: String,
    /// A whole SVG document with its own style, light and dark.
    pub svg: String,
}

/// Every picture that the run has data for, in reading order.
pub fn figures(run: &Run) -> Vec<Figure> {
    let scene = Figure {
        id: "scene".to_owned(),
        title: "The scene".to_owned(),
        caption:
            "Places, spacings, sleepers, rail, wheels and bogies are to scale. The depth of the bed, the car body \
                  and the springs are symbols."
                .to_owned(),
        svg: scene_svg(&run.scenario),
    };
    let mut figures = vec![scene];
    figures.extend(drawing::ground_figures(&run.scenario));
    if matches!(run.scenario.loading, Some(Loading::Static(_))) {
        figures.extend(
            [along::rail_displacement(run), along::rail_moment(run), along::seat_shares(run)].into_iter().flatten(),
        );
    } else {
        let along = [
            over_axles::over_axles(run),
            bed_section::bed_section(run),
            stiffness::rail_stiffness(run),
            along::settlement(run),
            exchanges::settlement_with_axles(run),
            along::rail_level(run),
            level::level_d1(run),
            along::gravity_contact(run),
            pressure::contact_pressure(run),
            along::seat_loads(run),
            moments::rail_moments(run),
            wheels::wheel_force(run),
            blocks::lengths(run),
        ];
        figures.extend(along.into_iter().flatten());
        figures.extend(laws::spread(run));
        figures.extend(check::checked(run));
    }
    figures.extend(histories::histories(run));
    figures.extend(hanging::hanging_sleeper(run));
    figures.extend(ballast_response::ballast_response(run));
    figures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    fn check_svg(figure: &Figure) {
        let document = roxmltree::Document::parse(&figure.svg).unwrap_or_else(|e| panic!("{}: {e}", figure.id));
        assert_eq!(document.root_element().tag_name().name(), "svg");
        let drawn: String = document
            .descendants()
            .flat_map(|node| node.attributes().map(|a| a.value()).chain(node.text()).collect::<Vec<_>>())
            .filter(|text| *text != svg::STYLE)
            .collect();
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{}", figure.id);
    }

    #[test]
    fn every_figure_of_a_passage_is_valid() {
        let figures = figures(&example::transition());
        let ids: Vec<&str> = figures.iter().map(|figure| figure.id.as_str()).collect();
        let expected = [
            "scene",
            "cross_sections",
            "over_axles",
            "rail_stiffness",
            "settlement",
            "settlement_with_axles",
            "rail_level",
            "longitudinal_level",
            "gravity_contact_force",
            "contact_pressure",
            "rail_seat_load",
            "rail_moment",
            "wheel_force",
            "block_lengths",
            "history_rail_seat_load",
            "history_rail_displacement",
            "hanging_sleeper",
        ];
        assert_eq!(ids, expected);
        figures.iter().for_each(check_svg);
    }

    #[test]
    fn every_figure_of_a_static_check_is_valid() {
        let figures = figures(&example::bench());
        let ids: Vec<&str> = figures.iter().map(|figure| figure.id.as_str()).collect();
        assert_eq!(ids, ["scene", "cross_sections", "rail_displacement", "rail_moment", "seat_shares"]);
        figures.iter().for_each(check_svg);
    }

    #[test]
    fn a_run_without_data_has_its_drawings_only() {
        let mut run = example::transition();
        run.sleepers.clear();
        run.rail.clear();
        run.histories.clear();
        run.blocks.clear();
        let ids: Vec<String> = figures(&run).into_iter().map(|figure| figure.id).collect();
        assert_eq!(ids, ["scene", "cross_sections"]);
        let empty = page(&run);
        assert!(empty.contains("</html>"));
    }

    #[test]
    fn the_page_is_small_escaped_and_alone() {
        let mut run = example::transition();
        run.scenario.title = "<b>\"A & B\"</b>".to_owned();
        run.sleepers[7].settlement_m = f64::NAN;
        let page = page(&run);
        assert!(page.len() < 1_500_000, "{}", page.len());
        assert!(page.contains("&lt;b&gt;&quot;A &amp; B&quot;&lt;/b&gt;") && !page.contains("<b>\"A"));
        let shown = &page[..page.find("<script>").unwrap()];
        assert!(!shown.contains("NaN") && !shown.contains(">inf"));
        let outside = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!outside.contains("http") && !outside.contains(" src=") && !outside.contains("url(\""));
        let ids: Vec<&str> = page.split(" id=\"").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
        // every entry of the contents leads somewhere
        let entries: Vec<&str> = page.split("href=\"#").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
        assert!(entries.len() > 10 && entries.iter().all(|entry| ids.contains(entry)), "{entries:?}");
        let mut unique = ids.clone();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(ids.len(), unique.len());
    }

    /// The text of a picture, piece by piece.
    fn said(figure: &Figure) -> Vec<String> {
        let document = roxmltree::Document::parse(&figure.svg).unwrap();
        document.descendants().filter(|node| node.is_text()).filter_map(|node| node.text()).map(str::to_owned).collect()
    }

    #[test]
    fn figures_name_what_they_show() {
        let figures = figures(&example::transition());
        let of = |id: &str| figures.iter().find(|figure| figure.id == id).unwrap();
        let has = |id: &str, text: &str| said(of(id)).iter().any(|piece| piece == text);
        // axes with units, counts, seats and the second scale of stress
        assert!(
            has("rail_stiffness", "Static stiffness at rail level [MN/m]") && has("rail_stiffness", "after 500 axles")
        );
        assert!(has("rail_stiffness", "Seat") && has("rail_stiffness", "\u{2212}10") && has("rail_stiffness", "+10"));
        assert!(has("rail_moment", "Foot stress [MPa]") && has("rail_moment", "Rail moment without a vehicle [kN m]"));
        assert!(has("contact_pressure", "500 kPa, concrete sleepers (UIC, unchecked)"));
        assert!(has("wheel_force", "Wheel 4 [kN]"));
        assert!(has("hanging_sleeper", "\u{2212}3: contact force [kN]"));
        assert!(has("hanging_sleeper", "\u{2212}13: contact force [kN]"));
        // contact is lost at sleeper -3, and the picture is shaded there
        assert!(of("hanging_sleeper").svg.contains(r#"class="lost""#));
        assert!(of("longitudinal_level").caption.contains("alert from 7.0 to 12 mm"));
        // settlement over axles and over their logarithm, a symbol for each exchange
        assert_eq!(said(of("settlement_with_axles")).iter().filter(|piece| *piece == "Axles").count(), 2);
    }

    #[test]
    fn the_head_of_the_page_says_what_engineers_ask_first() {
        let page = page(&example::transition());
        let head = &page[page.find("At a glance").unwrap()..page.find("Contents").unwrap()];
        for text in [
            "Largest settlement",
            "seat \u{2212}5, \u{2212}3 m",
            "Hanging sleepers",
            "160 kN (EN 14363)",
            "Stress at the rail",
            "Stiffness at rail level",
            "alert from 7 mm (EN 13848-5)",
            "500 kPa (UIC, concrete)",
            "were not checked against the standards",
        ] {
            assert!(head.contains(text), "{text}: {head}");
        }
        let bench = super::page(&example::bench());
        assert!(bench.contains("Largest rail deflection") && !bench.contains("EN 14363"));
    }

    /// A bridge: two transitions, a long train that runs backwards, more counts than colours.
    fn bridge() -> Run {
        let mut run = example::transition();
        let track = &mut run.scenario.track;
        let mut right = track.sections[0].clone();
        (right.start, right.end) = (24.0, 66.0);
        track.sections.push(right);
        let side = crate::scenario::Side::StiffToSoft;
        track.transitions[0].name = "west".to_owned();
        track.transitions.push(crate::scenario::Transition { name: "east".to_owned(), x: 24.0, side });
        let mirrored: Vec<_> = track.seats.iter().filter(|seat| seat.number < 0).rev().cloned().collect();
        for mut seat in mirrored {
            (seat.x, seat.section, seat.transition) = (24.0 - seat.x, 2, 1);
            track.seats.push(seat);
        }
        run.sleepers.clear();
        for axles in (0..=1000).step_by(100) {
            for seat in &track.seats {
                let distance = seat.x.abs().min((seat.x - 24.0).abs());
                let settled = if seat.is_ballasted() { 1e-3 * (1.0 + (-distance).exp()) } else { 0.0 };
                run.sleepers.push(crate::results::SleeperRow {
                    axles,
                    sleeper: track.seat_name(seat),
                    x_m: seat.x,
                    settlement_m: settled * axles as f64 / 1e3,
                    void_m: 0.0,
                    gravity_contact_force_N: 1.8e3,
                    max_contact_force_N: 3e4,
                    max_rail_seat_load_N: 4e4,
                    max_sleeper_displacement_m: 1e-3,
                    support_stiffness_N_per_m: 4e7,
                    contact_loss_s: 0.0,
                    trains_passing: 1,
                });
            }
        }
        if let Some(Loading::Traffic(traffic)) = &mut run.scenario.loading {
            traffic.train.vehicles = vec![traffic.train.vehicles[0].clone(); 20];
            traffic.train.direction = crate::scenario::Direction::Backward;
        }
        run.scenario.solve.start = None;
        run.histories.clear();
        run
    }

    #[test]
    fn every_figure_of_a_bridge_is_valid() {
        let figures = figures(&bridge());
        assert_eq!(figures[0].svg.matches("42 m, 69 seats at 0.6 m").count(), 2);
        let settlement = figures.iter().find(|figure| figure.id == "settlement").unwrap();
        assert_eq!(
            settlement.svg.matches(r#"class="dot "#).count() - 5,
            5 * 138,
            "five counts that settle, and the legend"
        );
        figures.iter().for_each(check_svg);
    }

    #[test]
    fn a_track_without_sections_draws_nothing_and_does_not_fail() {
        let mut scenario = example::bench().scenario;
        scenario.track.sections.clear();
        scenario.track.seats.clear();
        assert!(roxmltree::Document::parse(&scene_svg(&scenario)).is_ok());
    }
}
