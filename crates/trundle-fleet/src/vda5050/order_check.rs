//! Whether a message is an order of the standard.

use super::limits::{MAX_ACTIONS_OF_NODE, MAX_ID_BYTES, MAX_MESSAGE_BYTES, MAX_NODES};
use super::message::{Action, ErrorReport, NodePosition, Order, Topic};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use trundle_core::MAX_COORDINATE_M;

/// Reads an order and checks its format: numbers, names, sequence of nodes and edges.
///
/// # Errors
/// Error of a message that is not of the standard's form.
pub fn read_order(payload: &[u8]) -> Result<Order, ErrorReport> {
    require_size(payload, Topic::Order)?;
    let order: Order = serde_json::from_slice(payload).map_err(|error| invalid(error, Topic::Order))?;
    check(&order).map_err(|text| {
        invalid(text, Topic::Order)
            .about("orderId", shortened(&order.order_id))
            .about("orderUpdateId", order.order_update_id)
    })?;
    Ok(order)
}

/// Checks the size of a message.
///
/// # Errors
/// When the payload is too large.
pub fn require_size(payload: &[u8], topic: Topic) -> Result<(), ErrorReport> {
    let bytes = payload.len();
    if bytes <= MAX_MESSAGE_BYTES {
        return Ok(());
    }
    Err(invalid(format!("message of {bytes} bytes, expected at most {MAX_MESSAGE_BYTES}"), topic))
}

/// The error of a message that is not of the standard's form.
pub fn invalid(problem: impl ToString, topic: Topic) -> ErrorReport {
    ErrorReport::warning("validationError", shortened(&problem.to_string())).about("topic", topic.name())
}

/// A text of the network, for a report.
fn shortened(text: &str) -> String {
    text.chars().take(MAX_ID_BYTES).collect()
}

fn check(order: &Order) -> Result<(), String> {
    require_name("orderId", &order.order_id)?;
    let (nodes, edges) = (order.nodes.len(), order.edges.len());
    if nodes == 0 || nodes > MAX_NODES {
        return Err(format!("{nodes} nodes, expected 1 to {MAX_NODES}"));
    }
    if edges + 1 != nodes {
        return Err(format!("{edges} edges for {nodes} nodes, expected one fewer"));
    }
    check_sequence(order)?;
    check_nodes(order)?;
    check_edges(order)?;
    check_actions(order)
}

/// Sequence numbers alternate between nodes and edges; the base precedes the horizon.
fn check_sequence(order: &Order) -> Result<(), String> {
    let mut next = order.nodes[0].sequence_id;
    let mut is_released = true;
    if !order.nodes[0].released {
        return Err("the first node is not released".to_owned());
    }
    for (i, node) in order.nodes.iter().enumerate() {
        if i > 0 {
            let edge = &order.edges[i - 1];
            next = follow(next, edge.sequence_id, &edge.edge_id)?;
            next = follow(next, node.sequence_id, &node.node_id)?;
            if edge.released != node.released {
                return Err(format!("edge {} and its end node are not released together", edge.edge_id));
            }
        }
        if node.released && !is_released {
            return Err(format!("node {} is released behind one that is not", node.node_id));
        }
        is_released = node.released;
    }
    Ok(())
}

fn follow(last: u32, sequence_id: u32, name: &str) -> Result<u32, String> {
    if last.checked_add(1) == Some(sequence_id) {
        return Ok(sequence_id);
    }
    Err(format!("{name} has sequenceId {sequence_id} behind {last}, expected one more"))
}

fn check_nodes(order: &Order) -> Result<(), String> {
    for node in &order.nodes {
        require_name("nodeId", &node.node_id)?;
        if let Some(position) = &node.node_position {
            check_position(position).map_err(|text| format!("node {}: {text}", node.node_id))?;
        }
        let actions = node.actions.len();
        if actions > MAX_ACTIONS_OF_NODE {
            return Err(format!(
                "node {}: {actions} actions, expected up to {MAX_ACTIONS_OF_NODE}",
                node.node_id
            ));
        }
    }
    Ok(())
}

fn check_position(position: &NodePosition) -> Result<(), String> {
    let is_in = |name: &str, value: f64, min: f64, max: f64| {
        let is_in = (min..=max).contains(&value);
        if is_in { Ok(()) } else { Err(format!("{name} is {value}, expected {min} to {max}")) }
    };
    require_name("mapId", &position.map_id)?;
    is_in("x", position.x, -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
    is_in("y", position.y, -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
    is_in("theta", position.theta.unwrap_or(0.0), -PI - 1e-6, PI + 1e-6)?;
    is_in("allowedDeviationXY", position.allowed_deviation_xy.unwrap_or(0.0), 0.0, MAX_COORDINATE_M)?;
    is_in("allowedDeviationTheta", position.allowed_deviation_theta.unwrap_or(0.0), 0.0, PI + 1e-6)
}

fn check_edges(order: &Order) -> Result<(), String> {
    for (i, edge) in order.edges.iter().enumerate() {
        require_name("edgeId", &edge.edge_id)?;
        let ends = (&order.nodes[i].node_id, &order.nodes[i + 1].node_id);
        if ends != (&edge.start_node_id, &edge.end_node_id) {
            let (start, end) = ends;
            return Err(format!("edge {} does not lead from node {start} to node {end}", edge.edge_id));
        }
        if edge.max_speed.is_some_and(|speed| !speed.is_finite() || speed < 0.0) {
            return Err(format!("edge {}: maxSpeed is not a speed", edge.edge_id));
        }
    }
    Ok(())
}

fn check_actions(order: &Order) -> Result<(), String> {
    let of_edges = order.edges.iter().flat_map(|edge| &edge.actions);
    let mut names = BTreeSet::new();
    for action in order.nodes.iter().flat_map(|node| &node.actions).chain(of_edges) {
        check_action(action)?;
        if !names.insert(&action.action_id) {
            return Err(format!("two actions have the actionId {}", action.action_id));
        }
    }
    Ok(())
}

/// Checks the names of an action.
///
/// # Errors
/// When one is empty or too long.
pub fn check_action(action: &Action) -> Result<(), String> {
    require_name("actionId", &action.action_id)?;
    require_name("actionType", &action.action_type)
}

fn require_name(field: &str, name: &str) -> Result<(), String> {
    let bytes = name.len();
    if (1..=MAX_ID_BYTES).contains(&bytes) {
        return Ok(());
    }
    Err(format!("{field} has {bytes} bytes, expected 1 to {MAX_ID_BYTES}"))
}
