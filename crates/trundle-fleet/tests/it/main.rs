//! Tests of the fleet's protocols on views of a run that is not there.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod instant;
mod orders;
mod robot;
mod updates;
