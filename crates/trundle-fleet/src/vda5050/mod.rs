//! VDA 5050, version 2.1: a robot under a master control.
//!
//! [`Vehicle`] accepts orders and instant actions and gives commands to the robot, one node at a time. It uses no network and no clock, so
//! its tests and the fuzzer need none. Source: VDA 5050, version 2.1, "Interface for the communication between automated guided vehicles
//! (AGV) and a master control".
//!
//! | part | purpose |
//! |---|---|
//! | `message` | the messages |
//! | `order_check` | check of a message against the standard's format |
//! | `order_decision` | acceptance of an order |
//! | `abilities` | abilities of the robot, and refused requests |
//! | `order_book` | the rest of an order, and the states of its actions |
//! | `drive`, `node_action` | the drive to a node and the actions at the node |
//! | `instant` | instant actions |
//! | `state_message` | the state that a master reads |

mod abilities;
mod drive;
mod errors;
mod instant;
pub(crate) mod limits;
pub mod message;
mod node_action;
mod order_book;
mod order_check;
mod order_decision;
mod state_message;
mod vehicle;

pub use state_message::{robot_position, vehicle_state, velocity};
pub use vehicle::Vehicle;
