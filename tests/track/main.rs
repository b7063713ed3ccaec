//! The track solver against solutions that share none of its code: closed forms, modal sums of matrices assembled here,
//! and what must hold of every run.

mod modal;
mod scenes;
#[path = "../../benches/shared/wagon.rs"]
mod wagon;

mod bogie;
mod bouncing;
mod chatter;
mod equal_models;
mod equilibrium;
mod frequencies;
mod mesh;
mod moving_force;
mod released;
mod shear_beams;
mod stiffness_jump;
mod support_stiffness;
