//! Ctrl-C, SIGTERM, SIGHUP and memory that runs out: the first asks a run to keep what it has and to stop, the second
//! ends the program.

use super::terminal;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static LISTENING: Once = Once::new();
/// What shells give for a program that SIGINT has ended.
const ENDED: i32 = 130;

/// Asks the run to stop, as a signal does.
pub(super) fn ask() {
    ASKED.store(true, Ordering::Relaxed);
}

/// From now on signals ask the run to stop; becomes true once one has come.
pub(super) fn asked() -> &'static AtomicBool {
    let handler = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(ENDED);
        }
    };
    LISTENING.call_once(|| {
        if let Err(error) = ctrlc::set_handler(handler) {
            terminal::note(&format!("Ctrl-C ends the run at once and keeps the last checkpoint: {error}\n"));
        }
    });
    &ASKED
}
