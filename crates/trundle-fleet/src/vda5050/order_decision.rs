//! Decides whether an order is accepted. Source: VDA 5050 2.1, figure 8; the numbers in brackets are those of the figure.

use super::message::{ErrorReport, Order, OrderNode};
use super::order_book::OrderBook;
use trundle_core::{Hypotenuse, Pose2, difference_of_angles};

/// Largest distance of the robot from the first node of a new order without an allowed deviation \[m\]. Source: ours, a robot's radius.
const START_DEVIATION_M: f64 = 0.2;

/// Result of an order of the standard's form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrderDecision {
    /// A new order after the last one has ended.
    New,
    /// An update of the present or the last order.
    Update,
    /// A repetition of a received order.
    Discard,
}

/// Decides about an order for a robot at `pose`.
///
/// # Errors
/// Reason for the rejection.
pub fn decide(order: &Order, book: &OrderBook, pose: Pose2) -> Result<OrderDecision, ErrorReport> {
    if order.order_id != book.order_id() {
        return decide_new(order, book, pose);
    }
    let (update, present) = (order.order_update_id, book.update_id());
    if update < present {
        let text = format!("orderUpdateId {update} is older than the present one, {present}"); // (5)
        return Err(ErrorReport::warning("orderUpdateError", text));
    }
    if update == present {
        return Ok(OrderDecision::Discard); // (6)
    }
    let Some((node_id, sequence_id)) = book.end_of_base() else {
        return decide_new(order, book, pose); // a cancelled order that never reached a node
    };
    let first = &order.nodes[0];
    if (first.node_id.as_str(), first.sequence_id) == (node_id, sequence_id) {
        return Ok(OrderDecision::Update); // (7), (8)
    }
    let text = format!(
        "the update begins at node {} ({}), expected the end of the base: node {node_id} ({sequence_id})",
        first.node_id, first.sequence_id
    );
    Err(ErrorReport::warning("orderUpdateError", text).about("nodeId", &first.node_id))
}

fn decide_new(order: &Order, book: &OrderBook, pose: Pose2) -> Result<OrderDecision, ErrorReport> {
    if book.is_active() {
        let text = format!("order {} is not done: cancel it first", book.order_id()); // (3)
        return Err(ErrorReport::warning("orderError", text).hint("cancelOrder"));
    }
    let first = &order.nodes[0];
    if stands_at(first, pose) {
        return Ok(OrderDecision::New);
    }
    let text = format!(
        "the robot at ({:.2}, {:.2}) m is outside the deviation of the first node, {}", // (4)
        pose.x, pose.y, first.node_id
    );
    Err(ErrorReport::warning("noRouteError", text).about("nodeId", &first.node_id))
}

/// Whether a robot is at a node, independent of its heading.
fn stands_at(node: &OrderNode, pose: Pose2) -> bool {
    let Some(position) = &node.node_position else { return false };
    let deviation = position.allowed_deviation_xy.unwrap_or(0.0).max(START_DEVIATION_M);
    (position.x - pose.x).hypotenuse(position.y - pose.y) <= deviation
}

/// Whether a robot is within the allowed deviations of a node. Without allowed deviations the robot must drive to the pose itself.
#[must_use]
pub fn is_within_deviation(node: &OrderNode, pose: Pose2) -> bool {
    let Some(position) = &node.node_position else { return false };
    let allowed = position.allowed_deviation_xy.unwrap_or(0.0);
    let heading_error = position.theta.map_or(0.0, |theta| difference_of_angles(theta, pose.theta).abs());
    allowed > 0.0
        && (position.x - pose.x).hypotenuse(position.y - pose.y) <= allowed
        && heading_error <= position.allowed_deviation_theta.unwrap_or(0.0).max(f64::EPSILON)
}
