//! The page of a packed bed: its properties, its making, and its pictures.

use super::Figure;
use super::bed::{BedView, Colour, Side, bed_svg};
use super::curves::{Axis, Chart, Mark, Series};
use super::number::{plain, significant, whole};
use super::packed_readings as readings;
use super::page::{close, opening, picture};
use super::prose::prose;
use super::svg::{Frame, Svg};
use super::table::{TABLE_END, row, table_head};
use super::view::WIDTH;
use crate::results::{BedSummary, Grain, Link};
use crate::solvers::granular::grains::Sample;
use crate::solvers::granular::{Domain, Wall};
use std::fmt::Write;

const HEIGHT: f64 = 300.0;

/// A bed as the page shows it.
pub struct BedPage<'a> {
    pub summary: &'a BedSummary,
    /// The sample of each grading, from the floor upwards.
    pub samples: &'a [Sample],
    pub grains: &'a [Grain],
    pub links: &'a [Link],
    pub walls: &'a [Wall],
    pub domain: &'a Domain,
}

impl BedPage<'_> {
    /// The whole page, in one file without external parts.
    pub fn html(&self) -> String {
        let summary = self.summary;
        let [length, width] = summary.plan_m;
        let subtitle = format!(
            "The bed of `{}`: a cell of {} m x {} m with {} grains of {} pebbles, packed and at rest.",
            summary.section,
            plain(length, 3),
            plain(width, 3),
            whole(summary.bodies as u64),
            whole(summary.pebbles as u64)
        );
        let mut html = opening(&summary.title, &subtitle);
        self.layers(&mut html);
        self.figures().iter().for_each(|figure| picture(&mut html, figure));
        if let Some(found) = &summary.readings {
            readings::write(&mut html, found);
        }
        self.stages(&mut html);
        close(&mut html);
        html
    }

    fn layers(&self, html: &mut String) {
        let caption = "The porosity of a layer includes the loose zones at the floor and at the walls; the inner \
             porosity does not. Neighbours are counted per grain: two grains that touch at several pebbles count once. \
             Pressed: under the plate, before friction was switched on again.";
        *html += &table_head(
            "At a glance",
            caption,
            &[
                "layer, bottom first",
                "grains",
                "thickness [mm]",
                "target [mm]",
                "porosity",
                "inner porosity",
                "grading error",
                "neighbours pressed",
                "neighbours at rest",
                "without rattlers",
                "rattlers",
            ],
        );
        for layer in &self.summary.layers {
            let percent = |share: f64| format!("{} %", plain(100.0 * share, 3));
            let cells = [
                whole(layer.bodies as u64),
                plain(1e3 * layer.thickness_m, 4),
                plain(1e3 * layer.thickness_asked_m, 4),
                plain(layer.porosity, 3),
                plain(layer.inner_porosity, 3),
                percent(layer.grading_error),
                plain(layer.coordination_pressed, 3),
                plain(layer.coordination, 3),
                plain(layer.coordination_without_rattlers, 3),
                percent(layer.rattlers),
            ];
            row(html, &layer.name, &cells);
        }
        *html += TABLE_END;
        for note in &self.summary.notes {
            let _ = writeln!(html, "<p class=\"caption\">{}</p>", prose(note));
        }
        *html += "</section>";
    }

    fn stages(&self, html: &mut String) {
        let caption = "A stage ends when the mean unbalanced force is small compared with the mean acting force at \
            three checks in a row.";
        let head = ["stage", "time [s]", "plate [kPa]", "level [mm]", "force imbalance", "neighbours, by layer"];
        *html += &table_head("How the bed was made", caption, &head);
        for stage in &self.summary.stages {
            let layers = stage.state.layers.iter().filter(|layer| layer.bodies > 0);
            let neighbours: Vec<String> = layers.map(|layer| plain(layer.coordination, 3)).collect();
            let cells = [
                plain(stage.time, 3),
                if stage.level.is_some() { plain(stage.pressure / 1e3, 4) } else { "none".to_owned() },
                stage.level.map_or(String::new(), |level| plain(1e3 * level, 4)),
                significant(stage.state.unbalance, 2),
                neighbours.join(", "),
            ];
            row(html, &stage.name, &cells);
        }
        *html += TABLE_END;
        let _ = write!(
            html,
            "<p class=\"caption\">Stored as {}. The same recipe gives the same bed, bit for bit.</p></section>",
            &self.summary.hash[..16]
        );
    }

    fn figures(&self) -> Vec<Figure> {
        let side = |side, chains, title: &str, id: &str, caption: &str| Figure {
            id: id.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            svg: self.side(side, chains, title),
        };
        vec![
            side(
                Side::X,
                false,
                "Along the track",
                "along",
                "The grains in front, coloured by the largest contact force on each.",
            ),
            side(
                Side::Y,
                true,
                "Across, with its force chains",
                "across",
                "Lines join grains in contact; the width of a line grows with the force.",
            ),
            self.gradings(),
        ]
    }

    /// One of the pictures on its own.
    pub fn side(&self, side: Side, chains: bool, title: &str) -> String {
        bed_svg(&BedView {
            title,
            grains: self.grains,
            chains: if chains { self.links } else { &[] },
            walls: self.walls,
            domain: self.domain,
            side,
            colour: Colour::Force,
        })
    }

    fn gradings(&self) -> Figure {
        let mut chart = Chart::new(
            Axis { logarithmic: true, ..Axis::new("Size", ("mm", 1e-3)) },
            Axis { range: Some((0.0, 1.0)), ..Axis::new("Mass passing", ("%", 0.01)) },
        );
        for (index, (sample, layer)) in self.samples.iter().zip(&self.summary.layers).enumerate() {
            let class = format!("s{}", index % 4);
            let asked = sample.curve.points().iter().map(|[size, share]| (*size, *share)).collect();
            chart.series.push(Series::new(&format!("{} target", layer.name), &class, Mark::Faint, asked));
            let reached = sample.curve.points().windows(2).flat_map(|pair| {
                let [low, high] = [pair[0][0], pair[1][0]];
                (0..=16).map(move |k| low * (high / low).powf(f64::from(k) / 16.0))
            });
            let reached = reached.map(|size| (size, sample.below(size))).collect();
            chart.series.push(Series::new(&layer.name, &class, Mark::Line, reached));
        }
        let mut svg = Svg::default();
        chart.draw(&mut svg, "gradings", Frame { x: 0.0, y: 4.0, width: WIDTH, height: HEIGHT });
        Figure {
            id: "gradings".to_owned(),
            title: "Target and achieved gradings".to_owned(),
            caption: "Thin lines: target gradings. Thick lines: the grains of this bed.".to_owned(),
            svg: svg.finish(WIDTH, HEIGHT + 12.0, "Target and achieved gradings"),
        }
    }
}
