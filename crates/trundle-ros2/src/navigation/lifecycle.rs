//! Services that tools of Nav2 call before they send goals: states of its servers, and their manager.

use super::active_goal::ActiveGoal;
use crate::Ros2Error;
use crate::generated::lifecycle_msgs::{GetState, GetStateResponse, State};
use crate::generated::nav2_msgs::{
    ManageLifecycleNodes, ManageLifecycleNodesRequest, ManageLifecycleNodesResponse,
};
use crate::generated::std_srvs::{Trigger, TriggerResponse};
use crate::node::RosNode;
use trundle_runtime::OperatorCommand;

/// Servers of Nav2 whose work trundle does.
const SERVERS: [&str; 10] = [
    "amcl",
    "slam_toolbox",
    "map_server",
    "bt_navigator",
    "planner_server",
    "controller_server",
    "behavior_server",
    "waypoint_follower",
    "docking_server",
    "velocity_smoother",
];
/// The managers of Nav2's launch files.
const MANAGERS: [&str; 2] = ["lifecycle_manager_navigation", "lifecycle_manager_localization"];

/// Offers `SERVER/get_state`, `MANAGER/manage_nodes` and `MANAGER/is_active`.
///
/// # Errors
/// When a service cannot be created.
pub fn offer(node: &mut RosNode, active: &ActiveGoal) -> Result<(), Ros2Error> {
    for server in SERVERS {
        let view = active.clone();
        node.serve::<GetState>(&format!("{server}/get_state"), move |_| GetStateResponse {
            current_state: state(&view),
        })?;
    }
    for manager in MANAGERS {
        let managed = active.clone();
        node.serve::<ManageLifecycleNodes>(&format!("{manager}/manage_nodes"), move |request| {
            ManageLifecycleNodesResponse { success: manage(&managed, request.command) }
        })?;
        let view = active.clone();
        node.serve::<Trigger>(&format!("{manager}/is_active"), move |_| {
            let state = state(&view);
            TriggerResponse { success: state.id == State::PRIMARY_STATE_ACTIVE, message: state.label }
        })?;
    }
    Ok(())
}

/// Active from the robot's first step on.
fn state(active: &ActiveGoal) -> State {
    let (id, label) = match active.view() {
        Some(_) => (State::PRIMARY_STATE_ACTIVE, "active"),
        None => (State::PRIMARY_STATE_INACTIVE, "inactive"),
    };
    State { id, label: label.to_owned() }
}

/// Carries out a command of the manager. Returns whether it succeeded.
fn manage(active: &ActiveGoal, command: u8) -> bool {
    let command = match command {
        ManageLifecycleNodesRequest::STARTUP | ManageLifecycleNodesRequest::CONFIGURE => return true,
        ManageLifecycleNodesRequest::PAUSE => OperatorCommand::Pause,
        ManageLifecycleNodesRequest::RESUME => OperatorCommand::Continue,
        // The process continues: it stops the robot and waits for goals.
        ManageLifecycleNodesRequest::RESET
        | ManageLifecycleNodesRequest::SHUTDOWN
        | ManageLifecycleNodesRequest::CLEANUP => OperatorCommand::cancel(),
        _ => return false,
    };
    active.send(command).is_ok()
}
