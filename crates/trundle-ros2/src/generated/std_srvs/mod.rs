//! `std_srvs`. Written by `cargo xtask ros-interfaces`.

mod empty;
mod set_bool;
mod trigger;

pub use empty::*;
pub use set_bool::*;
pub use trigger::*;
