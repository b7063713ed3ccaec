//! Whether a run fits into the memory of this machine: asked before anything of it is allocated.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lint::LESS_MEMORY;
use crate::units::number;
use sysinfo::System;

/// `--over-memory`
#[derive(clap::Args, Clone, Copy, Default)]
pub(super) struct MemoryArgument {
    /// Start though the plan needs more memory than this machine has.
    #[arg(long)]
    over_memory: bool,
}

impl MemoryArgument {
    /// Why a run is not started; `None` where it fits.
    pub fn refusal(self, graph: &Graph) -> Option<Diagnostic> {
        let (needed, memory) = (graph.cost.bytes, memory());
        (!self.over_memory && memory > 0 && needed > memory).then(|| refusal(needed, memory))
    }
}

fn refusal(needed: u64, memory: u64) -> Diagnostic {
    let gigabytes = |bytes: u64| number(format!("{:.2e}", bytes as f64 / 1e9).parse().unwrap_or(f64::INFINITY));
    let message = format!(
        "the run needs about {} GB of memory, and this machine has {} GB",
        gigabytes(needed),
        gigabytes(memory)
    );
    Diagnostic::new(Code::E0813, message).help(format!("{LESS_MEMORY}; `--over-memory` starts the run all the same"))
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
        let refused = refusal(193_001_000_000, 25_769_803_776);
        assert_eq!(refused.message, "the run needs about 193 GB of memory, and this machine has 25.8 GB");
    }

    #[test]
    fn this_machine_has_memory() {
        assert!(memory() > 1 << 28, "{}", memory());
    }
}
