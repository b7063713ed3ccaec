//! A contact as its pebbles list it: in one number.

/// A contact of a pebble.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry(u32);

/// Set for the second of the two pebbles of a contact.
const SECOND: u32 = 1;
/// Set for the first contact of a pebble.
const BEGINS: u32 = 2;

impl Entry {
    /// The contact at `place` of the outcomes, for its first or its second pebble.
    pub fn new(place: u32, is_second: bool) -> Entry {
        Entry(place << 2 | if is_second { SECOND } else { 0 })
    }

    /// The same, as the first contact of its pebble.
    pub fn at_the_beginning(self) -> Entry {
        Entry(self.0 | BEGINS)
    }

    #[inline(always)]
    pub fn place(self) -> usize {
        (self.0 >> 2) as usize
    }

    #[inline(always)]
    pub fn is_second(self) -> bool {
        self.0 & SECOND != 0
    }

    #[inline(always)]
    pub fn begins(self) -> bool {
        self.0 & BEGINS != 0
    }
}
