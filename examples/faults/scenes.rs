//! What is killed: small scenes of every tier that couples something, each of some seconds.

use crate::coarse_cells;
use crate::shared_packings;

/// Work of the program that can be killed and gone on with.
pub struct Work {
    /// The tier, for the table.
    pub name: &'static str,
    pub command: &'static str,
    pub scene: String,
    pub more: &'static [&'static str],
    /// Whether a Slurm does it.
    pub on_slurm: bool,
    /// Of a thousand kills.
    pub kills: u64,
}

/// A track on a law, 21 m under one wagon; with a study over its pads.
const ON_A_LAW: &str = "use std
scenario { title = \"small\", allow = [stiffness_jump: \"small\", track_too_short: \"small\", critical_speed: \"small\", wheel_on_track: \"small\"] }
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 1200 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s, law = laws.varandas_2014 }
study slab_pads {
  vary = [stiff.pad.stiffness: [20, 30, 40, 60, 80, 100] MN/m]
  set = [traffic.total: 100 axles]
  minimise = max(settlement)
}
";

/// The line of the coarse scene that says how it is solved, and others in its place.
const SOLVE: &str = "solve { substructure = cells, passages = continuous, update_every = 8 axles, tolerance = 20 % }";
const FULL: &str = "solve { substructure = full, window = -1.8 .. 1.2 m, support_from = passage }
record { at = [-2, -1, +1] sleepers, after = [0, 8] axles, quantities = rail_seat_load }";
const ZONE: &str = "solve { substructure = zone, window = -1.8 .. 1.2 m, tolerance = 20 % }";
const MONOLITHIC: &str = "solve { substructure = full, window = -1.8 .. 1.2 m, coupling = monolithic }";

/// The coarse scene of cells on another ground, under so many axles.
fn on_grains(solve: &str, axles: u32) -> String {
    assert!(coarse_cells::SCENE.contains(SOLVE), "the coarse scene has another line `solve`");
    coarse_cells::SCENE.replace(SOLVE, solve).replace("total = 40 axles", &format!("total = {axles} axles"))
}

/// All of them; those of a Slurm where there is one.
pub fn all(with_slurm: bool) -> Vec<Work> {
    let run = |name, scene, kills| Work { name, command: "run", scene, more: &[], on_slurm: false, kills };
    let works = vec![
        run("law", ON_A_LAW.to_owned(), 220),
        run("cells", coarse_cells::SCENE.to_owned(), 120),
        run("zone, iterated", on_grains(ZONE, 8), 100),
        run("full, iterated", on_grains(FULL, 8), 100),
        run("full, monolithic", on_grains(MONOLITHIC, 4), 100),
        run("cells, three packings", shared_packings::packings(), 80),
        run("test rig", shared_packings::rig("30 cycles"), 120),
        Work { command: "study", more: &["--jobs", "1"], ..run("study", ON_A_LAW.to_owned(), 100) },
        Work {
            command: "study",
            more: &["--executor", "slurm"],
            on_slurm: true,
            ..run("study on Slurm", ON_A_LAW.to_owned(), 30)
        },
        Work {
            more: &["--executor", "slurm"],
            on_slurm: true,
            ..run("packings on Slurm", shared_packings::packings(), 30)
        },
        Work {
            more: &["--executor", "slurm"],
            on_slurm: true,
            ..run("test rig on Slurm", shared_packings::rig("30 cycles"), 30)
        },
    ];
    works.into_iter().filter(|work| with_slurm || !work.on_slurm).collect()
}
