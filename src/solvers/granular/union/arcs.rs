//! The uncovered parts of a circle, and the integrals of cosines and sines over them.

use std::f64::consts::{PI, TAU};

/// Covered intervals of a circle; the buffer is reused from circle to circle.
#[derive(Debug, Default)]
pub struct Arcs {
    covered: Vec<(f64, f64)>,
    whole: bool,
}

/// `∫ cosᵖ φ sin^q φ dφ` over arcs; the name is c to the p, s to the q.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Trig {
    pub c: f64,
    pub cc: f64,
    pub ccc: f64,
    pub cccc: f64,
    pub cs: f64,
    pub ccs: f64,
    pub cccs: f64,
    pub css: f64,
    pub ccss: f64,
}

impl Arcs {
    pub fn clear(&mut self) {
        self.covered.clear();
        self.whole = false;
    }

    /// Covers the whole circle.
    pub fn cover_all(&mut self) {
        self.whole = true;
    }

    /// Covers the angles within `half` (0 to π) of `centre` (-π to π).
    fn cover(&mut self, centre: f64, half: f64) {
        let start = centre - half;
        let start = if start < 0.0 { start + TAU } else { start };
        let end = start + 2.0 * half;
        if end > TAU {
            self.covered.push((start, TAU));
            self.covered.push((0.0, end - TAU));
        } else {
            self.covered.push((start, end));
        }
    }

    /// Covers the angles φ with `cos(φ - centre) > cosine`.
    pub fn cover_beyond(&mut self, centre: f64, cosine: f64) {
        if cosine <= -1.0 {
            self.cover_all();
        } else if cosine < 1.0 {
            self.cover(centre, cosine.acos());
        }
    }

    /// The integrals over the uncovered parts.
    pub fn open(&mut self) -> Trig {
        let mut sum = Trig::default();
        if self.whole {
            return sum;
        }
        if self.covered.is_empty() {
            return Trig::CIRCLE;
        }
        self.covered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut reached = 0.0;
        for &(start, end) in &self.covered {
            if start > reached {
                sum.add_arc(reached, start);
            }
            reached = f64::max(reached, end);
        }
        if reached < TAU {
            sum.add_arc(reached, TAU);
        }
        sum
    }
}

impl Trig {
    pub const CIRCLE: Self =
        Self { c: 0.0, cc: PI, ccc: 0.0, cccc: 0.75 * PI, cs: 0.0, ccs: 0.0, cccs: 0.0, css: 0.0, ccss: 0.25 * PI };

    /// The integrals over the rest of the circle.
    pub fn rest(&self) -> Self {
        let all = Self::CIRCLE;
        Self {
            c: all.c - self.c,
            cc: all.cc - self.cc,
            ccc: all.ccc - self.ccc,
            cccc: all.cccc - self.cccc,
            cs: all.cs - self.cs,
            ccs: all.ccs - self.ccs,
            cccs: all.cccs - self.cccs,
            css: all.css - self.css,
            ccss: all.ccss - self.ccss,
        }
    }

    fn add_arc(&mut self, from: f64, to: f64) {
        self.add_primitive(to, 1.0);
        self.add_primitive(from, -1.0);
    }

    fn add_primitive(&mut self, angle: f64, sign: f64) {
        let (s, c) = angle.sin_cos();
        let (ss, cc) = (s * s, c * c);
        self.c += sign * s;
        self.cc += sign * 0.5 * (angle + s * c);
        self.ccc += sign * s * (1.0 - ss / 3.0);
        self.cccc += sign * (3.0 * (angle + s * c) + 2.0 * s * c * cc) / 8.0;
        self.cs += sign * 0.5 * ss;
        self.ccs -= sign * c * cc / 3.0;
        self.cccs -= sign * 0.25 * cc * cc;
        self.css += sign * s * ss / 3.0;
        self.ccss += sign * (angle - s * c * (1.0 - 2.0 * ss)) / 8.0;
    }
}
