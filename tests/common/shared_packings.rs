//! A run on several packings, some seconds each, that processes share.

use super::coarse_cells::SCENE;
use std::fs;
use std::path::Path;

/// The scene, on three packings.
pub fn packings() -> String {
    SCENE.replace("total = 40 axles", "total = 16 axles").replace("tolerance = 20 %", "tolerance = 20 %, repeats = 3")
}

/// Fails where two runs, or their further packings, do not hold the same results, to the bit: manifests name every
/// file by its hash.
pub fn assert_same_run(one: &Path, other: &Path) {
    for name in ["manifest.json", "packings/2/manifest.json", "packings/3/manifest.json"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(other.join(name)).unwrap(), "{name}");
    }
}
