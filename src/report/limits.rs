//! Limits for results, from standards as they are commonly quoted; they were not checked against the texts of the
//! standards.

/// Sleeper on ballast, concrete sleepers (UIC), Pa.
pub const CONTACT_PRESSURE: f64 = 0.5e6;
/// Wheel on rail, vertical (EN 14363, depends on the class of the line), N.
pub const WHEEL_FORCE: f64 = 160e3;
/// Allowed unloading, as a share of the static wheel load.
pub const UNLOADING: f64 = 0.6;

/// Longitudinal level D1 of EN 13848-5, from mean to peak, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelLimits {
    /// Alert: the defect must be watched and its repair planned; a range, because networks choose different values.
    pub alert: (f64, f64),
    /// Intervention: the defect must be corrected soon.
    pub intervention: (f64, f64),
    /// Immediate action: speed restriction or closure.
    pub immediate: f64,
}

/// Limits (mm) up to each speed (km/h).
const LEVEL: [(f64, [f64; 5]); 5] = [
    (80.0, [12.0, 18.0, 17.0, 21.0, 28.0]),
    (120.0, [10.0, 16.0, 13.0, 19.0, 26.0]),
    (160.0, [8.0, 15.0, 10.0, 17.0, 23.0]),
    (230.0, [7.0, 12.0, 9.0, 14.0, 20.0]),
    (300.0, [6.0, 10.0, 8.0, 12.0, 16.0]),
];

/// The limits at a speed, m/s; `None` above 300 km/h.
pub fn longitudinal_level(speed: f64) -> Option<LevelLimits> {
    let of = |(_, mm): &(f64, [f64; 5])| LevelLimits {
        alert: (mm[0] * 1e-3, mm[1] * 1e-3),
        intervention: (mm[2] * 1e-3, mm[3] * 1e-3),
        immediate: mm[4] * 1e-3,
    };
    LEVEL.iter().find(|(most, _)| speed * 3.6 <= most + 1e-9).map(of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faster_is_stricter() {
        let at = |speed: f64| longitudinal_level(speed / 3.6).unwrap();
        assert_eq!(at(200.0).alert, (7.0e-3, 12.0e-3));
        assert_eq!(at(230.0), at(161.0));
        assert!([80.0, 120.0, 160.0, 230.0].into_iter().all(|v| at(v).immediate > at(v + 1.0).immediate));
        assert_eq!(longitudinal_level(301.0 / 3.6), None);
    }
}
