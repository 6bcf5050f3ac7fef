//! Tests of the live page as a browser and as an attacker see it, on a run of a base at rest.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod browser;
mod guard;
mod live_run;
mod steering;
mod viewers;
mod zones;
