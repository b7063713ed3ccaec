//! Measurements of the machine: memory bandwidth, and peak memory of a program.

use rayon::prelude::*;
use std::time::Instant;

/// Numbers of each of the three arrays: together 96 MiB, more than the caches of common machines hold.
const LENGTH: usize = 4 << 20;
/// Numbers that one task works on.
const CHUNK: usize = 1 << 16;
const ROUNDS: usize = 5;

/// Bytes that the threads of the present pool move in a second by `a = b + s c` over arrays in memory, each counted
/// once (McCalpin's triad; the best of five rounds).
pub fn triad() -> f64 {
    let (mut a, b, c) = (vec![0.0f64; LENGTH], vec![1.0; LENGTH], vec![2.0; LENGTH]);
    let mut best = f64::INFINITY;
    for round in 0..ROUNDS {
        let factor = 3.0 + round as f64;
        let start = Instant::now();
        a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(c.par_chunks(CHUNK)).for_each(|((a, b), c)| {
            for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                *a = b + factor * c;
            }
        });
        best = best.min(start.elapsed().as_secs_f64());
        std::hint::black_box(&a);
    }
    (3 * LENGTH * size_of::<f64>()) as f64 / best
}

/// Most bytes that this program has held at once, as Linux counts them; none on other systems.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib * 1024)
}
