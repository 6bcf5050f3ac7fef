//! The robot as a whole, fed by hand: no simulator here.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod background;
mod checkpoint;
mod config;
mod crew;
mod laws;
mod logs;
mod robot;
mod states;
