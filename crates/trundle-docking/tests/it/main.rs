//! Laws and closed loops of trundle-docking.

#[path = "../../../../bench/docking/clock.rs"]
mod clock;
mod closed_loop;
mod contact;
mod inputs;
mod world;
