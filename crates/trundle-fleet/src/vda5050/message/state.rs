//! The state of a robot in a master's format.

use super::header::MessageHeader;
use super::order::{NodePosition, OrderEdge, OrderNode};
use super::report::ErrorReport;
use serde::Serialize;

/// The state of a robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct VehicleState {
    /// The header.
    #[serde(flatten)]
    pub header: MessageHeader,
    /// The maps that the robot has.
    pub maps: Vec<LoadedMap>,
    /// The order.
    #[serde(flatten)]
    pub order: OrderProgress,
    /// Position of the robot.
    pub agv_position: RobotPosition,
    /// Velocity of the robot.
    pub velocity: Velocity,
    /// The load: always empty.
    pub loads: [(); 0],
    /// Whether the robot drives or turns.
    pub driving: bool,
    /// Whether the robot is paused.
    pub paused: bool,
    /// The battery.
    pub battery_state: ChargeState,
    /// Controller of the robot.
    pub operating_mode: OperatingMode,
    /// The problem.
    pub errors: Vec<ErrorReport>,
    /// Further notes for a person.
    pub information: Vec<Information>,
    /// Stops by safety.
    pub safety_state: SafetyState,
}

/// Progress of an order.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderProgress {
    /// The present or last order; empty before the first.
    pub order_id: String,
    /// Number of the last update.
    pub order_update_id: u32,
    /// The last node that was reached; empty before the first.
    pub last_node_id: String,
    /// Sequence number of the node in the order.
    pub last_node_sequence_id: u32,
    /// Nodes that are still to be reached.
    pub node_states: Vec<NodeState>,
    /// Edges that are still to be driven.
    pub edge_states: Vec<EdgeState>,
    /// Whether the robot approaches the end of the base while a horizon exists.
    pub new_base_request: bool,
    /// States of the order's actions and of instant actions.
    pub action_states: Vec<ActionState>,
}

impl VehicleState {
    /// Whether both states are equal except for details that are not urgent for a master: position, speed, charge and texts.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let same = |state: &Self| Self {
            agv_position: other.agv_position.clone(),
            velocity: other.velocity.clone(),
            information: other.information.clone(),
            battery_state: ChargeState {
                charging: state.battery_state.charging,
                ..other.battery_state.clone()
            },
            ..state.clone()
        };
        same(self) == *other
    }
}

/// A map that the robot has.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LoadedMap {
    /// Name of the map.
    pub map_id: String,
    /// Version of the map.
    pub map_version: String,
    /// Whether the map is in use.
    pub map_status: &'static str,
}

/// A node that is still to be reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NodeState {
    node_id: String,
    sequence_id: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    node_description: Option<String>,
    released: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    node_position: Option<NodePosition>,
}

impl From<&OrderNode> for NodeState {
    fn from(node: &OrderNode) -> Self {
        Self {
            node_id: node.node_id.clone(),
            sequence_id: node.sequence_id,
            node_description: node.node_description.clone(),
            released: node.released,
            node_position: node.node_position.clone(),
        }
    }
}

/// An edge that is still to be driven.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct EdgeState {
    edge_id: String,
    sequence_id: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    edge_description: Option<String>,
    released: bool,
}

impl From<&OrderEdge> for EdgeState {
    fn from(edge: &OrderEdge) -> Self {
        Self {
            edge_id: edge.edge_id.clone(),
            sequence_id: edge.sequence_id,
            edge_description: edge.edge_description.clone(),
            released: edge.released,
        }
    }
}

/// Pose of the robot, map frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RobotPosition {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Heading \[rad\].
    pub theta: f64,
    /// The map.
    pub map_id: String,
    /// Whether the pose of the robot is known.
    pub position_initialized: bool,
    /// Standard deviation of the position along its most uncertain axis \[m\].
    pub deviation_range: f64,
}

/// Velocity of the robot, base frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Velocity {
    /// Ahead \[m/s\].
    pub vx: f64,
    /// Velocity to the left \[m/s\].
    pub vy: f64,
    /// Turn rate \[rad/s\].
    pub omega: f64,
}

/// The state of an action.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ActionState {
    /// Name of the action.
    pub action_id: String,
    /// The kind.
    pub action_type: String,
    /// For people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub action_description: Option<String>,
    /// State of the action.
    pub action_status: ActionStatus,
    /// Result of the action.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result_description: Option<String>,
}

/// State of an action.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ActionStatus {
    /// The action has not started.
    Waiting,
    /// In execution.
    Running,
    /// Done.
    Finished,
    /// The action failed.
    Failed,
}

impl ActionStatus {
    /// Whether the action has ended.
    #[must_use]
    pub fn is_over(self) -> bool {
        matches!(self, Self::Finished | Self::Failed)
    }
}

/// The battery.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ChargeState {
    /// Charge \[%\].
    pub battery_charge: f64,
    /// Voltage \[V\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub battery_voltage: Option<f64>,
    /// Whether the battery is being charged.
    pub charging: bool,
}

/// Controller of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum OperatingMode {
    /// The master.
    Automatic,
    /// A person.
    Manual,
}

/// Further notes for a person.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Information {
    /// Type of the information in a word.
    pub info_type: &'static str,
    /// The information in a sentence.
    pub info_description: String,
    /// For whom.
    pub info_level: &'static str,
}

/// Stops by safety.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SafetyState {
    /// The emergency stop: this robot reports none.
    pub e_stop: &'static str,
    /// Whether an obstacle is too near, or a condition of the body stops all wheels.
    pub field_violation: bool,
}
