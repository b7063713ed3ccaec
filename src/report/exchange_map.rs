//! The picture of an exchange map: axles that have passed to the right, axles of a block upwards. The shade is the
//! growth of a disturbance in a block; the number in a cell is the measured growth, below it the growth in theory.

use super::number::{plain, whole};
use super::svg::{Anchor, Frame, Svg};
use crate::execute::Disturbance;
use crate::trials::ExchangeMap;

const CELL: [f64; 2] = [64.0, 34.0];
const LEFT: f64 = 84.0;
const TOP: f64 = 92.0;
const GAP: f64 = 60.0;

/// Which growth of a cell a panel shows.
type Growth = fn(&Disturbance) -> f64;

/// The whole picture.
pub fn exchange_map_svg(map: &ExchangeMap, title: &str) -> String {
    let mut counts: Vec<u64> = map.cells.iter().map(|cell| cell.axles).collect();
    counts.dedup();
    let mut sizes: Vec<u64> = map.cells.iter().map(|cell| cell.block_axles).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let [across, up] = [counts.len() as f64 * CELL[0], sizes.len() as f64 * CELL[1]];
    let mut svg = Svg::default();
    svg.text("strong", (16.0, 24.0), Anchor::Start, &format!("{title}: exchange of forces and settlement"));
    let under = "Growth of a sawtooth in the settlement per block: measured, and in theory below. \u{25b2} grows.";
    svg.text("small muted", (16.0, 42.0), Anchor::Start, under);
    let panels: [(&str, Growth); 2] = [
        ("forces stay over the block", |cell| cell.stays),
        ("forces follow within the block (adaptive)", |cell| cell.follows),
    ];
    for (panel, (name, growth)) in panels.into_iter().enumerate() {
        let left = LEFT + panel as f64 * (across + GAP);
        svg.text("small strong", (left, TOP - 10.0), Anchor::Start, name);
        for cell in &map.cells {
            let column = counts.iter().position(|axles| *axles == cell.axles).unwrap_or(0) as f64;
            let row = sizes.iter().position(|axles| *axles == cell.block_axles).unwrap_or(0) as f64;
            let (x, y) = (left + column * CELL[0], TOP + up - (row + 1.0) * CELL[1]);
            let frame = Frame { x, y, width: CELL[0] - 1.0, height: CELL[1] - 1.0 };
            let theory = (panel == 0).then_some(cell.in_theory);
            draw(&mut svg, frame, (growth(cell), theory));
        }
        for (column, axles) in counts.iter().enumerate() {
            let x = left + (column as f64 + 0.5) * CELL[0];
            svg.text("small muted", (x, TOP + up + 14.0), Anchor::Middle, &whole(*axles));
        }
        svg.text("small muted", (left + across, TOP + up + 30.0), Anchor::End, "axles before the block");
        for (row, axles) in sizes.iter().enumerate() {
            let y = TOP + up - (row as f64 + 0.5) * CELL[1] + 4.0;
            svg.text("small muted", (left - 6.0, y), Anchor::End, &whole(*axles));
        }
        svg.text("small muted", (left - 6.0, TOP + up + 14.0), Anchor::End, "axles");
    }
    svg.finish(LEFT + 2.0 * (across + GAP), TOP + up + 44.0, &format!("Exchange of {title}"))
}

fn draw(svg: &mut Svg, frame: Frame, (growth, theory): (f64, Option<f64>)) {
    let class = match growth {
        growth if growth > 1.0 => "e3",
        growth if growth > 0.5 => "e1",
        _ => "e0",
    };
    svg.titled_rect(class, frame, "");
    let sign = if growth > 1.0 { "\u{25b2} " } else { "" };
    let middle = frame.x + frame.width / 2.0;
    let top = if theory.is_some() { 14.0 } else { 20.0 };
    svg.text("small", (middle, frame.y + top), Anchor::Middle, &format!("{sign}{}", plain(growth, 2)));
    if let Some(theory) = theory {
        svg.text("small muted", (middle, frame.y + 27.0), Anchor::Middle, &plain(theory, 2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_shows_both_kinds_of_blocks_and_where_they_grow() {
        let cell = |axles, block_axles, amplification: f64, stays, follows| Disturbance {
            axles,
            block_axles,
            amplification,
            in_theory: (1.0 - amplification).abs(),
            stays,
            follows,
        };
        let cells = vec![cell(0, 4, 0.2, 0.81, 0.8), cell(0, 80, 4.0, 2.9, 0.4), cell(100, 4, 0.1, 0.9, 0.9)];
        let map = ExchangeMap { cells, blocks: vec![[0, 20], [20, 80]], adaptive: false };
        let svg = exchange_map_svg(&map, "scene");
        assert!(roxmltree::Document::parse(&svg).is_ok());
        assert!(svg.contains("\u{25b2} 2.9") && svg.contains("forces follow within the block"), "{svg}");
        // between 4 axles (0.2) and 80 axles (4)
        assert!((map.limit(0).unwrap() - 40.0).abs() < 1e-9);
        assert_eq!((map.limit(100), map.longest(100)), (None, 4));
        let (block, margin) = map.margin().unwrap();
        assert!(block == [20, 80] && (margin - 0.5).abs() < 1e-9, "{block:?} {margin}");
        assert_eq!(map.against_theory(), 0);
    }
}
