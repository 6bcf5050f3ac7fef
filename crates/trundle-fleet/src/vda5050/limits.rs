//! Sizes and periods of the protocol.

use std::time::Duration;

/// Largest message that is read \[bytes\]: an order of 500 nodes is 200 kB. Source: ours.
pub const MAX_MESSAGE_BYTES: usize = 256 * 1024;
/// Longest name of an order, node, edge, action or map \[bytes\]. Source: ours.
pub const MAX_ID_BYTES: usize = 256;
/// Largest number of nodes of an order. Source: ours.
pub const MAX_NODES: usize = 500;
/// Largest number of actions of a node. Source: ours.
pub const MAX_ACTIONS_OF_NODE: usize = 16;
/// Largest number of actions of a message of instant actions. Source: ours.
pub const MAX_INSTANT_ACTIONS: usize = 16;
/// Shortest time between two states. Source: ours.
pub const MIN_STATE_PERIOD: Duration = Duration::from_millis(100);
/// Longest time between two states. Source: VDA 5050 2.1, section 6.10: 30 s.
pub const STATE_PERIOD: Duration = Duration::from_secs(30);
/// Time between two states while the robot moves. Source: ours.
pub const MOVING_STATE_PERIOD: Duration = Duration::from_secs(1);
/// Time between two messages of the position. Source: ours.
pub const VISUALIZATION_PERIOD: Duration = Duration::from_millis(500);
