//! The picture of the maps of a bed of grains. Left: steps, upwards as shares of the limit of the network, with the
//! inertia that may be added to the right. Right: speeds upwards, with the change of stiffness by added inertia.

use super::number::plain;
use super::svg::{Anchor, Frame, Svg};
use crate::trials::{GrainMap, SpeedTrial, StepTrial};

const CELL: [f64; 2] = [72.0, 34.0];
const LEFT: f64 = 84.0;
const TOP: f64 = 92.0;
const GAP: f64 = 110.0;

/// A panel: names of its columns and rows (from below), its cells by column and row.
struct Panel {
    title: &'static str,
    across: &'static str,
    up: &'static str,
    columns: Vec<String>,
    rows: Vec<String>,
    cells: Vec<(usize, usize, Cell)>,
}

struct Cell {
    class: &'static str,
    text: String,
    under: String,
}

/// The whole picture.
pub fn grain_map_svg(map: &GrainMap, title: &str) -> String {
    let mut svg = Svg::default();
    svg.text("strong", (16.0, 24.0), Anchor::Start, &format!("{title}: grains of section {}", map.section));
    let under = format!(
        "One cell under sleeper {}. The scene steps by {} us, {} times below the limit of its bed.",
        map.sleeper,
        plain(1e6 * map.at_rest.step, 3),
        plain(map.margin(), 2)
    );
    svg.text("small muted", (16.0, 42.0), Anchor::Start, &under);
    let panels = [steps(map), speeds(map)];
    let (mut left, mut bottom) = (LEFT, TOP);
    for panel in &panels {
        let [across, up] = [panel.columns.len() as f64 * CELL[0], panel.rows.len() as f64 * CELL[1]];
        draw(&mut svg, panel, (left, TOP + up));
        (left, bottom) = (left + across + GAP, bottom.max(TOP + up));
    }
    svg.finish(left - GAP + 90.0, bottom + 44.0, &format!("Grains of {title}"))
}

fn draw(svg: &mut Svg, panel: &Panel, (left, bottom): (f64, f64)) {
    svg.text("small strong", (left, TOP - 10.0), Anchor::Start, panel.title);
    for (column, row, cell) in &panel.cells {
        let (x, y) = (left + *column as f64 * CELL[0], bottom - (*row + 1) as f64 * CELL[1]);
        svg.titled_rect(cell.class, Frame { x, y, width: CELL[0] - 1.0, height: CELL[1] - 1.0 }, "");
        let middle = x + 0.5 * CELL[0];
        svg.text("small", (middle, y + 14.0), Anchor::Middle, &cell.text);
        svg.text("small muted", (middle, y + 27.0), Anchor::Middle, &cell.under);
    }
    for (column, name) in panel.columns.iter().enumerate() {
        svg.text("small muted", (left + (column as f64 + 0.5) * CELL[0], bottom + 14.0), Anchor::Middle, name);
    }
    for (row, name) in panel.rows.iter().enumerate() {
        svg.text("small muted", (left - 6.0, bottom - (row as f64 + 0.5) * CELL[1] + 4.0), Anchor::End, name);
    }
    let across = panel.columns.len() as f64 * CELL[0];
    svg.text("small muted", (left + across, bottom + 30.0), Anchor::End, panel.across);
    svg.text("small muted", (left - 6.0, bottom + 14.0), Anchor::End, panel.up);
}

fn percent(share: f64) -> String {
    format!("{} %", plain(100.0 * share, 2))
}

/// The values of some trials, each once, in order.
fn different<T>(trials: &[T], value: impl Fn(&T) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = trials.iter().map(value).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

fn place(values: &[f64], value: f64) -> usize {
    values.iter().position(|other| *other == value).unwrap_or(0)
}

fn steps(map: &GrainMap) -> Panel {
    let columns = different(&map.steps, |trial: &StepTrial| trial.allowed);
    let rows = different(&map.steps, |trial: &StepTrial| trial.share);
    let cell = |trial: &StepTrial| {
        let (class, sign) = if trial.stopped.is_some() { ("e3", "\u{25b2} ") } else { ("e0", "") };
        let under = if trial.is_against_theory() { "\u{2260} theory" } else { "" };
        let text = format!("{sign}{} us", plain(1e6 * trial.step, 3));
        (place(&columns, trial.allowed), place(&rows, trial.share), Cell { class, text, under: under.to_owned() })
    };
    Panel {
        title: "steps: \u{25b2} the motion grows, the bed is stopped",
        across: "inertia that may be added, of the mass",
        up: "step / limit",
        cells: map.steps.iter().map(cell).collect(),
        columns: columns.iter().map(|share| percent(*share)).collect(),
        rows: rows.iter().map(|share| plain(*share, 3)).collect(),
    }
}

fn speeds(map: &GrainMap) -> Panel {
    let columns = different(&map.speeds, |trial: &SpeedTrial| trial.allowed);
    let rows = different(&map.speeds, |trial: &SpeedTrial| trial.factor);
    let cell = |trial: &SpeedTrial| {
        let change = map.change(trial.allowed, trial.factor);
        let class = match change {
            Some(change) if change.abs() > crate::trials::MATTERS => "e3",
            Some(_) => "e0",
            None => "e4",
        };
        let cell = if trial.allowed == 0.0 {
            Cell { class, text: format!("{} MN/m", plain(trial.stiffness / 1e6, 3)), under: String::new() }
        } else {
            let theory = map.change_in_theory(trial.allowed, trial.factor);
            Cell { class, text: change.map_or(String::new(), percent), under: theory.map_or(String::new(), percent) }
        };
        (place(&columns, trial.allowed), place(&rows, trial.factor), cell)
    };
    Panel {
        title: "speeds: stiffness, and its change by inertia (below: theory)",
        across: "inertia that may be added, of the mass",
        up: "km/h",
        cells: map.speeds.iter().map(cell).collect(),
        columns: columns.iter().map(|share| percent(*share)).collect(),
        rows: rows.iter().map(|factor| plain(3.6 * map.speed * factor, 3)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nodes::StepOfCell;

    #[test]
    fn a_picture_shows_where_steps_grow_and_where_inertia_matters() {
        let step = StepOfCell { step: 20e-6, limit: 25e-6, added: 0.01 };
        let trial = |share: f64| StepTrial {
            allowed: 0.02,
            added: 0.01,
            share,
            step: share * 25e-6,
            stopped: (share > 1.0).then(|| "it grows".to_owned()),
        };
        let passed = |allowed: f64, factor: f64, stiffness| SpeedTrial { allowed, factor, stiffness, settled: 1e-4 };
        let map = GrainMap {
            section: "open".into(),
            sleeper: "-4".into(),
            speed: 20.0,
            allowed: 0.02,
            at_rest: step,
            loaded: step,
            steps: vec![trial(0.9), trial(1.1)],
            speeds: vec![
                passed(0.0, 1.0, 90e6),
                passed(0.0, 2.0, 90e6),
                passed(0.2, 1.0, 99e6),
                passed(0.2, 2.0, 90e6),
            ],
        };
        let svg = grain_map_svg(&map, "scene");
        assert!(roxmltree::Document::parse(&svg).is_ok());
        for shown in ["\u{25b2} 27.5 us", "22.5 us", "10 %", "144", "times below the limit"] {
            assert!(svg.contains(shown), "{shown}: {svg}");
        }
    }
}
