//! `lifecycle_msgs`. Written by `cargo xtask ros-interfaces`.

mod change_state;
mod get_available_states;
mod get_available_transitions;
mod get_state;
mod state;
mod transition;
mod transition_description;
mod transition_event;

pub use change_state::*;
pub use get_available_states::*;
pub use get_available_transitions::*;
pub use get_state::*;
pub use state::*;
pub use transition::*;
pub use transition_description::*;
pub use transition_event::*;
