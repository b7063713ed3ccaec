//! One count of the section: levels, then grains under their sleepers, then forces.

use super::Scales;
use super::window::Window;
use crate::report::bed::Raster;
use crate::report::number::{nice_step, significant, tick_label, ticks};
use crate::report::svg::{Anchor, Frame, Svg};
use crate::results::{BedsAtCount, Grain, RailRow, Run, SleeperRow};
use crate::scenario::SleeperBody;

/// Height of the levels, px.
const LEVELS: f64 = 54.0;
/// Between the parts, px.
const GAP: f64 = 30.0;
/// Widest line of a force, px, and how many widths there are.
const WIDEST: f64 = 4.0;
const WIDTHS: usize = 12;
/// Share of the widest force below which no line is drawn.
pub(super) const WEAKEST: f64 = 0.03;
/// The rail lies so far above its sleepers, px.
const RAIL: f64 = 3.0;
/// Room over the sleepers, px.
const ROOM: f64 = 10.0;

pub struct Layer<'a> {
    pub run: &'a Run,
    pub beds: &'a BedsAtCount,
    /// The same under a train, if it was recorded.
    pub loaded: Option<&'a BedsAtCount>,
    pub window: &'a Window,
    pub scales: &'a Scales,
}

impl Layer<'_> {
    /// Draws the count from a place downwards, px, and gives where it ends.
    pub fn draw(&self, svg: &mut Svg, top: f64) -> f64 {
        let seats = self.seats();
        let height = seats.iter().map(|(body, _)| body.height).fold(0.2, f64::max);
        self.draw_levels(svg, top, &seats);
        let top = top + LEVELS + GAP;
        let base = top + self.scales.hanging + ROOM + height * self.window.scale;
        let bottom = base + self.window.depth * self.window.scale;
        self.draw_structure(svg, base - height * self.window.scale, bottom);
        self.draw_grains(svg, base);
        self.draw_sleepers(svg, base, &seats);
        self.draw_edge(svg, top, bottom);
        self.draw_heights(svg, base, bottom);
        let top = bottom + GAP;
        let end = top + self.window.depth * self.window.scale;
        svg.text("small", (self.window.x(self.window.from), top - 9.0), Anchor::Start, &self.about_forces());
        self.draw_structure(svg, top, end);
        self.draw_forces(svg, top, end);
        self.draw_edge(svg, top, end);
        self.draw_heights(svg, top, end);
        self.draw_chainage(svg, end)
    }

    fn frame(&self, top: f64, bottom: f64) -> Frame {
        let (left, right) = (self.window.x(self.window.from), self.window.x(self.window.to));
        Frame { x: left, y: top, width: right - left, height: bottom - top }
    }

    /// Sleepers that are shown, with their rows.
    fn seats(&self) -> Vec<(SleeperBody, &SleeperRow)> {
        let rows = self.run.sleepers.iter().filter(|row| row.axles == self.beds.axles);
        let seats = self.run.scenario.track.seats.iter().zip(rows);
        let shown = seats.filter(|(seat, _)| self.window.holds(seat.x));
        shown.filter_map(|(seat, row)| Some((seat.sleeper?, row))).collect()
    }

    /// Rail and supports, lowered by their settlement.
    fn draw_levels(&self, svg: &mut Svg, top: f64, seats: &[(SleeperBody, &SleeperRow)]) {
        let Window { from, to, .. } = *self.window;
        let (left, right) = (self.window.x(from), self.window.x(to));
        let lowered = |level: f64| top + level * self.scales.exaggeration * self.window.scale;
        svg.line("grid", (left, top), (right, top));
        svg.text("small muted", (left - 6.0, top + 4.0), Anchor::End, "0 mm");
        let rail = |row: &&RailRow| row.axles == self.beds.axles && self.window.holds(row.x_m);
        let rail = self.run.rail.iter().filter(rail).map(|row| (self.window.x(row.x_m), lowered(row.level_m)));
        let supports = seats.iter().map(|(_, row)| (self.window.x(row.x_m), lowered(row.settlement_m)));
        svg.path("line s1", &supports.collect::<Vec<_>>(), false, "supports");
        svg.path("line s0", &rail.collect::<Vec<_>>(), false, "rail");
        let x = right - 150.0;
        for (at, class, name) in [(x, "line s0", "rail"), (x + 62.0, "line s1", "supports")] {
            svg.line(class, (at, top - 12.0), (at + 18.0, top - 12.0));
            svg.text("small", (at + 23.0, top - 8.0), Anchor::Start, name);
        }
        let unit = nice_step(0.5 * LEVELS / (self.scales.exaggeration * self.window.scale));
        svg.line("grid", (left, lowered(unit)), (right, lowered(unit)));
        let label = format!("{} mm", significant(1e3 * unit, 2));
        svg.text("small muted", (left - 6.0, lowered(unit) + 4.0), Anchor::End, &label);
    }

    fn draw_structure(&self, svg: &mut Svg, top: f64, bottom: f64) {
        let Some([from, to]) = self.window.structure else { return };
        let (left, right) = (self.window.x(from), self.window.x(to));
        svg.rect("slab", Frame { x: left, y: top, width: right - left, height: bottom - top });
    }

    fn draw_edge(&self, svg: &mut Svg, top: f64, bottom: f64) {
        let Some([from, to]) = self.window.structure else { return };
        let x = self.window.x(if from > self.window.from { from } else { to });
        svg.line("mark", (x, top), (x, bottom));
    }

    /// Visible grains, the farthest first; heights count from a place of the picture, px.
    fn draw_grains(&self, svg: &mut Svg, base: f64) {
        let (window, scale) = (self.window, self.window.scale);
        let mut grains: Vec<&Grain> = self.beds.grains.iter().filter(|g| window.holds(g.place[0])).collect();
        grains.sort_by(|a, b| a.place[1].total_cmp(&b.place[1]));
        let frame = self.frame(base - ROOM, base + window.depth * scale);
        let at = |grain: &Grain| (window.x(grain.place[0]), base - grain.place[2] * scale);
        let mut raster = Raster::new(frame.width, frame.height);
        grains.retain(|grain| {
            let (x, y) = at(grain);
            raster.cover(x - frame.x, y - frame.y, grain.radius * scale)
        });
        svg.group(r#"class="grains" stroke-width=".3""#, |svg| {
            for grain in grains.iter().rev() {
                svg.ball(&format!("url(#g{})", self.scales.bar.ball(grain)), at(grain), grain.radius * scale);
            }
        });
    }

    /// Sleepers over their enlarged voids, and the rail over them.
    fn draw_sleepers(&self, svg: &mut Svg, base: f64, seats: &[(SleeperBody, &SleeperRow)]) {
        let scale = self.window.scale;
        let mut tops = Vec::new();
        for (body, row) in seats {
            let (left, width) = (self.window.x(row.x_m - 0.5 * body.base_width), body.base_width * scale);
            let lifted = row.void_m.max(0.0) * self.scales.exaggeration * scale;
            let void = format!("{}: void {} mm", row.sleeper, significant(1e3 * row.void_m, 2));
            svg.titled_rect("void", Frame { x: left, y: base - lifted, width, height: lifted }, &void);
            let top = base - lifted - body.height * scale;
            svg.titled_rect("sleeper", Frame { x: left, y: top, width, height: body.height * scale }, &void);
            tops.push((left + 0.5 * width, top - RAIL));
        }
        if let (Some([from, to]), Some((body, _))) = (self.window.structure, seats.first()) {
            let top = base - body.height * scale - RAIL;
            let mut ends = vec![(self.window.x(from), top), (self.window.x(to), top)];
            match from > self.window.from {
                true => tops.append(&mut ends),
                false => tops = [ends, tops].concat(),
            }
        }
        svg.path("rail", &tops, false, "rail");
    }

    /// The beds with the forces that are shown, the force of the widest line, N, and the moment as text.
    fn forces(&self) -> (&BedsAtCount, f64, &'static str) {
        let [rest, under_train] = self.scales.forces;
        match self.loaded {
            Some(loaded) => (loaded, under_train, "under the leading bogie of the next train"),
            None => (self.beds, rest, "without a train"),
        }
    }

    fn about_forces(&self) -> String {
        let (_, force, when) = self.forces();
        format!("Contact forces {when}; widest line: {} kN", significant(force / 1e3, 2))
    }

    /// Lines of each width as one path, the thinnest first.
    fn draw_forces(&self, svg: &mut Svg, base: f64, bottom: f64) {
        let (beds, most, _) = self.forces();
        let window = self.window;
        let mut lines: Vec<Vec<[(f64, f64); 2]>> = vec![Vec::new(); WIDTHS];
        let at = |place: [f64; 3]| (window.x(place[0]), base - place[2] * window.scale);
        for link in beds.links.iter().filter(|link| window.holds(link.from[0]) && window.holds(link.to[0])) {
            let share = (link.size() / most.max(f64::MIN_POSITIVE)).min(1.0);
            if share >= WEAKEST {
                let width = ((share * WIDTHS as f64) as usize).min(WIDTHS - 1);
                lines[width].push([at(link.from), at(link.to)]);
            }
        }
        svg.clipped(&format!("forces-{}-{:.0}", self.beds.axles, base), self.frame(base, bottom), |svg| {
            for (width, lines) in lines.iter().enumerate() {
                let share = (width as f64 + 0.5) / WIDTHS as f64;
                svg.group(
                    &format!(
                        r#"class="chain" stroke-width="{:.2}" stroke-opacity="{:.2}""#,
                        WIDEST * share,
                        0.35 + 0.65 * share.sqrt()
                    ),
                    |svg| svg.strokes(lines),
                );
            }
        });
    }

    /// Heights in m along the left edge, from a place of the picture (px).
    fn draw_heights(&self, svg: &mut Svg, base: f64, bottom: f64) {
        let left = self.window.x(self.window.from) - 6.0;
        let step = nice_step(0.5 * self.window.depth);
        for tick in ticks(-self.window.depth, 0.0, 3) {
            let y = base - tick * self.window.scale;
            if y <= bottom {
                svg.line("axis", (left, y), (left + 4.0, y));
                svg.text("small muted", (left - 2.0, y + 4.0), Anchor::End, &tick_label(tick, step));
            }
        }
    }

    fn draw_chainage(&self, svg: &mut Svg, bottom: f64) -> f64 {
        let Window { from, to, .. } = *self.window;
        let step = nice_step((to - from) / 8.0);
        for tick in ticks(from, to, 8) {
            let x = self.window.x(tick);
            svg.line("axis", (x, bottom + 3.0), (x, bottom + 7.0));
            svg.text("small muted", (x, bottom + 19.0), Anchor::Middle, &tick_label(tick, step));
        }
        svg.text("small muted", (self.window.x(to), bottom + 33.0), Anchor::End, "Chainage [m], heights [m]");
        bottom + 36.0
    }
}
