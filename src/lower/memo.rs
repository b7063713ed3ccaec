//! Results of costly parts of a plan, kept while the program runs. A plan is made again for every point of a study and
//! after every change in an editor, and most of these parts have the same input each time.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The last results of a function, with their inputs. The function depends on its input alone, so a kept result equals
/// a new one.
pub(crate) struct Memo<K, V> {
    kept: Mutex<VecDeque<(K, V)>>,
    most: usize,
}

impl<K: PartialEq, V: Clone> Memo<K, V> {
    /// Keeps at most this number of results.
    pub const fn new(most: usize) -> Self {
        Memo { kept: Mutex::new(VecDeque::new()), most }
    }

    /// The kept result for this input, or a new one. Other threads are not blocked while it is made.
    pub fn get(&self, key: K, make: impl FnOnce(&K) -> V) -> V {
        if let Some((_, known)) = self.lock().iter().find(|(known, _)| *known == key) {
            return known.clone();
        }
        let made = make(&key);
        let mut kept = self.lock();
        kept.push_front((key, made.clone()));
        kept.truncate(self.most);
        made
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<(K, V)>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn a_result_is_made_once_and_the_oldest_is_forgotten() {
        let (memo, made) = (Memo::new(2), Cell::new(0));
        let squared = |number: u32| {
            memo.get(number, |number| {
                made.set(made.get() + 1);
                number * number
            })
        };
        assert_eq!([3, 4, 3, 4].map(squared), [9, 16, 9, 16]);
        assert_eq!(made.get(), 2);
        assert_eq!([5, 3, 5].map(squared), [25, 9, 25], "3 was forgotten for 5");
        assert_eq!(made.get(), 4);
    }
}
