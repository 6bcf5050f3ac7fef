//! `action_msgs`. Written by `cargo xtask ros-interfaces`.

mod cancel_goal;
mod goal_info;
mod goal_status;
mod goal_status_array;

pub use cancel_goal::*;
pub use goal_info::*;
pub use goal_status::*;
pub use goal_status_array::*;
