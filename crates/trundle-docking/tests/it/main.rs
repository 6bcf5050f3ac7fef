//! Laws and closed loops of trundle-docking.

mod closed_loop;
mod contact;
mod inputs;
mod world;
