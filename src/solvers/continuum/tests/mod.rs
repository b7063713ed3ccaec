//! The soil against closed forms.

mod elements;
mod motion;
mod rest;
mod scenes;
mod surface;
