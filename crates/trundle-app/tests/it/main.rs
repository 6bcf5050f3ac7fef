//! Runs on a body without a camera: session, recorder, replayer, checkpoint writer, report.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "workers of tests; figures of the results")]

mod body;
mod calibrate;
mod calibrate_camera;
mod checkpoint_writer;
mod contact;
mod files;
mod operator;
mod recorded_sequence;
mod recording;
mod report;
mod run_log;
mod session;
