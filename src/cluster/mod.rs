//! Machines beyond this one. Pieces of work are put into tasks ([`tasks`]), tasks are given to a scheduler
//! ([`Slurm`]) and watched until their pieces are kept ([`Watch`]). What was lost is given again, with more time or
//! memory where that was missing.
//!
//! The scheduler starts `trackbed work`, and pieces come back as files of the directory of results. So nothing
//! depends on a connection: who watches may stop and go on, on this machine or another one.

mod error;
mod need;
mod scheduler;
mod slurm;
mod watch;

pub use error::ClusterError;
pub use need::{Need, Request, Task, tasks};
pub use scheduler::{Array, Ending, Scheduler, State};
pub use slurm::{Partition, Slurm};
pub use watch::{Ledger, Seen, Watch, Work};
