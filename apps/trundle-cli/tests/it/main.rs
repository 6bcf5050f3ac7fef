//! The program from a user's view: arguments in, files, sentences and exit codes out.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "helpers of tests")]

mod bad_input;
mod bag_replay;
mod calibrate;
mod config;
mod demo;
mod dock;
mod doctor;
#[cfg(all(feature = "ros2", feature = "mqtt", feature = "foxglove", feature = "tls"))]
mod documented_commands;
mod endings;
mod eval_trajectory;
mod experiment_shards;
mod experiments;
mod fault_scenarios;
mod foreign_files;
mod help;
mod inputs;
mod live_page;
#[cfg(unix)]
mod live_run;
mod logs;
mod map;
mod map_tools;
mod missions;
#[cfg(target_os = "linux")]
mod no_open_port;
mod no_success;
mod nothing_lost;
mod output_places;
mod plan;
mod program;
mod real_time;
mod sim;
mod sim_files;
mod slam;
mod slam_degraded_input;
mod slam_in_the_dark;
mod vocabulary;
