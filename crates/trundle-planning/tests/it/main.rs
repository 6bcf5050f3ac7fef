//! The planner through its public interface.

#![expect(clippy::unwrap_used, reason = "test helpers")]
#![expect(clippy::print_stderr, reason = "measured numbers and skip lines")]

mod ascii;
mod bad_input;
mod curvature;
mod discovery;
mod escape;
mod fields;
mod footprints;
mod gaps;
mod laws;
mod maps;
mod masks;
mod moving;
mod multi_goal;
mod nav_data;
mod outline_judge;
mod replanning;
mod rules;
mod settings;
mod size;
mod strange;
mod support;
mod symmetry;
mod timing;
mod tracking;
