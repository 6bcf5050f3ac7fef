//! Laws and closed loops of trundle-docking.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod budgets;
mod certificates;
#[path = "../../../../bench/docking/clock.rs"]
mod clock;
mod closed_loop;
#[allow(dead_code, reason = "the benchmark names them all")]
#[path = "../../../../bench/docking/clouds.rs"]
mod clouds;
mod common;
mod contact;
mod contact_laws;
mod corridors;
mod inputs;
#[allow(dead_code, reason = "the benchmark prints with it")]
#[path = "../../../../bench/docking/judge.rs"]
mod judge;
mod laws;
mod manoeuvres;
mod parts;
mod positioner_laws;
mod random_walks;
mod refusals;
mod scenes;
mod shapes;
mod world;
