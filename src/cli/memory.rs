//! Whether a run fits into the memory of this machine: asked before anything of it is allocated.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lint::LESS_MEMORY;
use crate::study::Plan;
use crate::units::number;
use sysinfo::System;

/// `--over-memory`
#[derive(clap::Args, Clone, Copy, Default)]
pub(super) struct MemoryArgument {
    /// Start though the plan needs more memory than this machine has
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
        let (jobs, fewer) = (jobs.min(plan.runs()), format!("run fewer points at a time with `--jobs`; {LESS_MEMORY}"));
        match jobs {
            0 | 1 => self.refused("a point of the study needs", plan.bytes(1), LESS_MEMORY),
            _ => self.refused(&format!("{jobs} points at a time need"), plan.bytes(jobs), &fewer),
        }
    }

    fn refused(self, who: &str, needed: u64, help: &str) -> Option<Diagnostic> {
        let memory = memory();
        (!self.over_memory && memory > 0 && needed > memory).then(|| refusal(who, needed, memory, help))
    }
}

fn refusal(who: &str, needed: u64, memory: u64, help: &str) -> Diagnostic {
    let gigabytes = |bytes: u64| number(format!("{:.2e}", bytes as f64 / 1e9).parse().unwrap_or(f64::INFINITY));
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
