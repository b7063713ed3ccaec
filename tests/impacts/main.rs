//! Grains that meet: impacts, clumps, walls and the peers' bed, through the library's own interface.

mod faults;
