//! The robot as a whole, fed by hand: no simulator here.
#![allow(clippy::unwrap_used, reason = "workers of tests")]

mod background;
mod body_events;
mod checkpoint;
mod config;
mod laws;
mod load_map;
mod logs;
mod operator;
mod robot;
mod states;
mod stop_priority;
mod worker_threads;
