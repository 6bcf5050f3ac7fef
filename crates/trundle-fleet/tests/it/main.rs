//! Tests of the fleet's protocols on simulated views of a run.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod instant;
mod orders;
mod robot;
mod updates;
