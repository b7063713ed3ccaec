//! Work in turns: some pieces at a time, each with its share of the cores.
//!
//! Threads of a pool that wait for another pool take up further work meanwhile, and all of it would run at once; so
//! these are not of a pool.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZero;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Cores of this machine.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get)
}

/// Results of `run` for each item, in their order, so many at a time on so many threads. Fails if threads cannot be
/// started.
pub fn each<T: Sync, A: Send>(
    items: &[T],
    at_a_time: usize,
    threads: usize,
    run: impl Fn(&T) -> A + Sync,
) -> Result<Vec<A>, ThreadPoolBuildError> {
    let workers = at_a_time.min(items.len()).max(1);
    let threads = (threads / workers).max(1);
    let pools: Vec<ThreadPool> =
        (0..workers).map(|_| ThreadPoolBuilder::new().num_threads(threads).build()).collect::<Result<_, _>>()?;
    let next = AtomicUsize::new(0);
    let work = |pool: &ThreadPool| {
        let mut done = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(number) else { return done };
            done.push((number, pool.install(|| run(item))));
        }
    };
    let mut done: Vec<(usize, A)> = thread::scope(|scope| {
        let workers: Vec<_> = pools.iter().map(|pool| scope.spawn(|| work(pool))).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    done.sort_by_key(|(number, _)| *number);
    Ok(done.into_iter().map(|(_, answer)| answer).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_stand_in_the_order_of_the_items_and_no_more_run_at_a_time_than_should() {
        let (running, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let items: Vec<u64> = (0..40).collect();
        let doubled = each(&items, 3, 3, |item| {
            most.fetch_max(1 + running.fetch_add(1, Ordering::SeqCst), Ordering::SeqCst);
            thread::yield_now();
            running.fetch_sub(1, Ordering::SeqCst);
            2 * item
        });
        assert_eq!(doubled.unwrap(), items.iter().map(|item| 2 * item).collect::<Vec<_>>());
        assert!((1..=3).contains(&most.into_inner()));
        assert!(each(&[0; 0], 0, 1, |item| *item).unwrap().is_empty());
    }
}
