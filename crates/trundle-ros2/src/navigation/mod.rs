//! Nav2's interface of goals: actions, goal and initial pose, services for its tools.

mod actions;
mod active_goal;
mod error_codes;
mod goal_outcome;
mod goal_pose;
mod lifecycle;
mod map_services;
mod navigation_action;
mod parameters;
mod path_planner;
mod pose_inputs;
mod remaining;
mod teleop_input;

pub use active_goal::{ActiveGoal, GoalProgress, RunningGoal, TimeLimit};
pub use goal_outcome::NavigationOutcome;
pub use navigation_action::{GoalContext, NavigationAction, NavigationRefusal};
pub use parameters::Parameters;

use crate::generated::nav2_msgs::{
    BackUp, DockRobot, DriveOnHeading, FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose,
    Spin, UndockRobot,
};
use crate::node::RosNode;
use crate::outputs::{PublishedMap, RunFrames};
use crate::{Ros2Error, Ros2Options};
use trundle_runtime::RobotConfig;

/// Offers all actions, topics and services by which Nav2's users and tools send goals.
///
/// # Errors
/// When a topic, service or action cannot be created.
pub fn offer(
    node: &mut RosNode,
    active: &ActiveGoal,
    options: &Ros2Options,
    frames: &RunFrames,
    published_map: &PublishedMap,
    robot: &RobotConfig,
) -> Result<(), Ros2Error> {
    navigation_action::offer::<NavigateToPose>(node, "navigate_to_pose", active, frames)?;
    navigation_action::offer::<NavigateThroughPoses>(node, "navigate_through_poses", active, frames)?;
    navigation_action::offer::<FollowWaypoints>(node, "follow_waypoints", active, frames)?;
    navigation_action::offer::<FollowPath>(node, "follow_path", active, frames)?;
    navigation_action::offer::<Spin>(node, "spin", active, frames)?;
    navigation_action::offer::<BackUp>(node, "backup", active, frames)?;
    navigation_action::offer::<DriveOnHeading>(node, "drive_on_heading", active, frames)?;
    navigation_action::offer::<DockRobot>(node, "dock_robot", active, frames)?;
    navigation_action::offer::<UndockRobot>(node, "undock_robot", active, frames)?;
    path_planner::offer(node, active, frames, robot)?;
    pose_inputs::offer(node, active, frames)?;
    teleop_input::offer(node, active, options.stamped_commands)?;
    map_services::offer(node, active, published_map, &frames.names, robot)?;
    lifecycle::offer(node, active)?;
    let followed = active.clone();
    node.every_tick(move |now| followed.tick(now));
    Ok(())
}
