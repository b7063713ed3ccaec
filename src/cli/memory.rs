//! Whether a run fits into its memory: asked of the plan before anything is allocated, and of the system while it goes
//! on.

use super::interrupt;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lint::LESS_MEMORY;
use crate::scenario::Scenario;
use crate::study::Plan;
use crate::units::number;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use sysinfo::{Pid, ProcessRefreshKind, ProcessesToUpdate, System};

/// `--over-memory`
#[derive(clap::Args, Clone, Copy, Default)]
pub(super) struct MemoryArgument {
    /// Start though the plan needs more memory than this machine has, and go on though the run takes more than it may
    #[arg(long)]
    over_memory: bool,
}

impl MemoryArgument {
    /// Why a run is not started; `None` where it fits.
    pub fn refusal(self, graph: &Graph) -> Option<Diagnostic> {
        self.refused("the run needs", graph.cost.bytes, LESS_MEMORY)
    }

    /// Why a study is not started that does so many runs at a time; `None` where they fit.
    pub fn refusal_of_study(self, plan: &Plan, jobs: usize) -> Option<Diagnostic> {
        let (jobs, fewer) =
            (jobs.min(plan.runs()[0]), format!("run fewer points at a time with `--jobs`; {LESS_MEMORY}"));
        match jobs {
            0 | 1 => self.refused("a point of the study needs", plan.bytes(1), LESS_MEMORY),
            _ => self.refused(&format!("{jobs} points at a time need"), plan.bytes(jobs), &fewer),
        }
    }

    /// From now on a run is stopped where it takes more than its scene allows, or nearly all that this machine has; a
    /// study where it takes nearly all.
    pub fn watch(self, scenario: Option<&Scenario>) {
        let Some(process) = sysinfo::get_current_pid().ok().filter(|_| !self.over_memory) else { return };
        let mut system = System::new();
        let begun = resident(&mut system, process);
        let of_machine = (SHARE * memory() as f64) as u64;
        // the program itself is no part of what its run takes
        let of_scene = scenario.and_then(|scenario| scenario.solve.grains.memory).map(|memory| *memory as u64 + begun);
        let limit = of_scene.map_or(of_machine, |of_scene| of_scene.min(of_machine));
        if begun == 0 || limit == 0 {
            return; // this system does not say what a process takes
        }
        thread::spawn(move || {
            let mut now = begun;
            while now <= limit {
                thread::sleep(PAUSE);
                now = resident(&mut system, process);
            }
            let taken = Taken { bytes: now.saturating_sub(begun), allowed: limit.saturating_sub(begun) };
            *OUTGROWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(taken);
            interrupt::ask();
        });
    }

    fn refused(self, who: &str, needed: u64, help: &str) -> Option<Diagnostic> {
        let memory = memory();
        (!self.over_memory && memory > 0 && needed > memory).then(|| refusal(who, needed, memory, help))
    }
}

/// Share of this machine's memory beyond which the system ends programs, and this one ends by itself before.
const SHARE: f64 = 0.95;
/// Between two looks at what the run takes.
const PAUSE: Duration = Duration::from_millis(200);

/// What a run took that has outgrown its memory, and what it might take, bytes.
#[derive(Clone, Copy)]
struct Taken {
    bytes: u64,
    allowed: u64,
}

static OUTGROWN: Mutex<Option<Taken>> = Mutex::new(None);

/// Why the run was asked to stop, where that was its memory; `kept` says what is there of it.
pub(super) fn outgrown(kept: &str) -> Option<Diagnostic> {
    let Taken { bytes, allowed } = (*OUTGROWN.lock().unwrap_or_else(PoisonError::into_inner))?;
    let message = format!(
        "stopped: the run takes {} GB of memory, and it may take {} GB; {kept}",
        gigabytes(bytes),
        gigabytes(allowed)
    );
    Some(Diagnostic::new(Code::E0816, message).help(
        "go on with `--resume` on a machine with more memory, or with `--resume --over-memory` on this one: the answer will be the same",
    ))
}

/// Memory that a process holds, bytes; 0 where the system does not say.
fn resident(system: &mut System, process: Pid) -> u64 {
    let kind = ProcessRefreshKind::nothing().with_memory();
    system.refresh_processes_specifics(ProcessesToUpdate::Some(&[process]), false, kind);
    system.process(process).map_or(0, |process| process.memory())
}

/// To three digits.
fn gigabytes(bytes: u64) -> String {
    number(format!("{:.2e}", bytes as f64 / 1e9).parse().unwrap_or(f64::INFINITY))
}

fn refusal(who: &str, needed: u64, memory: u64, help: &str) -> Diagnostic {
    let message =
        format!("{who} about {} GB of memory, and this machine has {} GB", gigabytes(needed), gigabytes(memory));
    Diagnostic::new(Code::E0813, message).help(format!("{help}; `--over-memory` starts the run all the same"))
}

/// Memory of this machine or, where that is less, the limit of its container, bytes; 0 where it is unknown.
fn memory() -> u64 {
    let mut system = System::new();
    system.refresh_memory();
    let whole = system.total_memory();
    system.cgroup_limits().map_or(whole, |limits| limits.total_memory.min(whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_says_both_sizes() {
        let refused = refusal("the run needs", 193_001_000_000, 25_769_803_776, LESS_MEMORY);
        assert_eq!(refused.message, "the run needs about 193 GB of memory, and this machine has 25.8 GB");
    }

    #[test]
    fn this_machine_has_memory() {
        assert!(memory() > 1 << 28, "{}", memory());
    }
}
