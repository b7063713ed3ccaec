//! Samples, surfaces and clumps against closed forms and against each other.

mod angular;
mod bubble;
mod form;
mod grading;
mod likeness;
mod stl;
