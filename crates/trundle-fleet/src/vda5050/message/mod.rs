//! The messages of VDA 5050, version 2.1: those that are read and those that are sent.

mod connection;
mod factsheet;
mod header;
mod instant_actions;
mod order;
mod report;
mod state;
mod visualization;

pub use connection::{ConnectionMessage, ConnectionState};
pub use factsheet::Factsheet;
pub use header::{Header, HeaderCounter, Identity, PROTOCOL_VERSION, Topic};
pub use instant_actions::InstantActions;
pub use order::{Action, ActionParameter, BlockingType, Edge, Node, NodePosition, Order};
pub use report::{ErrorLevel, ErrorReport};
pub use state::{
    ActionState, ActionStatus, BatteryState, EdgeState, Information, LoadedMap, NodeState, OperatingMode,
    RobotPosition, SafetyState, State, Velocity,
};
pub use visualization::Visualization;
