//! Symbols of a section drawing: springs, stones and dimension lines, all in pixels.

use super::svg::{Frame, Svg};

/// A zigzag from `top` down to `bottom`, px.
pub(super) fn draw_spring(svg: &mut Svg, (x, top): (f64, f64), bottom: f64, half: f64) {
    let turns = 6;
    let lead = 0.16 * (bottom - top);
    let step = (bottom - top - 2.0 * lead) / f64::from(turns);
    let mut points = vec![(x, top), (x, top + lead)];
    for turn in 0..turns {
        let side = if turn % 2 == 0 { half } else { -half };
        points.push((x + side, top + lead + (f64::from(turn) + 0.5) * step));
    }
    points.extend([(x, bottom - lead), (x, bottom)]);
    svg.path("spring", &points, false, "");
}

/// Pebbles in rows, each row shifted, equal at every call.
pub(super) fn draw_stones(svg: &mut Svg, area: Frame, scale: f64) {
    let size = (0.11 * scale).clamp(3.0, 8.0);
    let mut y = area.y + 0.7 * size;
    let mut row = 0u32;
    let mut stones = Vec::new();
    while y < area.y + area.height {
        let mut x = area.x + if row.is_multiple_of(2) { 0.5 } else { 1.1 } * size;
        let mut count = row;
        while x < area.x + area.width {
            let r = 0.34 * size * (0.75 + 0.25 * f64::from((count * 7 + row * 3) % 5) / 4.0);
            stones.push([(x - r, y), (x - 0.3 * r, y - r), (x + r, y - 0.3 * r), (x + 0.4 * r, y + r)]);
            x += 1.25 * size;
            count += 1;
        }
        y += size;
        row += 1;
    }
    svg.outlines("stone", &stones);
}

/// A pad under a sleeper: to scale, but thick enough to be seen.
pub(super) fn draw_usp(svg: &mut Svg, area: Frame) {
    svg.titled_rect("usp", Frame { height: area.height.max(3.0), ..area }, "under sleeper pad");
}

/// A dimension line between two places, px.
pub(super) fn draw_dimension(svg: &mut Svg, from: f64, to: f64, y: f64) {
    svg.line("dim", (from, y), (to, y));
    for x in [from, to] {
        svg.line("dim", (x, y - 5.0), (x, y + 5.0));
        svg.line("dim", (x - 3.0, y + 3.0), (x + 3.0, y - 3.0));
    }
}
