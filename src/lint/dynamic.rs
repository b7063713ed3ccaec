//! Amplification of a static load by speed, from design rules.

/// Quality of the track: 0.1 is very good, 0.2 good, 0.3 poor.
const QUALITY: f64 = 0.2;
/// Number of standard deviations: 99.7 % of loads stay below.
const SAFETY: f64 = 3.0;

/// `1 + t n (1 + (V - 60) / 380)` with V in km/h, at least 60 (Eisenmann 1993, for passenger trains up to 300 km/h; the
/// factor for freight grows faster). `speed` in m/s. Taken from textbooks, unchecked against the paper.
pub(super) fn amplification(speed: f64) -> f64 {
    let above = (speed * 3.6 - 60.0).max(0.0);
    1.0 + SAFETY * QUALITY * (1.0 + above / 380.0)
}
