//! Ends the program if a run does not end: a hang is reported with its number.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// The runs in progress, by their thread, and when they began.
type InProgress = HashMap<ThreadId, (u64, Instant)>;

pub struct Watchdog(Arc<Mutex<InProgress>>);

impl Watchdog {
    /// Looks every second, on a separate thread. If a run takes longer than `longest`, it tells `hangs` the number of
    /// the run and ends the program with exit code 3.
    pub fn start(longest: Duration, hangs: impl Fn(u64) + Send + 'static) -> Watchdog {
        let runs = Arc::new(Mutex::new(InProgress::new()));
        let seen = runs.clone();
        thread::spawn(move || {
            loop {
                thread::sleep(Duration::from_secs(1));
                let slow = held(&seen).values().find(|(_, began)| began.elapsed() > longest).copied();
                if let Some((run, _)) = slow {
                    eprintln!("run {run} has not ended after {} s", longest.as_secs());
                    hangs(run);
                    std::process::exit(3);
                }
            }
        });
        Watchdog(runs)
    }

    /// Runs `of` on this thread under the eyes of the watchdog.
    pub fn watched<R>(&self, run: u64, of: impl FnOnce() -> R) -> R {
        held(&self.0).insert(thread::current().id(), (run, Instant::now()));
        let result = of();
        held(&self.0).remove(&thread::current().id());
        result
    }
}

fn held(runs: &Mutex<InProgress>) -> MutexGuard<'_, InProgress> {
    runs.lock().unwrap_or_else(PoisonError::into_inner)
}
