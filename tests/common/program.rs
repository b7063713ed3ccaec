//! Runs the program as a person does.

use std::process::{Command, Output};

pub fn trackbed(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trackbed")).args(arguments).env("NO_COLOR", "1").output().unwrap()
}

/// Everything that it printed.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}
