//! Beds as a whole: copies side by side, checkpoints, and what must not change a bit.

mod bed;
mod checkpoint;
mod loaded;
mod replicate;
