//! The page of a test rig: settlement and stiffness against cycles, loops, sensor readings, and the bed with its force
//! chains.

use super::Figure;
use super::bed::{BedView, Colour, Side, bed_svg};
use super::curves::{Axis, Chart, Mark, Series};
use super::number::{significant, whole};
use super::page::{close, expectations, opening, picture, provenance, subtitle};
use super::prose::prose;
use super::reliance::reliance;
use super::svg::{Frame, Svg, escape};
use super::view::WIDTH;
use crate::results::{BedTest, BedTests, BedTestsView, Run};
use crate::solvers::granular::rig::{Cycle, CycleSample, SensorReading, SpecimenState};
use std::fmt::Write;

const HEIGHT: f64 = 320.0;
/// Cycles whose loops can be told apart.
const LOOPS: usize = 4;

/// The page of a rig.
pub struct BedTestsPage<'a> {
    run: &'a Run,
    tests: &'a BedTests,
    view: &'a BedTestsView,
}

impl<'a> BedTestsPage<'a> {
    /// The page of a view.
    pub fn new(view: &'a BedTestsView) -> BedTestsPage<'a> {
        BedTestsPage { run: &view.run, tests: &view.tests, view }
    }

    /// The whole page, in one file without external parts.
    pub fn html(&self) -> String {
        let run = self.run;
        let mut html = opening(&run.scenario.title, &subtitle(&run.scenario));
        self.headline(&mut html);
        reliance(&mut html, &run.summary.reliance);
        expectations(&mut html, &run.summary.expectations);
        self.figures().iter().for_each(|figure| picture(&mut html, figure));
        self.beds(&mut html);
        provenance(&mut html, &run.summary.provenance);
        close(&mut html);
        html
    }

    fn headline(&self, html: &mut String) {
        let lines: [(&str, &str, &str, f64); 18] = [
            ("Settlement after the last cycle", "max_settlement", "mm", 1e-3),
            ("Settlement after the first cycle", "first_settlement", "mm", 1e-3),
            ("Resilient stiffness, last cycle", "support_stiffness", "MN/m", 1e6),
            ("Resilient stiffness, first cycle", "first_support_stiffness", "MN/m", 1e6),
            ("Oedometric modulus, resilient, last cycle", "oedometric_modulus", "MPa", 1e6),
            ("Oedometric modulus, first loading", "first_oedometric_modulus", "MPa", 1e6),
            ("Largest deviator", "peak_deviator", "kPa", 1e3),
            ("Largest mobilised friction angle", "peak_friction_angle", "\u{b0}", 1.0_f64.to_radians()),
            ("Strain at the largest deviator", "peak_strain", "%", 0.01),
            ("Secant modulus to half the largest deviator", "secant_modulus", "MPa", 1e6),
            ("Smallest volume strain", "least_volume_strain", "%", 0.01),
            ("Largest volume strain", "greatest_volume_strain", "%", 0.01),
            ("Largest force of the bed on a sleeper or plate", "max_contact_force", "kN", 1e3),
            ("Broken bonds, share of all bonds between glued grains", "broken_bonds_share", "%", 0.01),
            ("Grains", "grains", "", 1.0),
            ("Porosity inside the top layer, as packed", "porosity", "", 1.0),
            ("Coordination number inside the top layer, as packed", "coordination_number", "", 1.0),
            ("Time steps of a test", "steps", "", 1.0),
        ];
        let scalar = |name: &str| self.run.summary.scalars.get(name).map(|scalar| scalar.value);
        let cycles = match scalar("cycles").unwrap_or(0.0) as u64 {
            1 => "One cycle".to_owned(),
            n => format!("{} cycles", whole(n)),
        };
        let counts = match self.tests.tests.iter().any(|test| !test.answer.specimen.is_empty()) {
            true => "Settlement and strains are measured from the end of consolidation",
            false => "Settlement is measured from rest under the sleeper's or plate's own weight",
        };
        let packings = match self.tests.tests.len() {
            1 => "one packing".to_owned(),
            n => format!("{n} packings, with the 95 % interval of their mean"),
        };
        let _ = write!(
            html,
            "<section id=\"headline\"><h2>At a glance</h2><p class=\"caption\">{cycles} on {packings}. {counts}. \
             Forces and stiffness are for {}.</p><div class=\"scroll\"><table><tbody>",
            if self.run.scenario.solve.grains.both_rails { "both rails" } else { "one rail" }
        );
        for (label, name, unit, size) in lines {
            let Some(value) = scalar(name) else { continue };
            let band = scalar(&format!("{name}_confidence"));
            let band = band.map_or(String::new(), |half| format!(" \u{b1} {}", significant(half / size, 2)));
            // grains and steps are counted, the rest is measured
            let value = if unit.is_empty() && value.fract() == 0.0 {
                whole(value as u64)
            } else {
                significant(value / size, 3)
            };
            let _ = write!(html, "<tr><td class=\"text\">{label}</td><td><b>{value}</b>{band} {unit}</td></tr>");
        }
        *html += "</tbody></table></div></section>\n";
    }

    pub fn figures(&self) -> Vec<Figure> {
        let mut figures = Vec::new();
        figures.extend(self.deviator());
        figures.extend(self.volume());
        // a bed that is shortened once has no curve against cycles
        if self.tests.tests.iter().any(|test| test.answer.cycles.iter().any(|cycle| cycle.number > 1)) {
            figures.extend([self.against_cycles(false), self.against_cycles(true), self.stiffness()]);
        }
        figures.push(self.loops());
        figures.extend(self.strain());
        figures.extend(self.stress());
        figures.extend(self.velocity());
        figures.push(self.bed(
            Side::X,
            "along",
            "The bed along the track",
            "State at the end of the test, under the lower force.",
        ));
        figures.push(self.bed(Side::Y, "across", "The bed across", "Lines join grains that are in contact."));
        figures
    }

    /// Cycles of each packing and sleeper, with their name.
    fn series(&self, of: impl Fn(&Cycle) -> f64) -> Vec<Series> {
        let mut found = Vec::new();
        for (number, test) in self.tests.tests.iter().enumerate() {
            for (index, (name, _)) in self.tests.sleepers.iter().enumerate() {
                let cycles = test.answer.cycles.iter().filter(|cycle| cycle.sleeper == index);
                let points: Vec<(f64, f64)> = cycles.map(|cycle| (cycle.number as f64, of(cycle))).collect();
                let name = if self.tests.plate.is_some() { name.clone() } else { format!("sleeper {name}") };
                let (name, class) = match (self.tests.tests.len(), self.tests.sleepers.len()) {
                    (1, _) => (name, index),
                    (_, 1) => (format!("seed {}", test.answer.seed), number),
                    _ => (format!("{name}, seed {}", test.answer.seed), index),
                };
                let mark = if points.len() > 40 { Mark::Line } else { Mark::Dots };
                found.push(Series::new(&name, &class_of(class), mark, points));
            }
        }
        found
    }

    fn against_cycles(&self, logarithmic: bool) -> Figure {
        let x = Axis { logarithmic, whole: true, ..Axis::new("Cycles", ("", 1.0)) };
        let y = Axis { downwards: true, from_zero: true, ..Axis::new("Settlement", ("mm", 1e-3)) };
        let mut chart = Chart::new(x, y);
        chart.series = self.series(|cycle| cycle.settlement);
        let (id, title, caption) = match logarithmic {
            false => (
                "settlement",
                "Settlement against cycles",
                "Settlement at the lower force after each cycle, positive downward.",
            ),
            true => (
                "settlement_log",
                "Settlement against the logarithm of cycles",
                "A straight line means that settlement grows with the logarithm of the cycles.",
            ),
        };
        figure(chart, id, title, caption)
    }

    fn stiffness(&self) -> Figure {
        let y = Axis { from_zero: true, ..Axis::new("Resilient stiffness", ("MN/m", 1e6)) };
        let mut chart = Chart::new(Axis { whole: true, ..Axis::new("Cycles", ("", 1.0)) }, y);
        chart.series = self.series(|cycle| cycle.stiffness);
        figure(
            chart,
            "stiffness",
            "Stiffness against cycles",
            "Force range of the cycle divided by the rebound from the deepest position.",
        )
    }

    /// Loops of the sleeper that settles most, in the first packing.
    fn loops(&self) -> Figure {
        let x = Axis { from_zero: true, ..Axis::new("Depth", ("mm", 1e-3)) };
        let mut chart = Chart::new(x, Axis { from_zero: true, ..Axis::new("Force of the actuator", ("kN", 1e3)) });
        let test = &self.tests.tests[0];
        let worst =
            test.answer.cycles.iter().max_by(|a, b| a.settlement.total_cmp(&b.settlement)).map_or(0, |c| c.sleeper);
        let samples: Vec<&CycleSample> = test.answer.samples.iter().filter(|sample| sample.sleeper == worst).collect();
        for (number, cycle) in some(kept(&samples, |sample| sample.cycle), LOOPS).into_iter().enumerate() {
            let of = samples.iter().filter(|sample| sample.cycle == cycle);
            let points = of.map(|sample| (sample.depth, sample.force)).collect();
            chart.series.push(Series::new(&format!("cycle {cycle}"), &class_of(number), Mark::Line, points));
        }
        let caption = format!(
            "Sleeper {}, seed {}. The area inside a loop is the work that the bed dissipates.",
            self.tests.sleepers.get(worst).map_or("", |(name, _)| name),
            test.answer.seed
        );
        figure(chart, "loops", "Force against depth", &caption)
    }

    /// Deviator stress of a specimen with movable sides.
    fn deviator(&self) -> Option<Figure> {
        let y = Axis { from_zero: true, ..Axis::new("Deviator", ("kPa", 1e3)) };
        let caption = "Vertical stress minus lateral stress. The vertical stress is measured at plate and floor; the \
            lateral stress at the four sides, which hold a constant pressure.";
        self.against_strain(y, SpecimenState::deviator, "deviator", "Deviator against strain", caption)
    }

    fn volume(&self) -> Option<Figure> {
        let y = Axis { from_zero: true, ..Axis::new("Volume strain", ("%", 0.01)) };
        let caption = "Positive: the specimen is compressed. Negative: it dilates.";
        self.against_strain(y, |state| state.volume_strain, "volume", "Volume strain against axial strain", caption)
    }

    /// A line for each packing of one cycle, or for some cycles of the first packing.
    fn against_strain(
        &self,
        y: Axis,
        of: impl Fn(&SpecimenState) -> f64,
        id: &str,
        title: &str,
        caption: &str,
    ) -> Option<Figure> {
        let x = Axis { from_zero: true, ..Axis::new("Axial strain", ("%", 0.01)) };
        let mut chart = Chart::new(x, y);
        let tests = &self.tests.tests;
        let cycles = some(kept(&tests[0].answer.specimen, |state| state.cycle), LOOPS);
        let point = |state: &SpecimenState| (state.axial_strain, of(state));
        let mut line = |name: String, test: &BedTest, cycle: u64, class: usize| {
            let points: Vec<_> = test.answer.specimen.iter().filter(|state| state.cycle == cycle).map(point).collect();
            chart.series.push(Series::new(&name, &class_of(class), Mark::Line, points));
        };
        match cycles[..] {
            [] => return None,
            [cycle] => tests
                .iter()
                .enumerate()
                .for_each(|(number, test)| line(format!("seed {}", test.answer.seed), test, cycle, number)),
            _ => cycles
                .iter()
                .enumerate()
                .for_each(|(number, cycle)| line(format!("cycle {cycle}"), &tests[0], *cycle, number)),
        }
        Some(figure(chart, id, title, caption))
    }

    /// Stress against strain under a plate, first packing.
    fn strain(&self) -> Option<Figure> {
        let area = self.tests.plate.filter(|_| self.tests.tests[0].answer.specimen.is_empty())?;
        let test = &self.tests.tests[0];
        let height = BedTests::height(test);
        let x = Axis { from_zero: true, ..Axis::new("Vertical strain", ("%", 0.01)) };
        let mut chart = Chart::new(x, Axis { from_zero: true, ..Axis::new("Vertical stress", ("kPa", 1e3)) });
        for (number, cycle) in some(kept(&test.answer.samples, |sample| sample.cycle), LOOPS).into_iter().enumerate() {
            let of = test.answer.samples.iter().filter(|sample| sample.cycle == cycle);
            let points = of.map(|sample| (sample.depth / height, sample.force / area)).collect();
            chart.series.push(Series::new(&format!("cycle {cycle}"), &class_of(number), Mark::Line, points));
        }
        let caption = "Stress and strain of the plate, measured from rest under its own weight. The sides are rigid, \
            as in an oedometer.";
        Some(figure(chart, "strain", "Stress against strain", caption))
    }

    fn stress(&self) -> Option<Figure> {
        let y = Axis { from_zero: true, ..Axis::new("Vertical stress", ("kPa", 1e3)) };
        let caption = "Positive in compression";
        self.at_sensors(y, |reading| reading.stress, "stress", "Stress at the sensors", caption)
    }

    fn velocity(&self) -> Option<Figure> {
        let y = Axis::new("Velocity", ("mm/s", 1e-3));
        let caption = "Mean of the grains inside the sensor, positive downward";
        self.at_sensors(y, |reading| reading.velocity, "velocity", "Velocity at the sensors", caption)
    }

    /// Sensor readings of the first packing over the last recorded cycle.
    fn at_sensors(
        &self,
        y: Axis,
        of: fn(&SensorReading) -> f64,
        id: &str,
        title: &str,
        caption: &str,
    ) -> Option<Figure> {
        let readings = &self.tests.tests[0].answer.readings;
        let last = readings.iter().map(|reading| reading.cycle).max()?;
        let mut chart = Chart::new(Axis { range: Some((0.0, 1.0)), ..Axis::new("Share of the cycle", ("%", 0.01)) }, y);
        for (index, (name, _)) in self.tests.sensors.iter().enumerate() {
            let over = |cycle: u64| readings.iter().filter(move |r| (r.sensor, r.cycle) == (index, cycle));
            let line = |cycle| over(cycle).map(|reading| (reading.phase, of(reading))).collect::<Vec<_>>();
            chart.series.push(Series::new("", &class_of(index), Mark::Faint, line(1)));
            chart.series.push(Series::new(&format!("sleeper {name}"), &class_of(index), Mark::Line, line(last)));
        }
        Some(figure(chart, id, title, &format!("{caption}. Thick lines: cycle {last}. Thin lines: first cycle.")))
    }

    fn bed(&self, side: Side, id: &str, title: &str, caption: &str) -> Figure {
        let svg = bed_svg(&BedView {
            title,
            grains: &self.view.grains,
            chains: &self.view.links,
            walls: &self.view.walls,
            domain: &self.view.domain,
            side,
            colour: Colour::Force,
        });
        let caption =
            format!("{caption} The grains in front are shown, coloured by the largest contact force on each.");
        Figure { id: id.to_owned(), title: title.to_owned(), caption, svg }
    }

    fn beds(&self, html: &mut String) {
        *html += "<section class=\"long\" id=\"beds\"><h2>Beds</h2>";
        for test in &self.tests.tests {
            let bed = &test.bed;
            let layers = bed.layers.iter().rev().map(|layer| {
                format!(
                    "{} {} mm, {} grains, porosity {} inside, {} neighbours",
                    layer.name,
                    significant(1e3 * layer.thickness_m, 3),
                    whole(layer.bodies as u64),
                    significant(layer.inner_porosity, 3),
                    significant(layer.coordination, 3)
                )
            });
            let layers = layers.collect::<Vec<_>>().join("; ");
            let _ = writeln!(html, "<p class=\"note\">Seed {}: {}.</p>", test.answer.seed, escape(&layers));
        }
        for note in self.tests.tests.first().map_or(&[][..], |test| &test.bed.notes) {
            let _ = writeln!(html, "<p class=\"note\">{}</p>", prose(note));
        }
        *html += "</section>\n";
    }
}

fn figure(chart: Chart, id: &str, title: &str, caption: &str) -> Figure {
    let mut svg = Svg::default();
    chart.draw(&mut svg, id, Frame { x: 0.0, y: 4.0, width: WIDTH, height: HEIGHT });
    let svg = svg.finish(WIDTH, HEIGHT + 12.0, title);
    Figure { id: id.to_owned(), title: title.to_owned(), caption: caption.to_owned(), svg }
}

fn class_of(index: usize) -> String {
    const CLASSES: [&str; 8] = ["s0", "s1", "s2", "s3", "k5", "k2", "k0", "k4"];
    CLASSES[index % CLASSES.len()].to_owned()
}

fn kept<T>(rows: &[T], of: impl Fn(&T) -> u64) -> Vec<u64> {
    let mut cycles: Vec<u64> = rows.iter().map(of).collect();
    cycles.sort_unstable();
    cycles.dedup();
    cycles
}

/// At most so many of a list, its ends among them.
fn some(list: Vec<u64>, most: usize) -> Vec<u64> {
    if list.len() <= most {
        return list;
    }
    (0..most).map(|k| list[k * (list.len() - 1) / (most - 1)]).collect()
}
