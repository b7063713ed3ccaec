//! A simple scheduler instead of a cluster: lost pieces are submitted again, cancelled pieces are not.

use super::*;
use crate::cluster::scheduler::States;
use std::cell::RefCell;

const MIB: u64 = 1 << 20;

/// Work whose finished pieces are set by a test.
struct Pieces {
    needs: Vec<Need>,
    done: RefCell<BTreeSet<usize>>,
    tasks: RefCell<BTreeMap<usize, Vec<usize>>>,
    kept: RefCell<Ledger>,
}

impl Pieces {
    fn new(seconds: &[f64]) -> Pieces {
        Pieces::of_needs(seconds, false)
    }

    fn of_needs(seconds: &[f64], goes_on: bool) -> Pieces {
        let needs = seconds.iter().map(|seconds| Need { seconds: *seconds, bytes: MIB, goes_on }).collect();
        Pieces { needs, done: RefCell::default(), tasks: RefCell::default(), kept: RefCell::default() }
    }

    fn finish(&self, pieces: &[usize]) {
        self.done.borrow_mut().extend(pieces);
    }
}

impl Work for Pieces {
    fn needs(&self) -> &[Need] {
        &self.needs
    }
    fn missing(&self) -> Result<BTreeSet<usize>, StoreError> {
        Ok((0..self.needs.len()).filter(|piece| !self.done.borrow().contains(piece)).collect())
    }
    fn put(&self, task: usize, pieces: &[usize]) -> Result<(), StoreError> {
        self.tasks.borrow_mut().insert(task, pieces.to_vec());
        Ok(())
    }
    fn keep(&self, ledger: &Ledger) -> Result<(), StoreError> {
        *self.kept.borrow_mut() = ledger.clone();
        Ok(())
    }
    fn logs(&self) -> PathBuf {
        "logs".into()
    }
}

/// Jobs are named by their number; a test sets the states of tasks.
#[derive(Default)]
struct Queue {
    arrays: RefCell<Vec<Array>>,
    states: RefCell<States>,
}

impl Queue {
    fn becomes(&self, job: usize, place: usize, state: State) {
        self.states.borrow_mut().insert((job.to_string(), place), state);
    }
}

impl Scheduler for Queue {
    fn submit(&self, array: &Array) -> Result<String, ClusterError> {
        let job = self.arrays.borrow().len();
        self.arrays.borrow_mut().push(*array);
        (0..array.count).for_each(|place| self.becomes(job, place, State::Waiting("Priority".into())));
        Ok(job.to_string())
    }
    fn states(&self) -> Result<States, ClusterError> {
        Ok(self.states.borrow().clone())
    }
    fn largest_array(&self) -> usize {
        2
    }
    fn longest(&self, _: Request) -> Option<u64> {
        Some(60)
    }
}

/// Looks twice: the end of a task counts at the second look.
fn look_twice(watch: &mut Watch<'_>) -> Result<Seen, ClusterError> {
    watch.look()?;
    watch.look()
}

#[test]
fn tasks_that_ask_for_the_same_are_one_array_up_to_its_limit() {
    let (work, queue) = (Pieces::new(&[50.0, 50.0, 50.0, 3000.0]), Queue::default());
    let mut watch = Watch::new(&work, &queue, Ledger::default());
    watch.submit().unwrap();
    let arrays: Vec<(usize, usize, u64)> =
        queue.arrays.borrow().iter().map(|array| (array.first, array.count, array.request.minutes)).collect();
    assert_eq!(arrays, [(0, 2, 5), (2, 1, 5), (3, 1, 105)]);
    assert_eq!(work.tasks.borrow()[&3], [3]);
    let seen = watch.look().unwrap();
    assert_eq!((seen.missing, seen.running, seen.waiting, seen.why.as_str()), (4, 0, 4, "Priority"));
    queue.becomes(2, 0, State::Running);
    work.finish(&[0, 1]);
    let seen = watch.look().unwrap();
    assert_eq!((seen.missing, seen.running, seen.waiting), (2, 1, 1));
}

#[test]
fn what_was_missing_is_given_more_of_the_next_time() {
    for (ending, minutes, megabytes) in [
        (Ending::TimedOut, 10, 512),
        (Ending::OutOfMemory, 5, 1024),
        (Ending::Lost, 5, 512),
        (Ending::Failed, 5, 512),
        (Ending::Done, 5, 512),
    ] {
        let (work, queue) = (Pieces::new(&[1.0, 1.0, 1.0]), Queue::default());
        let mut watch = Watch::new(&work, &queue, Ledger::default());
        watch.submit().unwrap();
        work.finish(&[0]);
        queue.becomes(0, 0, State::Ended(ending));
        let seen = look_twice(&mut watch).unwrap();
        assert_eq!(seen.again, [(1, ending), (2, ending)], "what is kept is not done again");
        let array = queue.arrays.borrow()[1];
        assert_eq!((array.count, array.request), (2, Request { minutes, megabytes }), "{ending:?}");
        assert_eq!(work.tasks.borrow()[&1], [1], "each by itself");
    }
}

#[test]
fn what_fails_again_and_again_is_given_up_when_the_rest_is_done() {
    let (work, queue) = (Pieces::new(&[50.0, 50.0]), Queue::default());
    let mut watch = Watch::new(&work, &queue, Ledger::default());
    watch.submit().unwrap();
    queue.becomes(0, 1, State::Running);
    for job in 0..2 {
        queue.becomes(job, 0, State::Ended(Ending::Failed));
        look_twice(&mut watch).unwrap();
    }
    queue.becomes(2, 0, State::Ended(Ending::TimedOut));
    let seen = look_twice(&mut watch).unwrap();
    assert_eq!((seen.missing, seen.running), (2, 1), "another is still under way");
    work.finish(&[1]);
    let error = watch.look().unwrap_err();
    assert_eq!(error.to_string(), "1 run is missing: the last attempt exceeded its time limit");
    // attempts are counted again after a restart
    let mut watch = Watch::new(&work, &queue, work.kept.borrow().clone());
    watch.submit().unwrap();
    assert_eq!(look_twice(&mut watch).unwrap().again, [(0, Ending::TimedOut)]);
    assert_eq!(watch.look().unwrap().waiting, 1);
}

#[test]
fn what_a_person_cancels_is_not_given_again() {
    let (work, queue) = (Pieces::new(&[50.0, 50.0]), Queue::default());
    let mut watch = Watch::new(&work, &queue, Ledger::default());
    watch.submit().unwrap();
    queue.becomes(0, 0, State::Ended(Ending::Cancelled));
    queue.becomes(0, 1, State::Ended(Ending::Cancelled));
    watch.look().unwrap();
    assert_eq!(watch.look().unwrap_err().to_string(), "2 runs are missing: the last attempt was cancelled");
    assert_eq!(queue.arrays.borrow().len(), 1);
}

#[test]
fn who_goes_on_watching_gives_nothing_twice() {
    let (work, queue) = (Pieces::new(&[50.0, 50.0, 50.0]), Queue::default());
    let mut first = Watch::new(&work, &queue, Ledger::default());
    first.submit().unwrap();
    work.finish(&[0]);
    let mut second = Watch::new(&work, &queue, work.kept.borrow().clone());
    second.submit().unwrap();
    assert_eq!(queue.arrays.borrow().len(), 2);
    assert_eq!(second.ledger().jobs(), ["0", "1"]);
    // on another machine the scheduler knows none of them
    queue.states.borrow_mut().clear();
    let seen = look_twice(&mut second).unwrap();
    assert_eq!(seen.again, [(1, Ending::Lost), (2, Ending::Lost)]);
}

#[test]
fn what_goes_on_from_a_checkpoint_is_done_in_parts() {
    // five hours by its plan, and no task may take longer than one
    let (work, queue) = (Pieces::of_needs(&[18_000.0], true), Queue::default());
    let mut watch = Watch::new(&work, &queue, Ledger::default());
    watch.submit().unwrap();
    for part in 0..20 {
        assert_eq!(queue.arrays.borrow().last().unwrap().request.minutes, 60);
        queue.becomes(part, 0, State::Ended(Ending::TimedOut));
        assert_eq!(look_twice(&mut watch).unwrap().again, [(0, Ending::TimedOut)]);
    }
    // failures are counted apart
    for attempt in 20..22 {
        queue.becomes(attempt, 0, State::Ended(Ending::Failed));
        assert_eq!(look_twice(&mut watch).unwrap().again.len(), 1);
    }
    queue.becomes(22, 0, State::Ended(Ending::Failed));
    assert!(matches!(look_twice(&mut watch), Err(ClusterError::GivenUp { pieces: 1, ending: Ending::Failed, .. })));
}

#[test]
fn parts_have_an_end() {
    let (work, queue) = (Pieces::of_needs(&[18_000.0], true), Queue::default());
    let mut watch = Watch::new(&work, &queue, Ledger::default());
    watch.submit().unwrap();
    for part in 0.. {
        queue.becomes(part, 0, State::Ended(Ending::TimedOut));
        if let Err(error) = look_twice(&mut watch) {
            assert!(matches!(error, ClusterError::GivenUp { ending: Ending::TimedOut, .. }));
            assert_eq!(part + 1, PARTS as usize);
            break;
        }
    }
}
