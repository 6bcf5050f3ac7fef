//! Runs: session, recorder, replayer, checkpoint writer, report. The body of these runs has no camera unless a test says so.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "workers of tests; figures of the results")]

mod body;
mod calibrate;
mod calibrate_camera;
mod checkpoint_writer;
mod contact;
mod convert;
mod convert_camera;
mod files;
mod jitter;
mod operator;
mod other_driver;
mod recorded_sequence;
mod recording;
mod report;
mod robot_bag;
mod run_log;
mod session;
