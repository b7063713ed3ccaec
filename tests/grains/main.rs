//! The grain kernel against closed forms, an independent plain solver, and what must hold of every bed.

mod oracle;
mod scenes;

mod agreement;
mod conservation;
mod determinism;
mod energy;
mod frames;
mod impact;
mod modes;
mod moving;
mod periodic;
mod sliding;
mod stability;
mod statics;
