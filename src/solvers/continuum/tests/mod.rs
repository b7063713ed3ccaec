//! Tests of the soil against closed forms.

mod elements;
mod motion;
mod plastic;
mod rest;
mod scenes;
mod surface;
