//! A ROS 2 node on its own thread: topics, services, actions, names, conditions.

mod action_endpoint;
mod diagnostics;
mod endpoints;
mod event_loop;
mod goals;
mod middleware_death;
mod names;
mod network;
mod params_file;
pub mod qos;
mod readers;
mod reply;
mod ros_arguments;
mod ros_node;
mod topic_monitor;

pub use action_endpoint::{ActionHandle, GoalHandler};
pub use diagnostics::{Condition, Diagnostics, Level};
pub use event_loop::NodeThread;
pub use goals::{GoalEnd, GoalId, Goals, MAX_GOALS_PER_SECOND, ResultAnswer};
pub use names::Names;
pub(crate) use network::DISCOVERY;
pub use network::Networks;
pub use readers::Readers;
pub use reply::{MAX_REPLY_BYTES, arrives};
pub use ros_arguments::RosArguments;
pub use ros_node::{NodeSettings, RosNode};
pub use topic_monitor::TopicMonitor;
