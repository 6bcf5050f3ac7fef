//! Laws and closed loops of trundle-docking.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

#[path = "../../../../bench/docking/clock.rs"]
mod clock;
mod closed_loop;
mod contact;
mod inputs;
mod world;
