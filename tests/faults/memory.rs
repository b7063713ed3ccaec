//! A run that takes more memory than it may stops with what it has.

use super::{Place, on_a_law, refused, same_results};

/// What this run records takes more than its scene allows; the check warns of it (L1022), and the machine could hold
/// it.
#[test]
fn a_run_that_outgrows_its_memory_stops_and_goes_on() {
    let scene = on_a_law(4000).replace("time_step = 2e-4 s }", "time_step = 2e-4 s, memory = 0.01 GiB }").replace(
        "record { at = [-3, +1] sleepers, after = 0 axles",
        "record { over = -15 .. +10 sleepers, after = [0, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000] axles, every = 0.1 ms",
    );
    let place = Place::new(&scene);
    let stopped = place.run("cut", &[]);
    refused(&stopped, &["E0816", "it may take 0.0107 GB; the state is kept in", "`--resume --over-memory`"]);
    place.finish("cut", &["--resume", "--over-memory"]);
    place.finish("whole", &["--over-memory"]);
    same_results(&place.path("whole"), &place.path("cut"));
}
