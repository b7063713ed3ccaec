//! Ends the program where a scene does not end: a hang is told with its number.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A scene that takes longer hangs: plans of more than a minute are not run.
const LONGEST: Duration = Duration::from_secs(600);

/// The scene under way and when it began.
pub struct Watchdog(Arc<Mutex<Option<(u64, Instant)>>>);

impl Watchdog {
    /// Looks every second, on a thread of its own.
    pub fn start() -> Watchdog {
        let under_way = Arc::new(Mutex::new(None));
        let seen = under_way.clone();
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                let now: Option<(u64, Instant)> = *seen.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some((scene, _)) = now.filter(|(_, began)| began.elapsed() > LONGEST) {
                    eprintln!("scene {scene} has not ended after {} s", LONGEST.as_secs());
                    std::process::exit(3);
                }
            }
        });
        Watchdog(under_way)
    }

    pub fn begins(&self, scene: u64) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((scene, Instant::now()));
    }

    pub fn ends(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}
