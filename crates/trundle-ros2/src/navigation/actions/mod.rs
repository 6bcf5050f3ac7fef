//! Nav2's actions, one file each or a pair of the same kind.

mod docking;
mod follow_path;
mod navigate_through_poses;
mod navigate_to_pose;
mod relative;
mod waypoints;

use crate::convert::{pose, stamp};
use crate::generated::builtin_interfaces::Duration;
use crate::generated::geometry_msgs::PoseStamped;
use crate::navigation::NavigationRefusal;
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_runtime::{GoalOptions, Task, TaskGoal};

/// The robot's pose as feedback.
fn current_pose(view: &RunView, frames: &RunFrames) -> PoseStamped {
    pose::stamped(&view.estimate.pose, view.estimate.stamp, &frames.names.map)
}

/// Seconds as a duration; 0 if they are not known.
fn duration(seconds: f64) -> Duration {
    stamp::duration(if seconds.is_finite() { seconds } else { 0.0 })
}

/// Fails a goal that names a behavior tree; `failed` makes the result from the message.
fn refuse_behavior_tree<R>(tree: &str, failed: impl FnOnce(String) -> R) -> Result<(), NavigationRefusal<R>> {
    if tree.is_empty() {
        return Ok(());
    }
    let message = format!("behavior_tree is '{tree}', expected none: trundle has no behavior trees");
    Err(NavigationRefusal::Failed(failed(message)))
}

/// Tasks that lead through poses, within `tolerance` m of each, and end exactly at the last one.
fn passing(poses: &[Pose2], tolerance: f64) -> Vec<Task> {
    let Some((last, before)) = poses.split_last() else { return Vec::new() };
    let mut options = GoalOptions::default();
    (options.tolerance, options.pass_through) = (Some(tolerance), true);
    let through = before.iter().map(|pose| Task::Go(TaskGoal::new(*pose, options)));
    through.chain([Task::go(*last)]).collect()
}

/// Remaining distance along the plan \[m\] and time \[s\]; without a plan straight to `goal`.
fn left(view: &RunView, goal: &Pose2) -> (f32, Duration) {
    let pose = &view.estimate.pose;
    match &view.plan {
        Some(plan) => {
            let left = super::remaining::remaining(&plan.trajectory, pose);
            (left.distance_m as f32, duration(left.time_s))
        }
        None => (pose.distance(goal) as f32, Duration::default()),
    }
}
