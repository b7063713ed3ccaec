//! A long section of the grains under each transition at the recorded counts: levels, grains, voids and force chains.
//!
//! Each count is a layer of the picture. The picture shows the last one; the page's script has a slider that moves through all.

mod layer;
#[cfg(test)]
mod tests;
mod window;

use super::Figure;
use super::bed::{Bar, Colour};
use super::number::{significant, whole};
use super::over_axles::named;
use super::svg::{Anchor, Svg, escape};
use super::view::WIDTH;
use crate::results::{BedsAtCount, Link, Run};
use layer::Layer;

/// Counts that the picture holds, spread evenly where there are more.
const MOST: usize = 6;
const TOP: f64 = 96.0;
const GAP: f64 = 22.0;
/// Share of the contacts whose force is larger than the widest line shows.
const ABOVE: f64 = 0.005;

/// The scales that all counts share.
struct Scales {
    bar: Bar,
    /// Levels and voids are drawn so many times as large as the lengths of the picture.
    exaggeration: f64,
    /// Force of the widest line, N.
    force: f64,
    /// Height of the highest void, px.
    hanging: f64,
}

pub fn bed_section(run: &Run) -> Option<Figure> {
    let shown: Vec<BedsAtCount> = spread(&run.beds).into_iter().map(|beds| section(run, beds)).collect();
    let last = shown.last()?;
    let windows = window::windows(run, last);
    let largest = windows.iter().map(|window| window.scale).fold(f64::NAN, f64::max);
    if windows.is_empty() {
        return None;
    }
    let exaggeration = window::exaggeration(run, largest);
    let scales = Scales {
        bar: Bar::new(Colour::Displacement, shown.iter().flat_map(|beds| &beds.grains)),
        exaggeration,
        force: widest(&shown),
        hanging: run.sleepers.iter().map(|row| row.void_m).fold(0.0, f64::max) * exaggeration * largest,
    };
    let mut svg = Svg::default();
    scales.bar.define(&mut svg);
    scales.bar.draw(&mut svg);
    let names: Vec<String> = shown.iter().map(|beds| named(beds.axles)).collect();
    svg.define(&format!("<metadata class=\"layers\">{}</metadata>", escape(&steps(&names))));
    let mut bottom = TOP;
    for (step, (beds, name)) in shown.iter().zip(&names).enumerate() {
        let hidden = if step + 1 < shown.len() { r#" display="none""# } else { "" };
        svg.group(&format!(r#"class="layer" data-step="{step}"{hidden}"#), |svg| {
            svg.text("strong", (26.0, 24.0), Anchor::Start, name);
            let mut y = TOP;
            for window in &windows {
                y = Layer { run, beds, window, scales: &scales }.draw(svg, y) + GAP;
            }
            bottom = y;
        });
    }
    let caption = caption(run, &scales, &shown);
    let svg = svg.finish(WIDTH, bottom, "Long section of the bed");
    Some(Figure { id: "bed_section".into(), title: "The bed under the transition".into(), caption, svg })
}

/// The names of the steps as JSON.
fn steps(names: &[String]) -> String {
    serde_json::to_string(names).unwrap_or_default()
}

/// The counts that the picture holds.
fn spread(beds: &[BedsAtCount]) -> Vec<&BedsAtCount> {
    match beds.len() {
        n if n <= MOST => beds.iter().collect(),
        n => (0..MOST).map(|k| &beds[k * (n - 1) / (MOST - 1)]).collect(),
    }
}

/// The beds along the rail seats; those of a count at which the scene asks for states are kept whole.
fn section(run: &Run, beds: &BedsAtCount) -> BedsAtCount {
    let whole = run.scenario.records.iter().any(|record| record.states && record.after.contains(&beds.axles));
    let sleeper = run.scenario.track.seats.iter().find_map(|seat| seat.sleeper);
    match sleeper.filter(|_| whole) {
        Some(sleeper) => beds.clone().along_seats(0.5 * sleeper.seat_distance),
        None => beds.clone(),
    }
}

/// Force of the widest line: few contacts at any count carry more, N.
fn widest(shown: &[BedsAtCount]) -> f64 {
    let mut forces: Vec<f64> = shown.iter().flat_map(|beds| &beds.links).map(Link::size).collect();
    forces.sort_by(f64::total_cmp);
    let place = ((1.0 - ABOVE) * forces.len() as f64) as usize;
    forces.get(place).or(forces.last()).copied().unwrap_or(0.0)
}

fn caption(run: &Run, scales: &Scales, shown: &[BedsAtCount]) -> String {
    let first = shown.first().map_or(0, |beds| beds.axles);
    let since =
        if first == 0 { "since the track was built".to_owned() } else { format!("since {} axles", whole(first)) };
    let voids = run.sleepers.iter().any(|row| row.void_m > 0.0);
    let factor = whole(scales.exaggeration as u64);
    let voids = if voids {
        format!(" Sleepers that hang are drawn above their void (orange), {factor} times too high.")
    } else {
        " No sleeper hangs.".to_owned()
    };
    format!(
        "Grains of the 3D model along the rail seats, without a train, to scale. Above, the level of the rail and of the supports, drawn \
         {factor} times too large. In the middle the grains, coloured by how far each has moved {since}.{voids} Below, the forces of the \
         contacts as lines: their width grows with the force, up to {} kN. Forces below the mean are left out. The section is three mean \
         pebbles thick; `grains.parquet` and `contacts.parquet` hold its numbers.",
        significant(scales.force / 1e3, 2)
    )
}
