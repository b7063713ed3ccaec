//! Ctrl-C, SIGTERM, SIGHUP and memory that runs out: the first asks a run to keep what it has and to stop, the second
//! ends the program.
//!
//! Most work stops by itself, at the next moment from which it can go on. A stage without such moments may take
//! minutes: it is ended from outside, and what was kept before is there to go on from. Files are whole at any moment,
//! because the store survives a kill.

use super::terminal;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, Once, PoisonError};
use std::thread;
use std::time::Duration;

static ASKED: AtomicBool = AtomicBool::new(false);
static LISTENING: Once = Once::new();
/// What shells give for a program that SIGINT has ended.
const ENDED: i32 = 130;
/// Time in which work must stop by itself, and between two looks at writing that goes on.
const PATIENCE: Duration = Duration::from_millis(1800);
const PAUSE: Duration = Duration::from_millis(20);

type Words = Box<dyn Fn() -> super::Outcome + Send>;
/// What the work that goes on says if it is ended from outside.
static LAST_WORDS: Mutex<Option<Words>> = Mutex::new(None);
/// How many are writing now.
static WRITING: AtomicUsize = AtomicUsize::new(0);

/// Asks the run to stop, as a signal does. Returns whether it was asked before.
pub(super) fn ask() -> bool {
    let again = ASKED.swap(true, Ordering::Relaxed);
    if !again {
        thread::spawn(end_what_goes_on);
    }
    again
}

/// From now on signals ask the run to stop; becomes true once one has come.
pub(super) fn asked() -> &'static AtomicBool {
    let handler = || {
        if ask() {
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

/// Work that may be ended from outside, until it is dropped; with the words of the work that it is a part of.
pub(super) struct Endable(Option<Words>);

/// From now on the work that goes on may be ended from outside; `words` then says what is kept.
pub(super) fn endable(words: impl Fn() -> super::Outcome + Send + 'static) -> Endable {
    Endable(LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner).replace(Box::new(words)))
}

impl Drop for Endable {
    fn drop(&mut self) {
        *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = self.0.take();
    }
}

/// Writes; nothing ends the program from outside meanwhile.
pub(super) fn writing<T>(work: impl FnOnce() -> T) -> T {
    WRITING.fetch_add(1, Ordering::SeqCst);
    let done = work();
    WRITING.fetch_sub(1, Ordering::SeqCst);
    done
}

fn end_what_goes_on() {
    thread::sleep(PATIENCE);
    loop {
        if WRITING.load(Ordering::SeqCst) == 0
            && let Some(words) = &*LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner)
        {
            std::process::exit(words().code().into());
        }
        thread::sleep(PAUSE);
    }
}
