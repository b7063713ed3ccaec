//! What pieces of work take by their plans, and the tasks that are made of them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a piece of work takes, by its plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Need {
    /// On one core, s.
    pub seconds: f64,
    pub bytes: u64,
    /// Whether it goes on from its last checkpoint where its task is cut off.
    pub goes_on: bool,
}

/// What a task asks of a scheduler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Request {
    pub minutes: u64,
    /// MiB.
    pub megabytes: u64,
}

/// Some pieces of work, by their numbers, that one process does in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Task {
    pub request: Request,
    pub pieces: Vec<usize>,
}

/// Short pieces share a task that lasts about so long, s: a scheduler takes up to a second to start one.
const LENGTH: [f64; 2] = [5.0, 60.0];
/// Where there are so many tasks they are made longer: more of them would keep no more machines busy.
const ENOUGH: f64 = 100.0;
/// Tasks are made longer rather than more than this: schedulers hold some ten thousand jobs.
const MOST: f64 = 2000.0;
/// Plans may be wrong by as much.
const SLACK: f64 = 2.0;
/// To start the program and to read the scene, s.
const START: f64 = 180.0;
/// What the program takes beside the plan, MiB.
const PROGRAM: u64 = 256;
/// A machine has hardly less, MiB.
const LEAST: u64 = 512;

impl Request {
    /// What a task of some length asks for, in round numbers, so that many tasks ask for the same.
    fn of_need(need: Need) -> Request {
        let minutes = ((SLACK * need.seconds + START) / 60.0).ceil() as u64;
        let megabytes = PROGRAM + (1.5 * need.bytes as f64 / f64::from(1 << 20)).ceil() as u64;
        let quarter = |minutes: u64| if minutes <= 5 { 5 } else { minutes.div_ceil(15) * 15 };
        let rounded = if minutes <= 240 { quarter(minutes) } else { minutes.div_ceil(60) * 60 };
        Request { minutes: rounded, megabytes: megabytes.max(LEAST).next_power_of_two() }
    }

    /// Twice the time.
    #[must_use]
    pub fn longer(self) -> Request {
        Request { minutes: self.minutes * 2, ..self }
    }

    /// The same in no more than some minutes; `None` is no limit.
    #[must_use]
    pub fn within(self, longest: Option<u64>) -> Request {
        Request { minutes: longest.map_or(self.minutes, |longest| self.minutes.min(longest)), ..self }
    }

    /// Twice the memory.
    #[must_use]
    pub fn larger(self) -> Request {
        Request { megabytes: self.megabytes * 2, ..self }
    }
}

impl Task {
    /// What the task asks for where no task may take longer than `longest`: all of whose pieces go on from a checkpoint is done in
    /// parts of that length.
    #[must_use]
    pub fn request_within(&self, needs: &[Need], longest: impl Fn(Request) -> Option<u64>) -> Request {
        match self.pieces.iter().all(|piece| needs[*piece].goes_on) {
            true => self.request.within(longest(self.request)),
            false => self.request,
        }
    }
}

/// Puts pieces into tasks of some seconds to a minute: of equal memory, in their order. A longer piece is a task of
/// its own.
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
