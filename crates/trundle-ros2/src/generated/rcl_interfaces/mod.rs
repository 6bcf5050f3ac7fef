//! `rcl_interfaces`. Written by `cargo xtask ros-interfaces`.

mod describe_parameters;
mod floating_point_range;
mod get_parameter_types;
mod get_parameters;
mod integer_range;
mod list_parameters;
mod list_parameters_result;
mod log;
mod parameter;
mod parameter_descriptor;
mod parameter_event;
mod parameter_type;
mod parameter_value;
mod set_parameters;
mod set_parameters_atomically;
mod set_parameters_result;

pub use describe_parameters::*;
pub use floating_point_range::*;
pub use get_parameter_types::*;
pub use get_parameters::*;
pub use integer_range::*;
pub use list_parameters::*;
pub use list_parameters_result::*;
pub use log::*;
pub use parameter::*;
pub use parameter_descriptor::*;
pub use parameter_event::*;
pub use parameter_type::*;
pub use parameter_value::*;
pub use set_parameters::*;
pub use set_parameters_atomically::*;
pub use set_parameters_result::*;
