//! Work on other machines. Pieces of work are put into tasks ([`tasks`]). Tasks are submitted to a scheduler
//! ([`Slurm`]) and watched until their pieces are kept ([`Watch`]). Lost tasks are submitted again, with more time or
//! memory if they had too little.
//!
//! The scheduler starts `trackbed work`, and pieces come back as files in the directory of results. No connection is
//! needed: the watching program may stop and continue, on this machine or on another.

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
