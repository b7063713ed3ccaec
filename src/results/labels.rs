//! Labels and units of the most important scalars of a summary.

/// A scalar of a summary as a line of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Label {
    /// Its name in `summary.json`.
    pub name: &'static str,
    /// Its label; two leading spaces mark a detail of the line above.
    pub text: &'static str,
    pub unit: &'static str,
    /// The unit in SI.
    pub size: f64,
}

impl Label {
    const fn new(name: &'static str, text: &'static str, unit: &'static str, size: f64) -> Label {
        Label { name, text, unit, size }
    }
}

/// The lines of a run on a track.
pub const OF_TRACKS: [Label; 14] = [
    Label::new("settlement_step", "step at the structure", "mm", 1e-3),
    Label::new("level_change_wheelbase", "level change, wheelbase", "mm", 1e-3),
    Label::new("level_change_3m", "level change over 3 m", "mm", 1e-3),
    Label::new("max_settlement", "largest settlement", "mm", 1e-3),
    Label::new("max_settlement_x", "  at", "m", 1.0),
    Label::new("far_field_settlement", "far-field settlement", "mm", 1e-3),
    Label::new("voided_sleepers", "voided sleepers", "", 1.0),
    Label::new("broken_bonds_share", "broken bonds", "%", 0.01),
    Label::new("max_wheel_force", "largest wheel force", "kN", 1e3),
    Label::new("dynamic_amplification", "dynamic amplification", "", 1.0),
    Label::new("wheel_unloading", "wheel unloading", "%", 0.01),
    Label::new("max_rail_seat_load", "largest rail seat load", "kN", 1e3),
    Label::new("max_rail_moment", "largest rail moment", "kN m", 1e3),
    Label::new("max_rail_displacement", "largest rail displacement", "mm", 1e-3),
];

/// The lines of a test rig.
pub const OF_TESTS: [Label; 11] = [
    Label::new("max_settlement", "settlement", "mm", 1e-3),
    Label::new("first_settlement", "  after one cycle", "mm", 1e-3),
    Label::new("support_stiffness", "resilient stiffness", "MN/m", 1e6),
    Label::new("oedometric_modulus", "oedometric modulus", "MPa", 1e6),
    Label::new("peak_deviator", "largest deviator", "kPa", 1e3),
    Label::new("peak_friction_angle", "largest friction angle", "deg", std::f64::consts::PI / 180.0),
    Label::new("peak_strain", "  at a strain of", "%", 0.01),
    Label::new("broken_bonds_share", "broken bonds", "%", 0.01),
    Label::new("cycles", "cycles", "", 1.0),
    Label::new("repeats", "packings", "", 1.0),
    Label::new("grains", "grains", "", 1.0),
];
