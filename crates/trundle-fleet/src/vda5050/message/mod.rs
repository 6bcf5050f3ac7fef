//! The messages of VDA 5050, version 2.1: received and sent ones.

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
pub use header::{HeaderCounter, Identity, MessageHeader, PROTOCOL_VERSION, Topic};
pub use instant_actions::InstantActions;
pub use order::{
    Action, ActionParameter, BlockingType, NodePosition, Order, OrderEdge, OrderNode, UnusableFields,
};
pub use report::{ErrorLevel, ErrorReport};
pub use state::{
    ActionState, ActionStatus, ChargeState, EdgeState, Information, LoadedMap, NodeState, OperatingMode,
    OrderProgress, RobotPosition, SafetyState, VehicleState, Velocity,
};
pub use visualization::Visualization;
