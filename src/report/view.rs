//! A window on the track, and its places on the picture.

use super::svg::Frame;
use crate::scenario::{Loading, Scenario, Section};

pub(super) const WIDTH: f64 = 900.0;
pub(super) const MARGIN: f64 = 26.0;
/// Thickness of a drawn rail pad, m.
const PAD: f64 = 0.035;

/// Depth of a section's rail seats, m, below the top of what is drawn: of the rail, or of the sleepers where there is
/// none.
pub(super) fn seat_depth(section: &Section) -> f64 {
    section.rail.as_ref().map_or(0.0, |rail| rail.height + PAD)
}

/// Height of the ballast beside a sleeper in the drawing, m above the underside of the sleeper. A scene with grains
/// shows the crib that it states, or none. Other scenes show three quarters of the sleeper's height.
pub(super) fn height_beside(scenario: &Scenario, section: &Section, sleeper: f64) -> f64 {
    let rig = matches!(scenario.loading, Some(Loading::Rig(_)));
    match &section.crib {
        Some(crib) => *crib.height,
        None if rig || scenario.solve.grains.tier.has_grains() => 0.0,
        None => 0.75 * sleeper,
    }
}

/// Scale, px per metre: as wide as the picture allows, but limited so that a short rig does not become too high.
pub(super) fn scale(length: f64) -> f64 {
    ((WIDTH - 2.0 * MARGIN) / length).min((400.0 / length).clamp(90.0, 200.0))
}

/// A window on the track at one scale.
pub(super) struct View {
    /// Chainage at the left edge, m, and length shown, m.
    pub start: f64,
    pub end: f64,
    pub scale: f64,
    /// Top of the rail on the picture, px.
    pub rail: f64,
}

impl View {
    pub fn x(&self, chainage: f64) -> f64 {
        MARGIN + (chainage - self.start) * self.scale
    }

    /// Place of a height below the rail's top, m.
    pub fn y(&self, below: f64) -> f64 {
        self.rail + below * self.scale
    }

    pub fn shows(&self, x: f64) -> bool {
        x >= self.start - 1e-6 && x <= self.end + 1e-6
    }

    /// A box of the world, m: left and right chainage, top and bottom below the rail's top.
    pub fn area(&self, left: f64, right: f64, top: f64, bottom: f64) -> Frame {
        let (left, right) = (left.max(self.start), right.min(self.end));
        Frame {
            x: self.x(left),
            y: self.y(top),
            width: (right - left) * self.scale,
            height: (bottom - top) * self.scale,
        }
    }
}
