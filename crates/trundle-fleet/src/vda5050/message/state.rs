//! The state of a robot as a master reads it.

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
    /// Where the robot is.
    pub agv_position: RobotPosition,
    /// How fast it moves.
    pub velocity: Velocity,
    /// The load: nothing.
    pub loads: [(); 0],
    /// Whether it drives or turns.
    pub driving: bool,
    /// Whether it is paused.
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

/// How far an order is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderProgress {
    /// The present or last order; empty before the first.
    pub order_id: String,
    /// Its last update.
    pub order_update_id: u32,
    /// The last node that was reached; empty before the first.
    pub last_node_id: String,
    /// Its place in the order.
    pub last_node_sequence_id: u32,
    /// Nodes that are still to be reached.
    pub node_states: Vec<NodeState>,
    /// Edges that are still to be driven.
    pub edge_states: Vec<EdgeState>,
    /// Whether it comes to the end of the base while there is a horizon.
    pub new_base_request: bool,
    /// The actions of the order and those done at once.
    pub action_states: Vec<ActionState>,
}

impl VehicleState {
    /// Whether nothing changed that a master must know at once: all but position, speed, charge and texts for people.
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
    /// Its name.
    pub map_id: String,
    /// Its version.
    pub map_version: String,
    /// Whether it is used.
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

/// Where the robot is, map frame.
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
    /// Whether the robot knows its pose.
    pub position_initialized: bool,
    /// Standard deviation of the position along its worst axis \[m\].
    pub deviation_range: f64,
}

/// How fast the robot moves, base frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Velocity {
    /// Ahead \[m/s\].
    pub vx: f64,
    /// To the left \[m/s\].
    pub vy: f64,
    /// Turn rate \[rad/s\].
    pub omega: f64,
}

/// The state of an action.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ActionState {
    /// Its name.
    pub action_id: String,
    /// The kind.
    pub action_type: String,
    /// For people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub action_description: Option<String>,
    /// How far it is.
    pub action_status: ActionStatus,
    /// How it ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result_description: Option<String>,
}

/// How far an action is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ActionStatus {
    /// Not begun.
    Waiting,
    /// Under way.
    Running,
    /// Done.
    Finished,
    /// Not done.
    Failed,
}

impl ActionStatus {
    /// Whether it has ended.
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
    /// Whether it is being charged.
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
    /// In a word.
    pub info_type: &'static str,
    /// In a sentence.
    pub info_description: String,
    /// For whom.
    pub info_level: &'static str,
}

/// Stops by safety.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SafetyState {
    /// The emergency stop: this robot has none that it could report.
    pub e_stop: &'static str,
    /// Whether an obstacle is too near, or a condition of the body stops all wheels.
    pub field_violation: bool,
}
