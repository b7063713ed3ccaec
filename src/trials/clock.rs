//! Time that a passage takes of a core: other programs on the machine are not counted where the system tells them
//! apart.

use std::fs;
use std::time::Instant;

/// A running clock of this thread.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    wall: Instant,
    on_core: Option<f64>,
}

impl Clock {
    pub fn start() -> Clock {
        Clock { on_core: on_core(), wall: Instant::now() }
    }

    /// Since the start, s: on the core, or of the wall where that is not known.
    pub fn seconds(&self) -> f64 {
        match (self.on_core, on_core()) {
            // the kernel counts in ticks: what is too short for it is taken from the wall
            (Some(start), Some(now)) if now - start > TICKS => now - start,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }
}

/// Some ticks of the scheduler, s.
const TICKS: f64 = 0.02;

/// Time of this thread on a core as Linux counts it, s.
fn on_core() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}
