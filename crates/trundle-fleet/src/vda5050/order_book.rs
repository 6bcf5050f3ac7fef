//! The present order: its remaining parts, and the states of its actions.

use super::message::{Action, ActionState, ActionStatus, Order, OrderEdge, OrderNode};
use std::collections::VecDeque;

/// Maximum number of stored ended instant actions. Source: ours.
const MAX_ENDED_INSTANT_ACTIONS: usize = 32;

/// The present or last order.
#[derive(Debug, Default)]
pub struct OrderBook {
    order_id: String,
    update_id: u32,
    last_node: Option<(String, u32)>,
    nodes: VecDeque<OrderNode>,
    edges: VecDeque<OrderEdge>,
    /// Actions of the last node that are not begun.
    at_node: VecDeque<Action>,
    actions: Vec<ActionState>,
    instant_actions: Vec<ActionState>,
}

impl OrderBook {
    /// Name of the order; empty before the first.
    #[must_use]
    pub fn order_id(&self) -> &str {
        &self.order_id
    }

    /// Number of the last update.
    #[must_use]
    pub fn update_id(&self) -> u32 {
        self.update_id
    }

    /// The last node that was reached.
    #[must_use]
    pub fn last_node(&self) -> Option<(&str, u32)> {
        self.last_node.as_ref().map(|(id, sequence_id)| (id.as_str(), *sequence_id))
    }

    /// Nodes that are still to be reached, the horizon's included.
    #[must_use]
    pub fn nodes(&self) -> &VecDeque<OrderNode> {
        &self.nodes
    }

    /// Edges that are still to be driven.
    #[must_use]
    pub fn edges(&self) -> &VecDeque<OrderEdge> {
        &self.edges
    }

    /// States of the order's actions, then those of instant actions.
    pub fn action_states(&self) -> impl Iterator<Item = &ActionState> {
        self.actions.iter().chain(&self.instant_actions)
    }

    /// Whether an order is in progress or waits for its continuation.
    #[must_use]
    pub fn is_active(&self) -> bool {
        !self.nodes.is_empty() || self.actions.iter().any(|action| !action.action_status.is_over())
    }

    /// The next released node, and the edge to this node.
    #[must_use]
    pub fn next_stop(&self) -> Option<(&OrderNode, Option<&OrderEdge>)> {
        let node = self.nodes.front().filter(|node| node.released)?;
        Some((node, self.edges.front().filter(|edge| edge.sequence_id < node.sequence_id)))
    }

    /// Whether the next node is the last of the base.
    #[must_use]
    pub fn is_at_end_of_base(&self) -> bool {
        self.nodes.get(1).is_none_or(|node| !node.released)
    }

    /// Whether nodes wait for their release.
    #[must_use]
    pub fn has_horizon(&self) -> bool {
        self.nodes.back().is_some_and(|node| !node.released)
    }

    /// Required start of an update: the last released node.
    #[must_use]
    pub fn end_of_base(&self) -> Option<(&str, u32)> {
        let released = self.nodes.iter().rev().find(|node| node.released);
        released.map(|node| (node.node_id.as_str(), node.sequence_id)).or(self.last_node())
    }

    /// Takes a new order over in place of the last one. Instant actions that have ended are discarded.
    pub fn begin(&mut self, order: Order) {
        let mut instant_actions = std::mem::take(&mut self.instant_actions);
        instant_actions.retain(|action| !action.action_status.is_over());
        *self = Self { last_node: self.last_node.take(), instant_actions, ..Self::default() };
        self.order_id = order.order_id;
        self.update_id = order.order_update_id;
        self.add_actions(order.nodes.iter().flat_map(|node| &node.actions));
        self.nodes = order.nodes.into();
        self.edges = order.edges.into();
    }

    /// Takes an update over: its first node is the end of the base; the horizon is replaced.
    pub fn extend(&mut self, order: Order) {
        self.update_id = order.order_update_id;
        self.drop_horizon();
        self.add_actions(order.nodes.iter().flat_map(|node| &node.actions));
        let mut nodes = order.nodes.into_iter();
        if let Some(stitch) = nodes.next() {
            self.stitch(stitch);
        }
        self.nodes.extend(nodes);
        self.edges.extend(order.edges);
    }

    /// New actions of an update's first node are appended to the actions of the existing node.
    fn stitch(&mut self, stitch: OrderNode) {
        match self.nodes.back_mut() {
            Some(end) => {
                let known: Vec<String> = end.actions.iter().map(|action| action.action_id.clone()).collect();
                let is_new = |action: &Action| !known.contains(&action.action_id);
                end.actions.extend(stitch.actions.into_iter().filter(is_new));
            }
            None => {
                let status = |id: &str| self.actions.iter().find(|state| state.action_id == id);
                let is_new = |action: &Action| {
                    status(&action.action_id)
                        .is_some_and(|state| state.action_status == ActionStatus::Waiting)
                };
                let new: Vec<Action> = stitch.actions.into_iter().filter(is_new).collect();
                self.at_node.extend(new);
            }
        }
    }

    fn drop_horizon(&mut self) {
        let horizon: Vec<String> = self
            .nodes
            .iter()
            .filter(|node| !node.released)
            .flat_map(|node| node.actions.iter().map(|action| action.action_id.clone()))
            .collect();
        self.actions.retain(|state| !horizon.contains(&state.action_id));
        self.nodes.retain(|node| node.released);
        self.edges.retain(|edge| edge.released);
    }

    fn add_actions<'a>(&mut self, actions: impl Iterator<Item = &'a Action>) {
        for action in actions {
            if !self.actions.iter().any(|state| state.action_id == action.action_id) {
                self.actions.push(waiting(action));
            }
        }
    }

    /// The next node is reached.
    pub fn reach(&mut self) {
        let Some(node) = self.nodes.pop_front() else { return };
        self.edges.retain(|edge| edge.sequence_id > node.sequence_id);
        self.last_node = Some((node.node_id, node.sequence_id));
        self.at_node.extend(node.actions);
    }

    /// The next action of the last node.
    #[must_use]
    pub fn next_action(&self) -> Option<&Action> {
        self.at_node.front()
    }

    /// Takes the next action out.
    pub fn take_action(&mut self) -> Option<Action> {
        self.at_node.pop_front()
    }

    /// Sets the robot's node, given by a master or a person.
    pub fn set_last_node(&mut self, node_id: &str) {
        self.last_node = Some((node_id.to_owned(), 0));
    }

    /// Drops the remaining nodes and edges. The name of the order remains.
    pub fn drop_nodes(&mut self) {
        self.nodes.clear();
        self.edges.clear();
    }

    /// The open actions of the order have failed.
    pub fn fail_actions(&mut self) {
        self.at_node.clear();
        for action in self.actions.iter_mut().filter(|action| !action.action_status.is_over()) {
            action.action_status = ActionStatus::Failed;
        }
    }

    /// Notes an instant action.
    pub fn add_instant_action(&mut self, action: &Action) {
        self.instant_actions.push(waiting(action));
        if self.instant_actions.len() > MAX_ENDED_INSTANT_ACTIONS {
            let ended = self.instant_actions.iter().position(|state| state.action_status.is_over());
            self.instant_actions.remove(ended.unwrap_or(0));
        }
    }

    /// Whether an action of this name is known.
    #[must_use]
    pub fn knows_action(&self, action_id: &str) -> bool {
        self.action_states().any(|state| state.action_id == action_id)
    }

    /// Sets the state of an action.
    pub fn set_status(&mut self, action_id: &str, status: ActionStatus, result: Option<String>) {
        let states = self.actions.iter_mut().chain(&mut self.instant_actions);
        for state in states.filter(|state| state.action_id == action_id) {
            state.action_status = status;
            state.result_description = result.clone();
        }
    }
}

fn waiting(action: &Action) -> ActionState {
    ActionState {
        action_id: action.action_id.clone(),
        action_type: action.action_type.clone(),
        action_description: action.action_description.clone(),
        action_status: ActionStatus::Waiting,
        result_description: None,
    }
}
