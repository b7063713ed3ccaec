//! Counts of what became of scenes, by aim and by code.

use super::draw::Aim;
use super::trial::Outcome;
use std::collections::BTreeMap;
use std::fmt;

/// Counts, and the memory on the way.
#[derive(Default)]
pub struct Tally {
    /// By aim: accepted, refused, too long, idle, finished, stopped, failed.
    by_aim: BTreeMap<String, [u64; 7]>,
    /// Scenes by the code of an error, with the first of them.
    errors: BTreeMap<&'static str, (u64, u64)>,
    warnings: BTreeMap<&'static str, (u64, u64)>,
    /// Scenes done, and resident memory then, MiB.
    pub resident: Vec<(u64, f64)>,
}

const COLUMNS: [&str; 7] = ["accepted", "refused", "too long", "idle", "finished", "stopped", "failed"];

impl Tally {
    pub fn add(&mut self, scene: u64, aim: Aim, outcome: &Outcome) {
        let (column, errors, warnings) = match outcome {
            Outcome::Accepted { warnings } => (0, None, Some(warnings)),
            Outcome::Refused { errors } => (1, Some(errors), None),
            Outcome::TooLong => (2, None, None),
            Outcome::Idle => (3, None, None),
            Outcome::Finished => (4, None, None),
            Outcome::Stopped { errors } => (5, Some(errors), None),
            Outcome::Failed(_) => (6, None, None),
        };
        self.by_aim.entry(format!("{aim:?}")).or_default()[column] += 1;
        errors.into_iter().flatten().for_each(|code| self.errors.entry(code).or_insert((0, scene)).0 += 1);
        warnings.into_iter().flatten().for_each(|code| self.warnings.entry(code).or_insert((0, scene)).0 += 1);
    }

    pub fn failed(&self) -> u64 {
        self.by_aim.values().map(|counts| counts[6]).sum()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<8}{}", "", COLUMNS.map(|c| format!("{c:>10}")).join(""))?;
        for (aim, counts) in &self.by_aim {
            writeln!(f, "{aim:<8}{}", counts.map(|c| format!("{c:>10}")).join(""))?;
        }
        for (what, codes) in [("errors", &self.errors), ("warnings of accepted scenes", &self.warnings)] {
            let mut codes: Vec<_> = codes.iter().collect();
            codes.sort_by_key(|(_, (count, _))| std::cmp::Reverse(*count));
            let list: Vec<String> =
                codes.iter().map(|(code, (count, first))| format!("{code} {count} (scene {first})")).collect();
            writeln!(f, "{what}: {}", list.join(", "))?;
        }
        let memory: Vec<String> = self.resident.iter().map(|(scenes, mib)| format!("{scenes}: {mib:.0} MiB")).collect();
        writeln!(f, "memory: {}", memory.join(", "))
    }
}
