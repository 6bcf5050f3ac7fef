//! The SLAM as a whole: on rendered rooms with known motion, and on a recorded sequence.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, reason = "tests, helpers included")]

#[path = "../support/align.rs"]
mod align;
mod consistency;
mod determinism;
#[path = "../support/drive.rs"]
mod drive;
mod freiburg;
mod localise;
mod maps;
mod memory;
mod points;
mod robustness;
mod room;
mod saving;
mod settings;
mod synthetic;
mod walks;
mod wheels;
