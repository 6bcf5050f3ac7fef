//! An order of a master: nodes to reach and edges between them.

use super::header::MessageHeader;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

/// An order, or an update of one. Units are m, rad and m/s; poses are in the map frame.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Order {
    /// The header.
    #[serde(flatten)]
    pub header: MessageHeader,
    /// Name of the order.
    pub order_id: String,
    /// Number of the update, from 0.
    pub order_update_id: u32,
    /// Nodes in the order in which they are reached.
    pub nodes: Vec<OrderNode>,
    /// Edges between the nodes, one fewer.
    pub edges: Vec<OrderEdge>,
}

/// A place to reach.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderNode {
    /// Name.
    pub node_id: String,
    /// Place among the nodes and edges of the order.
    pub sequence_id: u32,
    /// For people.
    pub node_description: Option<String>,
    /// Whether the node may be driven to: it is part of the base, not of the horizon.
    pub released: bool,
    /// Position of the node.
    pub node_position: Option<NodePosition>,
    /// Actions at the node.
    pub actions: Vec<Action>,
}

/// Position of a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NodePosition {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// Heading at the node \[rad\]; `None`: any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub theta: Option<f64>,
    /// Radius within which the node counts as reached \[m\].
    #[serde(rename = "allowedDeviationXY", skip_serializing_if = "Option::is_none")]
    pub allowed_deviation_xy: Option<f64>,
    /// Largest deviation from the heading \[rad\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowed_deviation_theta: Option<f64>,
    /// The map.
    pub map_id: String,
}

/// A path between two nodes.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct OrderEdge {
    /// Name.
    pub edge_id: String,
    /// Place among the nodes and edges of the order.
    pub sequence_id: u32,
    /// For people.
    pub edge_description: Option<String>,
    /// Whether the edge is part of the base.
    pub released: bool,
    /// The node before.
    pub start_node_id: String,
    /// The node behind.
    pub end_node_id: String,
    /// Highest speed \[m/s\].
    pub max_speed: Option<f64>,
    /// Highest that the robot may be \[m\].
    pub max_height: Option<f64>,
    /// Whether the robot may turn on the edge.
    pub rotation_allowed: Option<bool>,
    /// The action on the edge.
    pub actions: Vec<Action>,
    /// Fields that this robot cannot use.
    #[serde(flatten)]
    pub unusable: UnusableFields,
}

/// Fields of an edge that this robot cannot use.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct UnusableFields {
    /// A curve.
    pub trajectory: Option<IgnoredAny>,
    /// A heading on the edge.
    pub orientation: Option<IgnoredAny>,
    /// A direction at junctions of lines.
    pub direction: Option<IgnoredAny>,
    /// Boundaries about the edge.
    pub corridor: Option<IgnoredAny>,
    /// Highest turn rate.
    pub max_rotation_speed: Option<IgnoredAny>,
    /// Lowest height of a load.
    pub min_height: Option<IgnoredAny>,
}

/// Something to do.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Action {
    /// Type of the action.
    pub action_type: String,
    /// Name, by which its state is reported.
    pub action_id: String,
    /// For people.
    pub action_description: Option<String>,
    /// Actions that may run at the same time.
    pub blocking_type: BlockingType,
    /// Parameters of the action.
    #[serde(default)]
    pub action_parameters: Vec<ActionParameter>,
}

/// Actions that may run at the same time as an action.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum BlockingType {
    /// Driving and other actions.
    None,
    /// Other actions, no driving.
    Soft,
    /// No other actions, no driving.
    Hard,
}

/// A parameter of an action.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ActionParameter {
    /// Name of the parameter.
    pub key: String,
    /// Value of the parameter.
    pub value: serde_json::Value,
}

impl Action {
    /// A parameter that is a number, or the text of one.
    #[must_use]
    pub fn number(&self, key: &str) -> Option<f64> {
        let value = self.value(key)?;
        value.as_f64().or_else(|| value.as_str()?.trim().parse().ok()).filter(|number| number.is_finite())
    }

    /// A parameter that is a text.
    #[must_use]
    pub fn text(&self, key: &str) -> Option<&str> {
        self.value(key)?.as_str()
    }

    fn value(&self, key: &str) -> Option<&serde_json::Value> {
        self.action_parameters.iter().find(|parameter| parameter.key == key).map(|parameter| &parameter.value)
    }
}
