//! A long section of the grains under each transition at the recorded counts: levels, grains, voids and force chains.
//!
//! Each count is a layer of the picture. The picture shows the last one; the page's script has a slider that moves
//! through all.

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
    /// Force of the widest line, without a train and under one, N.
    forces: [f64; 2],
    /// Height of the highest void, px.
    hanging: f64,
}

pub fn bed_section(run: &Run) -> Option<Figure> {
    let shown: Vec<BedsAtCount> = spread(run).into_iter().map(|beds| section(run, beds)).collect();
    let under_train: Vec<Option<BedsAtCount>> = shown.iter().map(|beds| under_train(run, beds.axles)).collect();
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
        forces: [widest(shown.iter()), widest(under_train.iter().flatten())],
        hanging: run.sleepers.iter().map(|row| row.void_m).fold(0.0, f64::max) * exaggeration * largest,
    };
    let mut svg = Svg::default();
    scales.bar.define(&mut svg);
    scales.bar.draw(&mut svg);
    let names: Vec<String> = shown.iter().map(|beds| named(beds.axles)).collect();
    svg.define(&format!("<metadata class=\"layers\">{}</metadata>", escape(&steps(&names))));
    let mut bottom = TOP;
    for (step, ((beds, loaded), name)) in shown.iter().zip(&under_train).zip(&names).enumerate() {
        let hidden = if step + 1 < shown.len() { r#" display="none""# } else { "" };
        svg.group(&format!(r#"class="layer" data-step="{step}"{hidden}"#), |svg| {
            svg.text("strong", (26.0, 24.0), Anchor::Start, name);
            let mut y = TOP;
            for window in &windows {
                y = Layer { run, beds, loaded: loaded.as_ref(), window, scales: &scales }.draw(svg, y) + GAP;
            }
            bottom = y;
        });
    }
    let caption = caption(run, &scales, &shown, under_train.iter().any(Option::is_some));
    let svg = svg.finish(WIDTH, bottom, "Long section of the bed");
    Some(Figure { id: "bed_section".into(), title: "The bed under the transition".into(), caption, svg })
}

/// The names of the steps as JSON.
fn steps(names: &[String]) -> String {
    serde_json::to_string(names).unwrap_or_default()
}

/// The beds without a train at the counts that the picture holds.
fn spread(run: &Run) -> Vec<&BedsAtCount> {
    let all: Vec<&BedsAtCount> = run.beds.iter().filter(|beds| !beds.under_train).collect();
    match all.len() {
        n if n <= MOST => all,
        n => (0..MOST).map(|k| all[k * (n - 1) / (MOST - 1)]).collect(),
    }
}

/// The beds under the leading bogie of the train after a count, if they were recorded.
fn under_train(run: &Run, axles: u64) -> Option<BedsAtCount> {
    run.beds.iter().find(|beds| beds.under_train && beds.axles == axles).map(|beds| section(run, beds))
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
fn widest<'a>(shown: impl Iterator<Item = &'a BedsAtCount>) -> f64 {
    let mut forces: Vec<f64> = shown.flat_map(|beds| &beds.links).map(Link::size).collect();
    forces.sort_by(f64::total_cmp);
    let place = ((1.0 - ABOVE) * forces.len() as f64) as usize;
    forces.get(place).or(forces.last()).copied().unwrap_or(0.0)
}

fn caption(run: &Run, scales: &Scales, shown: &[BedsAtCount], loaded: bool) -> String {
    let first = shown.first().map_or(0, |beds| beds.axles);
    let since =
        if first == 0 { "since the track was built".to_owned() } else { format!("since {} axles", whole(first)) };
    let voids = run.sleepers.iter().any(|row| row.void_m > 0.0);
    let factor = whole(scales.exaggeration as u64);
    let voids = if voids {
        format!(" Hanging sleepers are drawn above their void (orange); the void is enlarged {factor} times.")
    } else {
        " No sleeper hangs.".to_owned()
    };
    let train = match loaded {
        true => {
            "If the picture says so, the forces are those under the leading bogie of the next train, beside the \
            structure. "
        }
        false => "",
    };
    format!(
        "Grains of the 3D model along the rail seats, to scale. Grains and levels are shown without a train. Top: \
         levels of the rail and of the supports, enlarged {factor} times. Middle: the grains, coloured by their \
         displacement {since}.{voids} Bottom: contact forces as lines. The width of a line grows with the force; \
         forces below {} % of the widest line are left out. {train}The section is three mean pebbles thick. Its \
         numbers are in `grains.parquet` and `contacts.parquet`.",
        significant(100.0 * layer::WEAKEST, 2)
    )
}
