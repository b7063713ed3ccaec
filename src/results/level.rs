//! Longitudinal level D1 of EN 13848-1: a vertical profile filtered to wavelengths of 3 .. 25 m.
//!
//! The filter is a Butterworth high pass at 25 m and low pass at 3 m, each of fourth order, run over the profile and
//! back, so that nothing is shifted: its gain is `1 / (1 + (f1/f)^8) / (1 + (f/f2)^8)`, one half at both limits (the
//! order is common practice and unchecked against the standard's text). Beyond its ends the profile goes on level for
//! [`PAD`] on each side: a model is shorter than the filter's memory, and this adds neither slope nor waves.

/// Distance of samples, m.
const STEP: f64 = 0.1;
/// Level stretch on each side, m: the filter has forgotten a step after it to 1e-6.
const PAD: f64 = 150.0;
/// Wavelengths between which a defect counts, m.
const BAND: (f64, f64) = (3.0, 25.0);
/// Quality factors of the two second-order parts of a fourth-order Butterworth filter.
const QUALITIES: [f64; 2] = [0.541_196_100_146_197, 1.306_562_964_876_377];

/// A filtered profile.
#[derive(Debug, Clone, PartialEq)]
pub struct LongitudinalLevel {
    /// Chainage and level, m, downward as in the profile.
    pub points: Vec<(f64, f64)>,
    /// Largest distance from zero, m.
    pub peak: f64,
    /// Standard deviation over the length of the model, m.
    pub deviation: f64,
}

/// Filters a profile of chainage (ascending) and level, m; `None` if it has no length.
pub fn longitudinal_level(profile: &[(f64, f64)]) -> Option<LongitudinalLevel> {
    let (first, last) = (profile.first()?, profile.last()?);
    let steps = ((last.0 - first.0) / STEP).round() as usize;
    if steps == 0 {
        return None;
    }
    let step = (last.0 - first.0) / steps as f64;
    let pad = (PAD / step).ceil() as usize;
    // measured from the left end's level, so that the filters start at rest
    let mut samples = vec![0.0; pad];
    samples.extend((0..=steps).map(|k| value_at(profile, first.0 + step * k as f64) - first.1));
    samples.extend(std::iter::repeat_n(last.1 - first.1, pad));
    for _ in 0..2 {
        for quality in QUALITIES {
            Section::high_pass(step / BAND.1, quality).run(&mut samples);
            Section::low_pass(step / BAND.0, quality).run(&mut samples);
        }
        samples.reverse();
    }
    let inside = &samples[pad..=pad + steps];
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    let variance = inside.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / inside.len() as f64;
    Some(LongitudinalLevel {
        points: inside.iter().enumerate().map(|(k, y)| (first.0 + step * k as f64, *y)).collect(),
        peak: inside.iter().map(|y| y.abs()).fold(0.0, f64::max),
        deviation: variance.sqrt(),
    })
}

/// The profile at x, linear between its points.
pub(super) fn value_at(profile: &[(f64, f64)], x: f64) -> f64 {
    let right = profile.partition_point(|point| point.0 < x).clamp(1, profile.len() - 1);
    let (a, b) = (profile[right - 1], profile[right]);
    if b.0 > a.0 { a.1 + (b.1 - a.1) * ((x - a.0) / (b.0 - a.0)).clamp(0.0, 1.0) } else { b.1 }
}

/// A second-order filter `b0 x + b1 x' + b2 x'' - a1 y' - a2 y''`, of the bilinear transform with its limit kept.
struct Section {
    forward: [f64; 3],
    back: [f64; 2],
}

impl Section {
    /// `frequency` is in cycles a sample.
    fn low_pass(frequency: f64, quality: f64) -> Self {
        let cosine = (std::f64::consts::TAU * frequency).cos();
        Section::new(frequency, quality, [0.5 * (1.0 - cosine), 1.0 - cosine, 0.5 * (1.0 - cosine)])
    }

    fn high_pass(frequency: f64, quality: f64) -> Self {
        let cosine = (std::f64::consts::TAU * frequency).cos();
        Section::new(frequency, quality, [0.5 * (1.0 + cosine), -(1.0 + cosine), 0.5 * (1.0 + cosine)])
    }

    fn new(frequency: f64, quality: f64, numerator: [f64; 3]) -> Self {
        let angle = std::f64::consts::TAU * frequency;
        let alpha = angle.sin() / (2.0 * quality);
        let scale = 1.0 / (1.0 + alpha);
        Section { forward: numerator.map(|b| b * scale), back: [-2.0 * angle.cos() * scale, (1.0 - alpha) * scale] }
    }

    /// Filters in place, from rest (transposed direct form).
    fn run(&self, samples: &mut [f64]) {
        let (mut one, mut two) = (0.0, 0.0);
        for sample in samples {
            let x = *sample;
            let y = self.forward[0] * x + one;
            one = self.forward[1] * x - self.back[0] * y + two;
            two = self.forward[2] * x - self.back[1] * y;
            *sample = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(length: f64, level: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..=(length / 0.15) as usize).map(|k| 0.15 * k as f64).map(|x| (x, level(x))).collect()
    }

    /// Amplitude of a long sine's middle part after the filter, and its shift in m.
    fn gain(wavelength: f64) -> (f64, f64) {
        let wave = std::f64::consts::TAU / wavelength;
        let filtered = longitudinal_level(&profile(1200.0, |x| (wave * x).sin())).unwrap();
        let periods = (300.0 / wavelength).floor() * wavelength;
        let inside = filtered.points.iter().filter(|p| p.0 >= 400.0 && p.0 < 400.0 + periods);
        let (mut sine, mut cosine, mut count) = (0.0, 0.0, 0.0);
        for (x, y) in inside {
            sine += y * (wave * x).sin();
            cosine += y * (wave * x).cos();
            count += 1.0;
        }
        (2.0 * sine.hypot(cosine) / count, cosine.atan2(sine) / wave)
    }

    #[test]
    fn waves_of_the_band_pass_where_they_are() {
        for wavelength in [5.0, 8.0, 10.0, 15.0] {
            let (gain, shift) = gain(wavelength);
            assert!((gain - 1.0).abs() < 0.03, "{wavelength} m: {gain}");
            assert!(shift.abs() < 0.01, "{wavelength} m: shifted by {shift} m");
        }
    }

    #[test]
    fn waves_outside_are_held_back() {
        for (wavelength, most) in [(1.2, 2e-3), (1.5, 6e-3), (50.0, 5e-3), (70.0, 1e-3)] {
            assert!(gain(wavelength).0 < most, "{wavelength} m: {}", gain(wavelength).0);
        }
        for wavelength in [BAND.0, BAND.1] {
            assert!((gain(wavelength).0 - 0.5).abs() < 0.02, "{wavelength} m: {}", gain(wavelength).0);
        }
    }

    #[test]
    fn a_step_leaves_half_of_itself_on_each_side() {
        let filtered = longitudinal_level(&profile(60.0, |x| if x < 30.0 { 1e-3 } else { 0.0 })).unwrap();
        assert!((0.4e-3..0.7e-3).contains(&filtered.peak), "{}", filtered.peak);
        // odd about the step: nothing is shifted
        let value =
            |x: f64| filtered.points.iter().min_by(|a, b| (a.0 - x).abs().total_cmp(&(b.0 - x).abs())).unwrap().1;
        for distance in [1.0, 2.5, 5.0, 10.0] {
            let (left, right) = (value(29.925 - distance), value(29.925 + distance));
            assert!((left + right).abs() < 0.05e-3, "{distance} m: {left} and {right}");
        }
        assert!(filtered.deviation > 0.0 && filtered.deviation < filtered.peak);
    }

    #[test]
    fn a_level_track_has_no_defect() {
        let filtered = longitudinal_level(&profile(66.0, |_| 1.25e-3)).unwrap();
        assert_eq!((filtered.peak, filtered.deviation), (0.0, 0.0));
        assert_eq!(longitudinal_level(&[(0.0, 1.0)]), None);
        assert_eq!(longitudinal_level(&[]), None);
    }

    #[test]
    fn the_ends_of_the_model_add_nothing() {
        // the same dip in a short and in a long model
        let dip = |middle: f64| move |x: f64| 1e-3 * (-((x - middle) / 2.0).powi(2)).exp();
        let short = longitudinal_level(&profile(60.0, dip(30.0))).unwrap();
        let long = longitudinal_level(&profile(600.0, dip(300.0))).unwrap();
        assert!((short.peak / long.peak - 1.0).abs() < 1e-3, "{} and {}", short.peak, long.peak);
    }
}
