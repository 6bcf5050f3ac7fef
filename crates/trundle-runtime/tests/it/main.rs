//! The robot as a whole, fed by hand: no simulator here.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod background;
mod config;
mod crew;
mod robot;
