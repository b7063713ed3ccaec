//! The standard library, embedded: files in the language itself.

/// Modules by name, with their text.
pub(super) const MODULES: &[(&str, &str)] = &[
    ("laws", include_str!("../../stdlib/laws.track")),
    ("pads", include_str!("../../stdlib/pads.track")),
    ("rails", include_str!("../../stdlib/rails.track")),
    ("slabs", include_str!("../../stdlib/slabs.track")),
    ("sleepers", include_str!("../../stdlib/sleepers.track")),
    ("usps", include_str!("../../stdlib/usps.track")),
    ("vehicles", include_str!("../../stdlib/vehicles.track")),
];
