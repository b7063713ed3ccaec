//! Progress with an estimate: bars on a terminal, a line a minute of long work elsewhere.

use super::terminal;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::borrow::Cow;
use std::fmt::Write;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// A bar that knows how much is left.
pub(super) fn bar() -> ProgressBar {
    if !is_watched() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(1).with_style(
        ProgressStyle::with_template("{spinner} {bar:32} {pos}/{len} blocks, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    bar.set_draw_target(ProgressDrawTarget::stderr());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Whether somebody watches a terminal and wants to see progress.
fn is_watched() -> bool {
    std::io::stderr().is_terminal() && !terminal::is_quiet()
}

/// A bar of work whose steps differ in cost.
pub(super) fn share() -> ProgressBar {
    let bar = bar();
    bar.set_style(
        ProgressStyle::with_template("{spinner} {bar:32} {percent} % of {msg}, {left}")
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .with_key("left", left),
    );
    bar
}

/// What is left, as soon as something is done.
fn left(state: &ProgressState, text: &mut dyn Write) {
    let _ = match state.pos() {
        0 => write!(text, "{:#} so far", HumanDuration(state.elapsed())),
        _ => write!(text, "{:#} left", HumanDuration(state.eta())),
    };
}

pub(super) fn set(bar: &ProgressBar, done: u64, all: u64) {
    bar.set_length(all);
    bar.set_position(done);
}

/// Between two lines where there is no terminal.
const LINE: Duration = Duration::from_secs(60);

/// A bar that waits until the work has taken two seconds; what is quick needs none. Without a terminal a line from time
/// to time.
pub(super) struct Patient {
    message: Cow<'static, str>,
    start: Instant,
    told: Instant,
    bar: Option<ProgressBar>,
    /// What was done when it was first told of, and when: work that goes on was begun by another process.
    begun: Option<(u64, Instant)>,
}

impl Patient {
    pub(super) fn new(message: impl Into<Cow<'static, str>>) -> Patient {
        Patient { message: message.into(), start: Instant::now(), told: Instant::now(), bar: None, begun: None }
    }

    /// One that is seen at once: the first word of the work may be minutes away.
    pub(super) fn seen(message: &'static str) -> Patient {
        let mut patient = Patient::new(message);
        if is_watched() {
            set(patient.shown(), 0, 1);
        }
        patient
    }

    /// Goes on under another name.
    pub(super) fn rename(&mut self, message: impl Into<Cow<'static, str>>) {
        self.message = message.into();
        if let Some(bar) = &self.bar {
            bar.set_message(self.message.clone());
        }
    }

    pub(super) fn show(&mut self, done: u64, all: u64) {
        self.begun.get_or_insert((done, Instant::now()));
        if self.bar.is_none() && self.start.elapsed() < Duration::from_secs(2) {
            return;
        }
        if !is_watched() {
            return self.tell(done, all);
        }
        let is_new = self.bar.is_none();
        set(self.shown(), done, all);
        if is_new {
            self.shown().reset_eta();
        }
    }

    fn shown(&mut self) -> &ProgressBar {
        self.bar.get_or_insert_with(|| {
            let bar = share();
            bar.set_message(self.message.clone());
            bar
        })
    }

    fn tell(&mut self, done: u64, all: u64) {
        let Some((before, begun)) = self.begun.filter(|(before, _)| done > *before) else { return };
        if self.told.elapsed() < LINE {
            return;
        }
        self.told = Instant::now();
        let minutes = |since: Instant| since.elapsed().as_secs_f64() / 60.0;
        let (done, all, before) = (done as f64, all.max(done) as f64, before as f64);
        let left = minutes(begun) * (all - done) / (done - before);
        let (share, took) = (100.0 * done / all, minutes(self.start));
        terminal::note(&format!("{}: {share:.0} % after {took:.0} min, about {left:.0} min left\n", self.message));
    }
}

impl Drop for Patient {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
