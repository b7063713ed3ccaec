//! Runs on several packings, some seconds each, that processes share.

use super::coarse_cells::SCENE;
use std::fs;
use std::path::Path;

/// The scene, on three packings.
pub fn packings() -> String {
    SCENE.replace("total = 40 axles", "total = 16 axles").replace("tolerance = 20 %", "tolerance = 20 %, repeats = 3")
}

/// Coarse spheres under one sleeper, on two packings.
const RIG: &str = "use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = TOTAL }
solve { substructure = full, repeats = 2 }
";

/// A test rig on two packings, with so many cycles.
pub fn rig(total: &str) -> String {
    RIG.replace("TOTAL", total)
}

/// Fails where two runs, or their further packings, do not hold the same results, to the bit: manifests name every
/// file by its hash.
pub fn assert_same_run(one: &Path, other: &Path) {
    for name in ["manifest.json", "packings/2/manifest.json", "packings/3/manifest.json"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(other.join(name)).unwrap(), "{name}");
    }
}
