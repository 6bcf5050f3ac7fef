//! `diagnostic_msgs`. Written by `cargo xtask ros-interfaces`.

mod diagnostic_array;
mod diagnostic_status;
mod key_value;

pub use diagnostic_array::*;
pub use diagnostic_status::*;
pub use key_value::*;
