//! Frame of the data on a picture: the plane between two axes, and round marks on them.

use super::number::ticks;
use super::svg::Frame;

/// The plane of the data, and how it lies on the picture.
pub(super) struct Plane {
    pub frame: Frame,
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub downwards: bool,
    /// Whether an axis is logarithmic: across, upwards.
    pub logarithmic: [bool; 2],
}

impl Plane {
    pub fn point_at(&self, point: (f64, f64)) -> (f64, f64) {
        let share = |value: f64, (low, high): (f64, f64), logarithmic: bool| {
            if logarithmic { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
        };
        let across = share(point.0, self.x, self.logarithmic[0]);
        let up = share(point.1, self.y, self.logarithmic[1]);
        let down = if self.downwards { up } else { 1.0 - up };
        (self.frame.x + across * self.frame.width, self.frame.y + down * self.frame.height)
    }

    /// The values at a place of the picture: the inverse of [`Plane::point_at`].
    pub fn value_at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let value = |share: f64, (low, high): (f64, f64), logarithmic: bool| {
            if logarithmic { low * (high / low).powf(share) } else { low + share * (high - low) }
        };
        let down = (y - self.frame.y) / self.frame.height;
        let up = if self.downwards { down } else { 1.0 - down };
        let across = (x - self.frame.x) / self.frame.width;
        (value(across, self.x, self.logarithmic[0]), value(up, self.y, self.logarithmic[1]))
    }
}

/// Marks of a logarithmic axis: powers of ten, and values between them if needed for at least two marks.
pub(super) fn decades(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let marks = |parts: &[f64]| -> Vec<f64> {
        let all = (first..=last).flat_map(|power| parts.iter().map(move |part| part * 10f64.powi(power)));
        all.filter(|mark| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(mark)).collect()
    };
    let sets: [&[f64]; 3] = [&[1.0], &[1.0, 2.0, 5.0], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]];
    let from = if last - first > 4 { 0 } else { 1 };
    let enough = sets[from..].iter().map(|parts| marks(parts)).find(|marks| marks.len() > 1);
    let finer = || (3..20).map(|count| ticks(low, high, count)).find(|marks| marks.len() > 1);
    enough.or_else(finer).unwrap_or_default()
}

pub(super) fn rows(height: f64) -> usize {
    ((height / 36.0) as usize).max(2)
}

pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    widened(values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v))))
}

/// A range that has a length.
pub(super) fn widened((low, high): (f64, f64)) -> (f64, f64) {
    if !(low.is_finite() && high.is_finite()) {
        return (0.0, 1.0);
    }
    let least = (low.abs().max(high.abs()) * 1e-6).max(1e-9);
    if high - low > least { (low, high) } else { (low - 500.0 * least, high + 500.0 * least) }
}

pub(super) fn finite(point: &(f64, f64)) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_logarithmic_axis_has_two_marks_at_least() {
        assert_eq!(decades(0.5, 20.0), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(decades(300.0, 900.0), [300.0, 400.0, 500.0, 600.0, 700.0, 800.0, 900.0]);
        assert_eq!(decades(0.02, 3000.0), [0.1, 1.0, 10.0, 100.0, 1000.0]);
        for (low, high) in [(2.1, 2.9), (98.0, 99.0), (6.0, 6.4), (1.0, 1.0005), (9.9e-4, 1.01e-3)] {
            let marks = decades(low, high);
            assert!(marks.len() > 1 && marks.iter().all(|mark| (low..=high).contains(mark)), "{low} {high}: {marks:?}");
        }
    }

    #[test]
    fn places_and_values_are_inverse() {
        let frame = Frame { x: 56.0, y: 20.0, width: 800.0, height: 240.0 };
        for (downwards, logarithmic) in [(false, [false; 2]), (true, [true, false]), (true, [true; 2])] {
            let plane = Plane { frame, x: (0.5, 40.0), y: (1e-3, 2.0), downwards, logarithmic };
            let (x, y) = plane.value_at(plane.point_at((3.0, 0.25)));
            assert!((x - 3.0).abs() < 1e-9 && (y - 0.25).abs() < 1e-9, "{x} {y}");
        }
    }
}
