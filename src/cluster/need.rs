//! Time and memory of pieces of work from their plans, and the tasks made of the pieces.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Time and memory of a piece of work, from its plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Need {
    /// Time on one core, s.
    pub seconds: f64,
    pub bytes: u64,
    /// Whether it continues from its last checkpoint if its task is stopped.
    pub goes_on: bool,
}

/// Time and memory that a task requests from a scheduler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Request {
    pub minutes: u64,
    /// Memory, MiB.
    pub megabytes: u64,
}

/// Pieces of work, by their numbers, that one process does one after the other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Task {
    pub request: Request,
    pub pieces: Vec<usize>,
}

/// Least and largest length of a task of short pieces, s: a scheduler needs up to a second to start a task.
const LENGTH: [f64; 2] = [5.0, 60.0];
/// With more tasks than this the tasks are made longer, because more tasks would not use more machines.
const ENOUGH: f64 = 100.0;
/// Largest number of short tasks: schedulers hold about ten thousand jobs.
const MOST: f64 = 2000.0;
/// Factor by which the estimate of a plan may be too low.
const SLACK: f64 = 2.0;
/// Time to start the program and to read the scene, s.
const START: f64 = 180.0;
/// Memory of the program in addition to the plan, MiB.
const PROGRAM: u64 = 256;
/// Least memory that a task requests, MiB.
const LEAST: u64 = 512;

impl Request {
    /// Request of a task, in round numbers, so that many tasks have the same request.
    fn of_need(need: Need) -> Request {
        let minutes = ((SLACK * need.seconds + START) / 60.0).ceil() as u64;
        let megabytes = PROGRAM + (1.5 * need.bytes as f64 / f64::from(1 << 20)).ceil() as u64;
        let quarter = |minutes: u64| if minutes <= 5 { 5 } else { minutes.div_ceil(15) * 15 };
        let rounded = if minutes <= 240 { quarter(minutes) } else { minutes.div_ceil(60) * 60 };
        Request { minutes: rounded, megabytes: megabytes.max(LEAST).next_power_of_two() }
    }

    /// The request with twice the time.
    #[must_use]
    pub fn longer(self) -> Request {
        Request { minutes: self.minutes * 2, ..self }
    }

    /// The request with at most `longest` minutes; `None` is no limit.
    #[must_use]
    pub fn within(self, longest: Option<u64>) -> Request {
        Request { minutes: longest.map_or(self.minutes, |longest| self.minutes.min(longest)), ..self }
    }

    /// The request with twice the memory.
    #[must_use]
    pub fn larger(self) -> Request {
        Request { megabytes: self.megabytes * 2, ..self }
    }
}

impl Task {
    /// The request of the task if no task may take longer than `longest`. If all its pieces continue from a checkpoint,
    /// the task is done in parts of this length.
    #[must_use]
    pub fn request_within(&self, needs: &[Need], longest: impl Fn(Request) -> Option<u64>) -> Request {
        match self.pieces.iter().all(|piece| needs[*piece].goes_on) {
            true => self.request.within(longest(self.request)),
            false => self.request,
        }
    }
}

/// Puts pieces into tasks of a few seconds to a minute, with equal memory and in their order. A longer piece is a
/// separate task.
pub fn tasks(pieces: &[(usize, Need)]) -> Vec<Task> {
    let all: f64 = pieces.iter().map(|(_, need)| need.seconds).sum();
    let length = (all / ENOUGH).clamp(LENGTH[0], LENGTH[1]).max(all / MOST);
    let mut by_memory: BTreeMap<u64, Vec<(usize, Need)>> = BTreeMap::new();
    for (piece, need) in pieces {
        by_memory.entry(Request::of_need(*need).megabytes).or_default().push((*piece, *need));
    }
    let of_equal = |pieces: Vec<(usize, Need)>| {
        let mut tasks: Vec<(Need, Vec<usize>)> = Vec::new();
        for (piece, need) in pieces {
            match tasks.last_mut() {
                Some((sum, pieces)) if sum.seconds + need.seconds <= length => {
                    pieces.push(piece);
                    *sum = Need {
                        seconds: sum.seconds + need.seconds,
                        bytes: sum.bytes.max(need.bytes),
                        goes_on: sum.goes_on && need.goes_on,
                    };
                }
                _ => tasks.push((need, vec![piece])),
            }
        }
        tasks.into_iter().map(|(need, pieces)| Task { request: Request::of_need(need), pieces })
    };
    by_memory.into_values().flat_map(of_equal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn need(seconds: f64, gigabytes: f64) -> Need {
        Need { seconds, bytes: (gigabytes * 1e9) as u64, goes_on: false }
    }

    #[test]
    fn short_pieces_share_a_task_and_long_ones_do_not() {
        let pieces: Vec<(usize, Need)> =
            [10.0, 20.0, 25.0, 30.0, 4000.0, 1.0].iter().map(|s| need(*s, 0.1)).enumerate().collect();
        let made = tasks(&pieces);
        let numbers: Vec<&[usize]> = made.iter().map(|task| task.pieces.as_slice()).collect();
        assert_eq!(numbers, [&[0, 1][..], &[2], &[3], &[4], &[5]], "a hundredth of all, 41 s");
        let minutes: Vec<u64> = made.iter().map(|task| task.request.minutes).collect();
        assert_eq!(minutes, [5, 5, 5, 150, 5], "twice the plan and three minutes");
        assert!(made.iter().all(|task| task.request.megabytes == 512));
    }

    #[test]
    fn memory_parts_tasks() {
        let pieces = [(7, need(1.0, 0.01)), (8, need(1.0, 3.0)), (9, need(1.0, 0.01))];
        let made = tasks(&pieces);
        assert_eq!(made[0].pieces, [7, 9]);
        assert_eq!(made[1], Task { request: Request { minutes: 5, megabytes: 8192 }, pieces: vec![8] });
    }

    #[test]
    fn a_hundred_thousand_pieces_are_two_thousand_tasks_at_most() {
        let pieces: Vec<(usize, Need)> = (0..100_000).map(|piece| (piece, need(10.0, 0.01))).collect();
        let made = tasks(&pieces);
        assert!(made.len() <= 2001, "{}", made.len());
        assert_eq!(made.iter().map(|task| task.pieces.len()).sum::<usize>(), pieces.len());
        assert!(tasks(&[]).is_empty());
    }
}
