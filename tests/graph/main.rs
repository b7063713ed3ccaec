//! The plan as data and the machine that runs it, as another program uses them: what stands against a plan, nodes,
//! schedules, tiers and passes that this crate does not know, and a plan and its checkpoints on their way through a
//! file.

mod faults;
mod ground;
mod planner;
mod saved;
mod scene;
mod schedule;
mod sinking;
