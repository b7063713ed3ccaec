//! When a bed is at rest: by the forces that are out of balance, not by a count of steps.

pub(super) use super::super::measure::unbalance;
