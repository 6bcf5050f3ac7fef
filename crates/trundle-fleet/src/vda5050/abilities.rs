//! Abilities of a robot for a master, and requests that the robot must refuse.

use super::message::{Action, ErrorReport, Order, OrderEdge, OrderNode};
use crate::robot_facts::RobotFacts;

/// An action that the robot can do.
#[derive(Debug)]
pub struct Ability {
    /// Type of the action.
    pub action_type: &'static str,
    /// Description in a sentence.
    pub description: &'static str,
    /// Whether the action is allowed at a node.
    pub at_node: bool,
    /// Whether the action is allowed as an instant action.
    pub at_once: bool,
    /// Parameters: name, type, whether it may be absent.
    pub parameters: &'static [(&'static str, &'static str, bool)],
}

impl Ability {
    const fn instant(action_type: &'static str, description: &'static str) -> Self {
        Self { action_type, description, at_node: false, at_once: true, parameters: &[] }
    }

    const fn node(action_type: &'static str, description: &'static str) -> Self {
        Self { action_type, description, at_node: true, at_once: false, parameters: &[] }
    }

    /// The scopes in the standard's words.
    #[must_use]
    pub fn scopes(&self) -> Vec<&'static str> {
        let scopes = [(self.at_node, "NODE"), (self.at_once, "INSTANT")];
        scopes.into_iter().filter(|(is_so, _)| *is_so).map(|(_, scope)| scope).collect()
    }
}

/// The actions that the robot can do. All but `wait` are the standard's.
pub const ABILITIES: [Ability; 9] = [
    Ability::instant("cancelOrder", "Stops at once and drops the order."),
    Ability::instant("startPause", "Stops, and keeps the order."),
    Ability::instant("stopPause", "Continues after a pause."),
    Ability::instant("stateRequest", "Sends the state."),
    Ability::instant("factsheetRequest", "Sends the factsheet."),
    Ability {
        parameters: &[
            ("x", "NUMBER", false),
            ("y", "NUMBER", false),
            ("theta", "NUMBER", false),
            ("mapId", "STRING", false),
            ("lastNodeId", "STRING", true),
        ],
        ..Ability::instant("initPosition", "Takes a pose as that of the robot.")
    },
    Ability {
        at_once: true,
        ..Ability::node("startCharging", "Drives onto the charging station, until the battery charges.")
    },
    Ability::node("finePositioning", "Stands at the node's exact pose."),
    Ability {
        parameters: &[("duration", "NUMBER", false)],
        ..Ability::node("wait", "Waits for a time in seconds.")
    },
];

/// Optional fields of an edge that the robot cannot use.
pub const UNUSABLE_EDGE_FIELDS: [&str; 6] =
    ["trajectory", "orientation", "direction", "corridor", "maxRotationSpeed", "minHeight"];
/// Longest wait \[s\]: an hour. Source: ours.
const MAX_WAIT_S: f64 = 3600.0;
/// Lowest speed limit of an edge \[m/s\]. Source: the range of the robot's setting.
const MIN_EDGE_SPEED_M_S: f64 = 0.05;

/// Checks that the robot can carry out all parts of an order.
///
/// # Errors
/// The first impossible part, with its field.
pub fn require_able(order: &Order, facts: &RobotFacts, map_id: &str) -> Result<(), ErrorReport> {
    order.nodes.iter().try_for_each(|node| require_able_at(node, map_id))?;
    order.edges.iter().try_for_each(|edge| require_able_on(edge, facts))
}

fn refusal(description: String) -> ErrorReport {
    ErrorReport::warning("orderError", description)
}

fn require_able_at(node: &OrderNode, map_id: &str) -> Result<(), ErrorReport> {
    let id = &node.node_id;
    let about = |error: ErrorReport| error.about("nodeId", id);
    let Some(position) = &node.node_position else {
        return Err(about(refusal(format!("node {id} has no nodePosition: this robot drives to poses"))));
    };
    if position.map_id != map_id {
        let text = format!("node {id} stands on map '{}': this robot has map '{map_id}'", position.map_id);
        return Err(about(refusal(text)).about("nodePosition.mapId", &position.map_id));
    }
    node.actions.iter().try_for_each(|action| require_ability(action).map_err(about))
}

fn require_ability(action: &Action) -> Result<(), ErrorReport> {
    let about = |error: ErrorReport| {
        error.about("actionId", &action.action_id).about("actionType", &action.action_type)
    };
    let is_known =
        ABILITIES.iter().any(|ability| ability.at_node && ability.action_type == action.action_type);
    if !is_known {
        return Err(about(refusal(format!("this robot cannot do {} at a node", action.action_type))));
    }
    if action.action_type == "wait" && wait_s(action).is_none() {
        let text = format!("wait needs the parameter duration, a number from 0 to {MAX_WAIT_S} s");
        return Err(about(refusal(text)));
    }
    Ok(())
}

/// Time of a wait \[s\].
#[must_use]
pub fn wait_s(action: &Action) -> Option<f64> {
    action.number("duration").filter(|time| (0.0..=MAX_WAIT_S).contains(time))
}

fn require_able_on(edge: &OrderEdge, facts: &RobotFacts) -> Result<(), ErrorReport> {
    let id = &edge.edge_id;
    let refuse = |field: &str, text: String| {
        Err(refusal(format!("edge {id}: {text}")).about("edgeId", id).about("field", field))
    };
    if let Some(field) = unusable_field(edge) {
        return refuse(field, format!("this robot cannot use {field}"));
    }
    if edge.rotation_allowed == Some(false) {
        return refuse("rotationAllowed", "this robot turns where its path turns".to_owned());
    }
    if let Some(speed) = edge.max_speed.filter(|speed| *speed < MIN_EDGE_SPEED_M_S) {
        return refuse("maxSpeed", format!("maxSpeed is {speed} m/s, expected {MIN_EDGE_SPEED_M_S} or more"));
    }
    if let Some(height) = edge.max_height.filter(|height| *height < facts.height_m) {
        return refuse(
            "maxHeight",
            format!("maxHeight is {height} m, the robot is {} m high", facts.height_m),
        );
    }
    match edge.actions.first() {
        Some(action) => refuse("actions", format!("this robot cannot do {} on an edge", action.action_type)),
        None => Ok(()),
    }
}

fn unusable_field(edge: &OrderEdge) -> Option<&'static str> {
    let fields = &edge.unusable;
    let given = [
        fields.trajectory,
        fields.orientation,
        fields.direction,
        fields.corridor,
        fields.max_rotation_speed,
        fields.min_height,
    ];
    UNUSABLE_EDGE_FIELDS.into_iter().zip(given).find(|(_, given)| given.is_some()).map(|(field, _)| field)
}
