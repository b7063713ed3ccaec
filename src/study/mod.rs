//! Studies of a scene: its results when values vary.
//!
//! [`design`](mod@design) chooses the points of a study that a file declares, [`plan`](fn@plan) checks and costs them
//! all, [`perform`](fn@perform) runs one, and [`Answer`] holds the results and the best design; [`StudyFolder`] is its
//! directory. [`Runs`] are some of its runs for another process.

mod answer;
mod as_it_is;
mod compared;
pub mod design;
mod findings;
mod folder;
mod found;
mod miss;
mod next;
mod outcome;
mod packings;
mod perform;
mod plan;
mod point;
mod runs;

pub use answer::{Answer, Row};
pub use compared::{Difference, MetAndMissed, amount};
pub use folder::{PAGE, StudyFolder};
pub use miss::Miss;
pub use next::{Next, next};
pub use outcome::PointOutcome;
pub use packings::Verdict;
pub use perform::{Repeat, perform};
pub use plan::{Plan, plan, plan_told};
pub use point::{PlannedPoint, Scene, values};
pub use runs::{Runs, TaskRun};
