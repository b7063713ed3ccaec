//! The grain kernel against closed forms, an independent plain solver, and what must hold of every bed.

mod oracle;
mod scenes;

mod agreement;
mod frames;
mod impact;
mod modes;
mod sliding;
mod stability;
mod statics;
