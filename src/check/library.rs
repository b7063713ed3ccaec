//! The standard library, embedded: files in the language itself.

/// Modules by name, with their text.
pub(super) const MODULES: &[(&str, &str)] = &[
    ("ballasts", include_str!("../../stdlib/ballasts.track")),
    ("gradings", include_str!("../../stdlib/gradings.track")),
    ("laws", include_str!("../../stdlib/laws.track")),
    ("pads", include_str!("../../stdlib/pads.track")),
    ("rails", include_str!("../../stdlib/rails.track")),
    ("slabs", include_str!("../../stdlib/slabs.track")),
    ("sleepers", include_str!("../../stdlib/sleepers.track")),
    ("soils", include_str!("../../stdlib/soils.track")),
    ("subballasts", include_str!("../../stdlib/subballasts.track")),
    ("usps", include_str!("../../stdlib/usps.track")),
    ("vehicles", include_str!("../../stdlib/vehicles.track")),
];
