//! The planner as its user sees it.

mod ascii;
mod bad_input;
mod laws;
mod maps;
mod replanning;
mod size;
mod support;
