//! `ComputePathToPose`: a plan on the robot's newest map, made on a separate thread.

use super::active_goal::ActiveGoal;
use super::error_codes::of_no_path;
use super::goal_pose::{GoalPoseError, in_map};
use crate::Ros2Error;
use crate::convert::{path, stamp};
use crate::generated::geometry_msgs::PoseStamped;
use crate::generated::nav_msgs::PathMessage;
use crate::generated::nav2_msgs::{
    ComputePathToPose, ComputePathToPoseGoal as Goal, ComputePathToPoseResult as Outcome,
};
use crate::node::{ActionHandle, GoalEnd, GoalHandler, GoalId, RosNode, arrives, qos};
use crate::outputs::{OutputTopic, RunFrames};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Instant;
use trundle_app::operator::MapView;
use trundle_core::{Pose2, Stamp, Twist2};
use trundle_planning::{Plan, Planner};
use trundle_runtime::{NoPath, RobotConfig};

/// Plans that may wait for the thread. Source: ours.
const MAX_WAITING_PLANS: usize = 4;
/// Names of the planner: none, and Nav2's default.
const PLANNER_IDS: [&str; 2] = ["", "GridBased"];
/// Maximum number of poses in a result, if they fit into its reply. Source: ours.
const MAX_POSES: usize = 24;
/// Bytes of a reply in addition to the path. Source: its identity, status, time and code are 24 bytes.
const REPLY_OVERHEAD_BYTES: usize = 32;

/// A requested plan.
struct RequestedPlan {
    id: GoalId,
    start: Pose2,
    goal: Pose2,
    map: Arc<MapView>,
    at: Stamp,
}

/// Offers `compute_path_to_pose` for `robot`.
///
/// # Errors
/// When the robot's settings are not usable, the action cannot be created, or the system refuses a thread.
pub fn offer(
    node: &mut RosNode,
    active: &ActiveGoal,
    frames: &RunFrames,
    robot: &RobotConfig,
) -> Result<(), Ros2Error> {
    let unusable = |error| Ros2Error::create("the planner", error);
    let footprint = robot.footprint().map_err(unusable)?;
    let planner = Planner::new(robot.planning, &footprint, robot.limits, robot.drive).map_err(unusable)?;
    let (plans, wanted) = sync_channel(MAX_WAITING_PLANS);
    let (own, own_frames, clock) = (active.clone(), frames.clone(), active.clock());
    let whole_path = OutputTopic::new(node, "plan", &qos::reliable(1))?;
    let handle = ActionHandle::<ComputePathToPose>::offer(node, "compute_path_to_pose", clock, |handle| {
        Box::new(Handler { handle, active: own, frames: own_frames, plans })
    })?;
    let outputs = PlanOutputs { handle, whole_path, frame: frames.names.map.clone() };
    let thread = std::thread::Builder::new().name("ros2-planner".to_owned());
    thread.spawn(move || outputs.plan_all(planner, &wanted))?;
    Ok(())
}

struct Handler {
    handle: ActionHandle<ComputePathToPose>,
    active: ActiveGoal,
    frames: RunFrames,
    plans: SyncSender<RequestedPlan>,
}

impl Handler {
    /// The request, or the result of a goal that fails.
    fn wanted(&self, id: GoalId, goal: &Goal) -> Result<RequestedPlan, GoalFailure> {
        if !PLANNER_IDS.contains(&goal.planner_id.as_str()) {
            let message = format!("planner_id is '{}', expected none or GridBased", goal.planner_id);
            return Err(GoalFailure::Failed(Outcome::INVALID_PLANNER, message));
        }
        let missing =
            |what: &str| GoalFailure::Failed(Outcome::UNKNOWN, format!("the robot has no {what} yet"));
        let view = self.active.view().ok_or_else(|| missing("pose"))?;
        let map = view.map.clone().ok_or_else(|| missing("map"))?;
        let in_map = |pose: &PoseStamped| in_map(pose, &self.frames, Some(&*view));
        let start = if goal.use_start { in_map(&goal.start)? } else { view.estimate.pose };
        let at = self.active.clock().to_ros(view.stamp);
        Ok(RequestedPlan { id, start, goal: in_map(&goal.goal)?, map, at })
    }
}

/// Reason why no plan is made.
enum GoalFailure {
    Refused(String),
    Failed(u16, String),
}

impl From<GoalPoseError> for GoalFailure {
    fn from(error: GoalPoseError) -> Self {
        match error {
            GoalPoseError::Invalid(error) => Self::Refused(error.to_string()),
            GoalPoseError::Frame(message) => Self::Failed(Outcome::TF_ERROR, message),
        }
    }
}

impl GoalHandler<ComputePathToPose> for Handler {
    fn on_goal(&mut self, id: GoalId, goal: Goal) -> Result<(), String> {
        match self.wanted(id, &goal) {
            Ok(wanted) => {
                let full = |_| format!("{MAX_WAITING_PLANS} plans are waited for: ask again later");
                self.plans.try_send(wanted).map_err(full)
            }
            Err(GoalFailure::Refused(why)) => Err(why),
            Err(GoalFailure::Failed(error_code, error_msg)) => {
                let result = Outcome { error_code, error_msg, ..Outcome::default() };
                self.handle.end(&id, GoalEnd::Aborted, result);
                Ok(())
            }
        }
    }

    fn on_cancel(&mut self, _id: GoalId) {
        // A plan takes less than a second: it is finished.
    }
}

/// Receivers of plans.
struct PlanOutputs {
    handle: ActionHandle<ComputePathToPose>,
    /// The topic on which Nav2's planner publishes its paths. A result has no room for them.
    whole_path: OutputTopic<PathMessage>,
    /// Name of the map's frame.
    frame: String,
}

impl PlanOutputs {
    /// Makes the plans one after the other, until the node ends.
    fn plan_all(&self, mut planner: Planner, plans: &Receiver<RequestedPlan>) {
        for RequestedPlan { id, start, goal, map, at } in plans {
            let started = Instant::now();
            let plan = planner.plan(&map.grid, start, Twist2::ZERO, goal);
            let planning_time = stamp::duration(started.elapsed().as_secs_f64());
            let (end, result) = match &plan {
                Plan::Found(found) => {
                    let points = found.trajectory.points().iter();
                    let poses: Vec<Pose2> = points.map(|point| point.pose).collect();
                    self.whole_path.publish(path::to_ros(&poses, at, &self.frame));
                    let path = small_path(&poses, at, &self.frame);
                    (GoalEnd::Succeeded, Outcome { path, ..Outcome::default() })
                }
                refused => (GoalEnd::Aborted, refusal(refused)),
            };
            self.handle.end(&id, end, Outcome { planning_time, ..result });
        }
    }
}

/// The refusal of a plan.
fn refusal(plan: &Plan) -> Outcome {
    let cause = NoPath::of(plan);
    let error_code = cause.as_ref().map_or(Outcome::UNKNOWN, of_no_path);
    let error_msg = cause.map(|cause| cause.to_string()).unwrap_or_default();
    Outcome { error_code, error_msg, ..Outcome::default() }
}

/// As many poses of a path as fit into its reply.
fn small_path(poses: &[Pose2], at: Stamp, frame: &str) -> PathMessage {
    let of_count = |count| path::to_ros(&path::thinned(poses, count), at, frame);
    let fits = |path: &PathMessage| arrives(&(path, [0_u8; REPLY_OVERHEAD_BYTES]));
    (2..=MAX_POSES).rev().map(of_count).find(fits).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_is_thinned_to_what_a_reply_has_room_for() {
        let wave: Vec<Pose2> =
            (0..1000).map(|i| 0.01 * f64::from(i)).map(|x| Pose2::new(x, (3.0 * x).sin(), 0.0)).collect();
        let path = small_path(&wave, Stamp::default(), "map");
        assert!((10..=15).contains(&path.poses.len()), "{}", path.poses.len());
        let result = Outcome { path, ..Outcome::default() };
        assert!(arrives(&(result, [0_u8; 8])));
        let back = path::from_ros(&small_path(&wave[..2], Stamp::default(), "map")).unwrap();
        assert_eq!(back.len(), 2);
    }

    #[test]
    fn refusals_have_the_planners_codes() {
        let blocked = refusal(&Plan::Blocked { nearest: trundle_core::Vector2::new(1.0, 2.0) });
        assert_eq!(blocked.error_code, 208);
        assert!(blocked.error_msg.contains("(1.00, 2.00) m"));
        assert_eq!(refusal(&Plan::GoalInObstacle { clearance: -0.1 }).error_code, 206);
        assert_eq!(refusal(&Plan::StartOutside).error_code, 203);
    }
}
