//! Tests of the live page from a browser's and an attacker's view, on a run of a base at rest.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod browser;
mod guard;
mod half_open;
mod live_run;
mod many_connections;
mod pipelined;
mod steering;
#[cfg(feature = "tls")]
mod tls;
mod viewers;
mod zones;
