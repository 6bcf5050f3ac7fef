//! A run in Foxglove: a run of a base at rest, and viewers by WebSocket.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod access;
mod read_only;
mod shown_run;
mod topics;
mod viewer;
