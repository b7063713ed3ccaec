//! Measurements in a packed bed: over its height, in its contacts, under a plate.

use super::Figure;
use super::curves::{Axis, Chart, Mark, Series};
use super::number::{plain, significant, whole};
use super::page::picture;
use super::panels::{Names, panels};
use super::svg::{Anchor, Frame, Svg};
use super::table::{TABLE_END, row, table_head};
use super::view::WIDTH;
use crate::results::{BedReadings, Directions, PlateTest, ProfileRow};
use std::f64::consts::PI;

const PROFILE: f64 = 340.0;
const CONTACTS: f64 = 320.0;
const ROSE: f64 = 118.0;
const CURVE: f64 = 300.0;
/// The axis of porosity ends on a multiple of this value.
const ROUND: f64 = 0.05;
/// Force over its mean from which the tail is fitted.
const FIT: f64 = 1.0;

/// Writes all of it.
pub fn write(html: &mut String, readings: &BedReadings) {
    if let Some(plate) = &readings.plate {
        plate_table(html, plate);
        picture(html, &curve(plate));
    }
    if let Some(figure) = profile(readings) {
        picture(html, &figure);
    }
    contact_table(html, readings);
    picture(html, &contacts(readings));
}

fn plate_table(html: &mut String, plate: &PlateTest) {
    let what = match plate.sides_m {
        Some([length, width]) => {
            format!("of {} m x {} m (the area of this cell under a sleeper)", plain(length, 3), plain(width, 3))
        }
        None => "over the whole cell".to_owned(),
    };
    let caption = format!(
        "A rigid plate {what} loads the finished bed to {} kPa, is unloaded, and loads it again; each step ends at \
         rest. Stiffness is the secant from the seated plate. The moduli are those of a half-space with the same \
         deformation (DIN 18134). This cell stands on a rigid floor and is not a half-space, so use the moduli to \
         compare beds, not sites.",
        plain(plate.pressure_Pa / 1e3, 3)
    );
    let head =
        ["loading", "stiffness [MN/m]", "bedding modulus [N/mm3]", "deformation modulus [MPa]", "settlement [mm]"];
    *html += &table_head("Under a plate", &caption, &head);
    let highest = plate.curve.iter().map(|point| point.pressure).fold(0.0, f64::max);
    let full = plate.curve.iter().filter(|point| point.pressure > 0.9 * highest).map(|point| point.settlement);
    let settled: Vec<f64> = full.collect();
    for (number, name) in ["first, Ev1", "second, Ev2"].into_iter().enumerate() {
        let stiffness = plate.stiffness_N_per_m[number];
        let cells = [
            significant(stiffness / 1e6, 3),
            significant(stiffness / plate.area_m2 / 1e9, 3),
            plate.moduli_Pa.map_or("none".to_owned(), |moduli| significant(moduli[number] / 1e6, 3)),
            settled.get(number).map_or(String::new(), |settlement| significant(1e3 * settlement, 3)),
        ];
        row(html, name, &cells);
    }
    *html += TABLE_END;
    *html += "</section>";
}

fn curve(plate: &PlateTest) -> Figure {
    let settlement = Axis { downwards: true, from_zero: true, ..Axis::new("Settlement", ("mm", 1e-3)) };
    let pressures = plate.curve.iter().map(|point| point.pressure);
    let mut chart = Chart::new(from_zero(Axis::new("Pressure", ("kPa", 1e3)), pressures), settlement);
    let points = |range: &[_]| -> Vec<(f64, f64)> {
        range.iter().map(|p: &crate::solvers::granular::probe::LoadPoint| (p.pressure, p.settlement)).collect()
    };
    // both loadings begin at a seat
    let second = plate.curve.iter().skip(1).position(|point| point.pressure <= plate.curve[0].pressure * 1.5);
    let second = second.map_or(plate.curve.len() - 1, |k| k + 1);
    chart.series.push(Series::new("first loading and unloading", "s0", Mark::Dots, points(&plate.curve[..=second])));
    chart.series.push(Series::new("second", "s1", Mark::Dots, points(&plate.curve[second..])));
    let mut svg = Svg::default();
    chart.draw(&mut svg, "plate-curve", Frame { x: 0.0, y: 4.0, width: WIDTH, height: CURVE });
    figure("plate", "Plate load test", "Each mark is a state at rest.", svg, CURVE + 12.0)
}

fn profile(readings: &BedReadings) -> Option<Figure> {
    let height = || Axis { from_zero: true, ..Axis::new("Height", ("mm", 1e-3)) };
    let over = |rows: &[ProfileRow], of: fn(&ProfileRow) -> f64| -> Vec<(f64, f64)> {
        rows.iter().map(|row| (of(row), 0.5 * (row.from_m + row.to_m))).collect()
    };
    let porosities = readings.profile.iter().map(|row| row.porosity);
    let (low, high) = porosities.fold((1.0_f64, 0.0_f64), |(low, high), p| (low.min(p), high.max(p)));
    let range = Some(((low / ROUND).floor() * ROUND, (high / ROUND).ceil() * ROUND));
    let mut porosity = Chart::new(Axis { range, ..Axis::new("Porosity", ("", 1.0)) }, height());
    porosity.series.push(Series::new("whole cell", "s0", Mark::Dots, over(&readings.profile, |row| row.porosity)));
    let stress = |title: &str, rows: &[ProfileRow]| {
        let pressures = rows.iter().flat_map(|row| [row.vertical_Pa, row.along_Pa, row.across_Pa]);
        let mut chart = Chart::new(from_zero(Axis::new(title, ("kPa", 1e3)), pressures), height());
        chart.series.push(Series::new("vertical", "s0", Mark::Dots, over(rows, |row| row.vertical_Pa)));
        chart.series.push(Series::new("along", "s1", Mark::Dots, over(rows, |row| row.along_Pa)));
        chart.series.push(Series::new("across", "s2", Mark::Dots, over(rows, |row| row.across_Pa)));
        chart
    };
    let mut charts = vec![(porosity, PROFILE), (stress("Pressure at rest", &readings.profile), PROFILE)];
    if let Some(plate) = &readings.plate {
        charts.push((stress("Pressure under the plate", &plate.loaded), PROFILE));
    }
    let columns = charts.len();
    let names = Names {
        id: "profile",
        title: "Profiles over the height",
        caption: "Means over horizontal slabs, from the floor upwards. At rest: over the whole cell. Under the plate: \
                  over the grains below the plate at the first full pressure. Vertical: pressure on horizontal planes. \
                  Along and across: pressures on vertical planes. Pressures locked in by packing remain at rest.",
    };
    panels(&names, &charts, columns)
}

fn contact_table(html: &mut String, readings: &BedReadings) {
    let caption = "Contacts between grains, without walls. Strong contacts carry more than the mean normal force. The \
                   fabric deviator is 0 if contact directions are uniform, and 1 if all contacts have one direction. \
                   The vertical part is one third if no direction is preferred. The tail is the k of a fit \
                   exp(\u{2212}k f), with f the normal force over its mean; forces fall faster with a larger k.";
    let head = [
        "contacts",
        "number",
        "mean force [N]",
        "largest / mean",
        "share above the mean",
        "load above the mean",
        "tail",
        "mobilised friction",
        "sliding",
        "fabric deviator",
        "vertical part",
    ];
    *html += &table_head("Contacts", caption, &head);
    let percent = |share: f64| format!("{} %", plain(100.0 * share, 3));
    let some = |value: Option<String>| value.unwrap_or_else(|| "none".to_owned());
    let forces = &readings.forces;
    let fabric = |directions: &Directions| {
        let vertical = directions.fabric.tensor[2][2];
        [significant(directions.deviator, 2), significant(vertical, 3)]
    };
    let [deviator, vertical] = fabric(&readings.directions);
    let cells = [
        whole(forces.contacts as u64),
        significant(forces.mean, 3),
        significant(forces.largest, 3),
        percent(forces.above),
        percent(forces.carried),
        some(forces.decay.map(|decay| significant(decay, 3))),
        some(forces.mobilised.map(percent)),
        some(forces.sliding.map(percent)),
        deviator,
        vertical,
    ];
    row(html, "all", &cells);
    let [deviator, vertical] = fabric(&readings.strong_directions);
    let mut cells = vec![whole(readings.strong_directions.fabric.contacts as u64)];
    cells.resize(8, String::new());
    cells.extend([deviator, vertical]);
    row(html, "strong", &cells);
    *html += TABLE_END;
    *html += "</section>";
}

/// Forces on a logarithmic axis, and two roses.
fn contacts(readings: &BedReadings) -> Figure {
    let forces = &readings.forces;
    let found: Vec<(f64, f64)> = forces.density.iter().filter(|[_, d]| *d > 0.0).map(|[f, d]| (*f, *d)).collect();
    let largest = found.last().map_or(FIT, |point| point.0);
    let least = found.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let density = Axis { logarithmic: true, ..Axis::new("Density", ("", 1.0)) };
    let mut chart = Chart::new(from_zero(Axis::new("Normal force over its mean", ("", 1.0)), [largest]), density);
    chart.series.push(Series::new("contacts", "s0", Mark::Dots, found));
    if let Some(decay) = forces.decay {
        let tail = |force: f64| forces.above * decay * (-decay * (force - 1.0)).exp();
        let line: Vec<(f64, f64)> =
            (0..=40).map(|k| FIT + (largest - FIT) * f64::from(k) / 40.0).map(|f| (f, tail(f))).collect();
        let shown = line.into_iter().filter(|point| point.1 >= 0.5 * least).collect();
        chart.series.push(Series::new(&format!("tail exp(\u{2212}{} f)", plain(decay, 3)), "s1", Mark::Line, shown));
    }
    let mut svg = Svg::default();
    let left = 0.46 * WIDTH;
    chart.draw(&mut svg, "forces", Frame { x: 0.0, y: 4.0, width: left, height: CONTACTS });
    for (number, (title, of)) in
        [("Along the track", (|d| &d.rose.along) as fn(&Directions) -> &Vec<f64>), ("Across", |d| &d.rose.across)]
            .into_iter()
            .enumerate()
    {
        let middle = left + (0.26 + 0.5 * number as f64) * (WIDTH - left);
        let roses = [of(&readings.directions), of(&readings.strong_directions)];
        rose(&mut svg, (middle, 4.0 + 0.5 * CONTACTS), title, roses);
    }
    figure(
        "contacts",
        "Forces and directions of contacts",
        "Left: distribution of normal forces, and the exponential fitted to forces above the mean. Right: frequency of \
         contact normals by direction in a vertical plane, relative to a uniform distribution (dotted circle). Filled: \
         all contacts. Outlined: strong contacts.",
        svg,
        CONTACTS + 12.0,
    )
}

/// Densities over half a turn, drawn as a whole turn: all filled, strong outlined.
fn rose(svg: &mut Svg, (x, y): (f64, f64), title: &str, [all, strong]: [&Vec<f64>; 2]) {
    let largest = all.iter().chain(strong).copied().fold(1.0, f64::max);
    let unit = (ROSE - 22.0) / largest;
    let at = |radius: f64, angle: f64| (x + unit * radius * angle.cos(), y - unit * radius * angle.sin());
    let circle: Vec<(f64, f64)> = (0..72).map(|k| at(1.0, f64::from(k) * PI / 36.0)).collect();
    let outline = |densities: &[f64]| -> Vec<(f64, f64)> {
        let step = PI / densities.len() as f64;
        let turn = densities.iter().chain(densities).enumerate();
        let sector = |(k, density): (usize, &f64)| {
            (0..=4).map(move |n| (*density, step * (k as f64 + f64::from(n) / 4.0))).collect::<Vec<_>>()
        };
        turn.flat_map(sector).map(|(density, angle)| at(density, angle)).collect()
    };
    svg.group("opacity=\"0.35\"", |svg| svg.path("dot s0", &outline(all), true, "all contacts"));
    svg.path("line s1", &outline(strong), true, "strong contacts");
    svg.path("load", &circle, true, "uniform distribution");
    svg.line("axis", (x - ROSE, y), (x + ROSE, y));
    svg.line("axis", (x, y - ROSE), (x, y + ROSE));
    svg.text("strong", (x, y - ROSE - 12.0), Anchor::Middle, title);
    svg.text("small muted", (x, y + ROSE + 16.0), Anchor::Middle, "vertical: up; horizontal: to the side");
}

/// The axis from 0, or from the least of the values, to somewhat beyond the largest.
fn from_zero(axis: Axis, values: impl IntoIterator<Item = f64>) -> Axis {
    let (low, high) = values.into_iter().fold((0.0, 0.0), |(low, high), v| (v.min(low), v.max(high)));
    Axis { range: Some((1.05 * low, 1.05 * high)), ..axis }
}

fn figure(id: &str, title: &str, caption: &str, svg: Svg, height: f64) -> Figure {
    Figure {
        id: id.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(WIDTH, height, title),
    }
}
