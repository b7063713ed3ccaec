//! Grains that meet: impacts, clumps, walls and the peers' bed, through the library's own interface.

mod chung;
mod clumps;
mod driven;
mod faults;
mod hertz;
mod peers;
mod scene;
mod walls;
