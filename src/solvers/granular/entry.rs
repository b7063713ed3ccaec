//! A contact as its pebbles list it: in one number.

use bytemuck::{Pod, Zeroable};

/// A contact of a pebble.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct Entry(u32);

impl Entry {
    /// The contact at `place` of the outcomes, for its first or its second pebble.
    pub fn new(place: u32, is_second: bool) -> Entry {
        Entry(place << 1 | u32::from(is_second))
    }

    #[inline(always)]
    pub fn place(self) -> usize {
        (self.0 >> 1) as usize
    }

    #[inline(always)]
    pub fn is_second(self) -> bool {
        self.0 & 1 != 0
    }
}
