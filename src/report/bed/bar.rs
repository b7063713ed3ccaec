//! The colours of a bed's picture, and the colour bar.

use super::super::colour_map::{colours, hex, shade};
use super::super::number::{nice_step, significant, tick_label, ticks};
use super::super::svg::{Anchor, Frame, Svg};
use super::{Colour, RIGHT, WIDTH};
use crate::results::Grain;

/// Colours of the bar.
const SHADES: usize = 24;
/// Share of the grains that may lie above the bar's end.
const ABOVE: f64 = 0.01;

/// The colours and their quantity.
pub struct Bar {
    name: &'static str,
    unit: &'static str,
    /// The unit in SI.
    size: f64,
    /// Value of the last colour, SI.
    most: f64,
    /// Largest value, SI.
    largest: f64,
    colour: Colour,
}

impl Bar {
    /// The bar of these grains.
    pub fn new<'a>(colour: Colour, grains: impl IntoIterator<Item = &'a Grain>) -> Bar {
        let mut values: Vec<f64> = grains.into_iter().filter_map(|g| value(g, colour)).collect();
        values.sort_by(f64::total_cmp);
        let largest = values.last().copied().unwrap_or(0.0);
        let usual = values.get(((1.0 - ABOVE) * values.len() as f64) as usize).copied().unwrap_or(largest);
        // a few outliers must not set the range of the colours
        let most = if largest > 1.5 * usual && usual > 0.0 { usual } else { largest };
        let step = nice_step(most.max(f64::MIN_POSITIVE) / 10.0);
        let most = if most > 0.0 { (most / step - 1e-9).ceil() * step } else { 1.0 };
        let (name, units): (_, &[(&str, f64)]) = match colour {
            Colour::Displacement => ("displacement", &[("m", 1.0), ("mm", 1e-3), ("\u{b5}m", 1e-6), ("nm", 1e-9)]),
            Colour::Speed => ("speed", &[("m/s", 1.0), ("mm/s", 1e-3), ("\u{b5}m/s", 1e-6)]),
            Colour::Force => ("largest contact force", &[("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3)]),
        };
        let fits = units.iter().find(|(_, size)| most >= *size).or(units.last());
        let (unit, size) = fits.copied().unwrap_or(("", 1.0));
        Bar { name, unit, size, most, largest, colour }
    }

    /// Balls of every colour, lit from above; one name for each, so that a grain takes few bytes.
    pub fn define(&self, svg: &mut Svg) {
        let mut text = String::from("<defs>");
        let grey = [150, 156, 163];
        for (number, colour) in colours(SHADES).into_iter().chain([grey]).enumerate() {
            let [lit, plain, dark] = [shade(colour, 0.28), colour, shade(colour, -0.30)].map(hex);
            text += &format!(
                concat!(
                    r#"<radialGradient id="g{}" cx=".42" cy=".34" r=".72"><stop stop-color="{}"/>"#,
                    r#"<stop offset=".5" stop-color="{}"/><stop offset="1" stop-color="{}"/></radialGradient>"#
                ),
                number, lit, plain, dark
            );
        }
        svg.define(&(text + "</defs>"));
    }

    pub fn draw(&self, svg: &mut Svg) {
        let (width, height, y) = (288.0, 11.0, 34.0);
        let x = WIDTH - RIGHT - width;
        let label = format!("{} [{}]", self.name, self.unit);
        svg.text("small", (x, y - 8.0), Anchor::Start, &label);
        let each = width / SHADES as f64;
        for (number, colour) in colours(SHADES).into_iter().enumerate() {
            // one past the other, so that no gap shows between them
            let frame = Frame {
                x: x + number as f64 * each,
                y,
                width: each + if number + 1 < SHADES { 0.6 } else { 0.0 },
                height,
            };
            svg.swatch(&hex(colour), frame);
        }
        let most = self.most / self.size;
        let step = nice_step(most / 5.0);
        for tick in ticks(0.0, most, 5) {
            let at = x + width * tick / most;
            svg.line("axis", (at, y + height), (at, y + height + 4.0));
            svg.text("small muted", (at, y + height + 16.0), Anchor::Middle, &tick_label(tick, step));
        }
        if self.largest > self.most {
            // the last colour goes on
            let last = colours(SHADES).last().map_or(String::new(), |c| hex(*c));
            let (right, middle) = (x + width, y + 0.5 * height);
            svg.polygon(&last, &[(right, y), (right + 9.0, middle), (right, y + height)]);
            let text = format!("up to {}", significant(self.largest / self.size, 2));
            svg.text("small muted", (right, y - 8.0), Anchor::End, &text);
        }
    }

    /// Name of a grain's ball.
    pub fn ball(&self, grain: &Grain) -> usize {
        let Some(value) = value(grain, self.colour) else { return SHADES };
        ((value / self.most * SHADES as f64).max(0.0) as usize).min(SHADES - 1)
    }
}

fn value(grain: &Grain, colour: Colour) -> Option<f64> {
    let size = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let value = match colour {
        Colour::Displacement => grain.displacement.map(size),
        Colour::Speed => Some(size(grain.velocity)),
        Colour::Force => Some(grain.largest_force),
    };
    value.filter(|v| v.is_finite())
}
