//! One test binary with its own worlds: the crate must not depend on the simulator.

#![allow(clippy::unwrap_used, reason = "tests")]

mod boxes;
#[allow(dead_code, reason = "the bench drives through the others")]
mod building;
mod contradiction;
mod depth_scan;
mod filter;
mod flat_room;
mod fusion;
mod grid_laws;
mod lasting;
mod live;
mod localizer;
mod maps;
mod matching;
mod matching_worlds;
mod sensor_model;
mod settings;
