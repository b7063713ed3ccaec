//! Contacts of each pebble, and the sums of their forces in a fixed order.

use super::entry::Entry;
use super::force::Outcome;
use super::lanes::{BLOCK, FineVector, Lanes, NOWHERE, Num, Vector};
use super::prefetch::prefetch_at;
use super::tasks::Task;
use rayon::prelude::*;
use std::ops::Range;

/// Contacts of each pebble, in an order that depends only on which bodies are its neighbours.
#[derive(Debug, Clone, Default)]
pub(super) struct Incidence {
    /// First entry of each pebble, and one final value.
    start: Vec<u32>,
    entries: Vec<Entry>,
    /// Groups of each task, one after the other.
    groups: Vec<Group>,
    /// Rows of the groups: a contact of each pebble, or an idle one.
    rows: Vec<[Entry; BLOCK]>,
}

/// Pebbles of a task that are summed side by side, one per lane: they have the same number of contacts, or nearly.
#[derive(Debug, Clone, Copy)]
struct Group {
    /// Numbers of the pebbles in their task; [`NOWHERE`] in a lane without a pebble.
    pebbles: [u32; BLOCK],
    /// First of its rows, and how many there are.
    first: u32,
    depth: u32,
}

/// Force on a pebble, and moment about its centre: the first six of eight numbers.
#[repr(align(64))]
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Felt(pub [f64; 8]);

/// Number of rows between the prefetched row and the summed row.
const AHEAD: usize = 2;

impl Incidence {
    /// Contacts of all pebbles, in the order of their sums: those of pebble `p` begin at `start[p]`. The outcome of the
    /// contact `idle` is 0. Numbers the groups of each task.
    pub fn new(start: Vec<u32>, entries: Vec<Entry>, tasks: &mut [Task], idle: Entry) -> Incidence {
        let mut incidence = Incidence { start, entries, groups: Vec::new(), rows: Vec::new() };
        let of_task = |task: usize| incidence.grouped(tasks[task].pebble..tasks[task + 1].pebble, idle);
        let grouped: Vec<_> = (0..tasks.len() - 1).into_par_iter().map(of_task).collect();
        for (task, (groups, rows)) in tasks.iter_mut().zip(&grouped) {
            task.group = incidence.groups.len() as u32;
            let first = incidence.rows.len() as u32;
            incidence.groups.extend(groups.iter().map(|group| Group { first: first + group.first, ..*group }));
            incidence.rows.extend_from_slice(rows);
        }
        if let Some(end) = tasks.last_mut() {
            end.group = incidence.groups.len() as u32;
        }
        incidence
    }

    /// Groups of some pebbles, those with the most contacts first. Pebbles without a contact are in none.
    fn grouped(&self, pebbles: Range<u32>, idle: Entry) -> (Vec<Group>, Vec<[Entry; BLOCK]>) {
        let contacts = |pebble: u32| self.contacts_of(pebble as usize);
        let mut order: Vec<u32> = pebbles.clone().filter(|pebble| !contacts(*pebble).is_empty()).collect();
        order.sort_by_key(|pebble| std::cmp::Reverse(contacts(*pebble).len()));
        let (mut groups, mut rows) = (Vec::new(), Vec::new());
        for some in order.chunks(BLOCK) {
            let (first, depth) = (rows.len() as u32, contacts(some[0]).len());
            let mut group = Group { pebbles: [NOWHERE; BLOCK], first, depth: depth as u32 };
            rows.resize(rows.len() + depth, [idle; BLOCK]);
            for (l, pebble) in some.iter().enumerate() {
                group.pebbles[l] = pebble - pebbles.start;
                for (row, entry) in rows[first as usize..].iter_mut().zip(contacts(*pebble)) {
                    row[l] = *entry;
                }
            }
            groups.push(group);
        }
        (groups, rows)
    }

    /// Contacts of a pebble.
    pub fn contacts_of(&self, pebble: usize) -> &[Entry] {
        &self.entries[self.start[pebble] as usize..self.start[pebble + 1] as usize]
    }

    /// Memory that the sums read \[bytes\].
    pub fn bytes_per_step(&self) -> u64 {
        (size_of_val(&self.groups[..]) + size_of_val(&self.rows[..])) as u64
    }

    /// What the `count` pebbles of a task with these groups feel.
    #[inline(always)]
    pub fn felt<L: Lanes>(
        &self,
        lanes: L,
        (groups, count): (Range<u32>, usize),
        outcomes: &[Outcome<L::Real>],
    ) -> Vec<Felt> {
        let mut felt = vec![Felt::default(); count];
        for group in &self.groups[groups.start as usize..groups.end as usize] {
            for at in (0..BLOCK).step_by(L::WIDTH) {
                let sums = self.sums(lanes, group, at, outcomes);
                for (pebble, sums) in group.pebbles[at..at + L::WIDTH].iter().zip(sums) {
                    if let Some(felt) = felt.get_mut(*pebble as usize) {
                        *felt = Felt(sums);
                    }
                }
            }
        }
        felt
    }

    /// Force and moment on each pebble of a group, from its lane `at`. The force on the second pebble of a contact is
    /// opposite; the moments of both have the same sign.
    #[inline(always)]
    fn sums<L: Lanes>(&self, lanes: L, group: &Group, at: usize, outcomes: &[Outcome<L::Real>]) -> [[f64; 8]; BLOCK] {
        let zero = FineVector::splat(lanes, [0.0; 3]);
        let (mut force, mut moment) = (zero, zero);
        for row in group.first as usize..(group.first + group.depth) as usize {
            if let Some(later) = self.rows.get(row + AHEAD) {
                for entry in &later[at..at + L::WIDTH] {
                    prefetch_at(outcomes, entry.place());
                }
            }
            let entries = &self.rows[row][at..at + L::WIDTH];
            let second = lanes.of_second(entries);
            let [x, y, z, a, b, c, first_arm, second_arm] = lanes.gather_rows(outcomes, entries);
            let arm = second_arm.where_or(second, first_arm);
            let sign = Num::splat(lanes, -1.0).where_or(second, Num::splat(lanes, 1.0));
            force = force + Vector([x * sign, y * sign, z * sign]).widen();
            moment = moment - Vector([a, b, c]).widen().scale(arm.widen());
        }
        let ([x, y, z], [a, b, c]) = (force.0, moment.0);
        lanes.rows([x, y, z, a, b, c, zero.0[0], zero.0[0]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::granular::lanes::{Plain, Real, Row, Work};
    use std::cell::Cell;

    /// Forces of contacts with arms; the last one is idle.
    fn outcomes<R: Real>(count: usize) -> Vec<Outcome<R>> {
        let seed = Cell::new(1u64);
        let number = |_: f64| {
            seed.set(seed.get().wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407));
            R::from_f64((seed.get() >> 40) as f64 / f64::from(1 << 20) - 8.0)
        };
        let mut rows: Vec<_> = (0..count).map(|_| Row([0.0; 8].map(number))).collect();
        rows.push(Row::default());
        rows
    }

    /// Pebbles in two tasks, with 0 to 12 contacts each.
    fn incidence(pebbles: u32, outcomes: u32) -> (Incidence, Vec<Task>) {
        let (mut start, mut entries) = (vec![0], Vec::new());
        for pebble in 0..pebbles {
            let contacts = pebble * pebble % 13;
            entries.extend((0..contacts).map(|k| Entry::new((17 * pebble + 5 * k) % outcomes, (pebble + k) % 2 == 0)));
            start.push(entries.len() as u32);
        }
        let at = |pebble| Task { pebble, ..Task::default() };
        let mut tasks = vec![at(0), at(pebbles / 3), at(pebbles)];
        let incidence = Incidence::new(start, entries, &mut tasks, Entry::new(outcomes, false));
        (incidence, tasks)
    }

    struct Summed<'a, R>(&'a Incidence, &'a [Task], &'a [Outcome<R>]);

    impl<R: Real> Work<R> for Summed<'_, R> {
        type Output = Vec<Felt>;
        fn run<L: Lanes<Real = R>>(self, lanes: L) -> Vec<Felt> {
            let Summed(incidence, tasks, outcomes) = self;
            let of = |(task, next): (&Task, &Task)| {
                let count = (next.pebble - task.pebble) as usize;
                incidence.felt(lanes, (task.group..next.group, count), outcomes)
            };
            tasks.iter().zip(&tasks[1..]).flat_map(of).collect()
        }
    }

    /// The sums of a pebble, one contact after the other.
    fn alone<R: Real>(incidence: &Incidence, outcomes: &[Outcome<R>], pebble: usize) -> [f64; 6] {
        let mut sums = [0.0; 6];
        for &entry in incidence.contacts_of(pebble) {
            let outcome = &outcomes[entry.place()];
            let arm = outcome[6 + usize::from(entry.is_second())].to_f64();
            for k in 0..3 {
                sums[k] += if entry.is_second() { -outcome[k].to_f64() } else { outcome[k].to_f64() };
                sums[3 + k] -= arm * outcome[3 + k].to_f64();
            }
        }
        sums
    }

    fn check<R: Real>() {
        let (incidence, tasks) = incidence(100, 300);
        let outcomes = outcomes::<R>(300);
        let summed = || Summed(&incidence, &tasks, &outcomes);
        for felt in [R::dispatch(summed()), summed().run(Plain::<R, 4>::new()), summed().run(Plain::<R, 16>::new())] {
            assert_eq!(felt.len(), 100);
            for (pebble, felt) in felt.iter().enumerate() {
                assert_eq!(felt.0[..6], alone(&incidence, &outcomes, pebble), "pebble {pebble}");
            }
        }
    }

    #[test]
    fn pebbles_feel_their_contacts_and_no_others() {
        check::<f32>();
        check::<f64>();
    }

    #[test]
    fn groups_hold_few_idle_contacts() {
        let (incidence, _) = incidence(768, 300);
        let (held, places) = (incidence.entries.len(), incidence.rows.len() * BLOCK);
        assert!(places as f64 <= 1.1 * held as f64, "{places} places for {held} contacts");
    }
}
