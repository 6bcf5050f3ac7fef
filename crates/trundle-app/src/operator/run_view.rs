//! View of a run for its front ends.

use super::{DepthView, DepthViewpoint};
use nalgebra::Matrix3;
use std::fmt;
use std::sync::Arc;

use trundle_core::{
    Battery, OccupancyGrid, Odometry, Pose2, PoseEstimate, Scan, Stamp, Trajectory, Twist2, Vector2, Vector3,
};
use trundle_planning::MovingObstacle;
use trundle_runtime::{DriveState, MotionHold, RunSettings, Task, TaskRecord, TransitionReason};

/// State of a run after a step. Large parts are shared with earlier views that have equal parts.
#[derive(Debug, Clone)]
pub struct RunView {
    /// Time of the step.
    pub stamp: Stamp,
    /// `map_from_base`.
    pub estimate: PoseEstimate,
    /// `odom_from_base`; `None` before the first reading.
    pub odometry: Option<Odometry>,
    /// The last command.
    pub twist: Twist2,
    /// State of the run; after the end of the mission, the result of the whole mission.
    pub state: RunState,
    /// The mission.
    pub mission: MissionView,
    /// The battery; `None` if the body has not reported it.
    pub battery: Option<Battery>,
    /// The condition under which no wheel may turn.
    pub hold: Option<MotionHold>,
    /// The newest scan, base frame at its stamp.
    pub scan: Option<Arc<Scan>>,
    /// `map_from_base` at that scan, by the present estimate.
    pub scan_pose: Option<Pose2>,
    /// The newest plan, map frame.
    pub plan: Option<Arc<PlanView>>,
    /// The map, at most one second old.
    pub map: Option<Arc<MapView>>,
    /// Surroundings of the robot besides the map.
    pub perception: PerceptionView,
    /// Number of runs of each stage.
    pub counts: RunCounts,
    /// Present values of the settings that may change while the robot runs; `None` without a robot with settings.
    pub settings: Option<RunSettings>,
}

/// State of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum RunState {
    /// A robot decides: its state, and the reason for the last change of the state.
    Robot(DriveState, Option<TransitionReason>),
    /// No robot decides: a drive by hand, a tracked sequence.
    Activity(Activity),
}

/// Activity of a run without a robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Activity {
    /// Name of the activity in one or two words.
    pub name: &'static str,
    /// Details of the activity, in one sentence.
    pub reason: Option<String>,
}

impl RunView {
    /// A view of a moment without mission and without robot: `map_from_base`, the base's twist and the activity; all else is empty.
    #[must_use]
    pub fn of_activity(stamp: Stamp, pose: Pose2, twist: Twist2, activity: Activity) -> Self {
        let estimate = PoseEstimate { stamp, pose, twist, covariance: Default::default() };
        Self {
            stamp,
            estimate,
            odometry: None,
            twist: Twist2::ZERO,
            state: RunState::Activity(activity),
            mission: MissionView::default(),
            battery: None,
            hold: None,
            scan: None,
            scan_pose: None,
            plan: None,
            map: None,
            perception: PerceptionView::default(),
            counts: RunCounts::default(),
            settings: None,
        }
    }

    /// Covariance of the estimate in the map frame: x \[m\], y \[m\], heading \[rad\].
    #[must_use]
    pub fn map_covariance(&self) -> [[f64; 3]; 3] {
        let (sin, cos) = self.estimate.pose.theta.sin_cos();
        let turn = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        let turned = turn * self.estimate.covariance * turn.transpose();
        std::array::from_fn(|row| std::array::from_fn(|column| turned[(row, column)]))
    }
}

impl fmt::Display for RunState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot(state, _) => state.fmt(f),
            Self::Activity(activity) => f.write_str(activity.name),
        }
    }
}

impl RunState {
    /// The name in one or two words.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Robot(state, _) => state.name(),
            Self::Activity(activity) => activity.name,
        }
    }

    /// The reason why the robot does not move, or details of the activity, in one sentence.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Robot(state, _) => state.reason().map(ToString::to_string),
            Self::Activity(activity) => activity.reason.clone(),
        }
    }

    /// Reason for the last change of a robot's state; `None` before the first change and after the end of the mission.
    #[must_use]
    pub fn transition(&self) -> Option<TransitionReason> {
        match self {
            Self::Robot(_, transition) => *transition,
            Self::Activity(_) => None,
        }
    }

    /// The state of a robot that decides.
    #[must_use]
    pub fn drive(&self) -> Option<&DriveState> {
        match self {
            Self::Robot(state, _) => Some(state),
            Self::Activity(_) => None,
        }
    }
}

/// Surroundings of a robot besides the map.
#[derive(Debug, Clone, Default)]
pub struct PerceptionView {
    /// The newest colour image.
    pub image: Option<Arc<ImageView>>,
    /// Depth of the image; `None` if unavailable.
    pub depth: Option<Arc<DepthView>>,
    /// Camera and pose of that depth; `None` if the camera is unknown.
    pub depth_viewpoint: Option<DepthViewpoint>,
    /// The visual map, at most [`super::VISUAL_MAP_PERIOD_S`] old.
    pub visual_map: Option<Arc<VisualMapView>>,
    /// Features of the last image that was tracked.
    pub features: Option<Arc<FeatureView>>,
    /// The last loops that were closed.
    pub loops: Vec<ClosedLoop>,
    /// Dynamic obstacles near by.
    pub movers: Vec<MovingObstacle>,
    /// `map_from_station` of the charging station; `None` before its light was seen.
    pub station: Option<Pose2>,
}

/// Features of an image.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FeatureView {
    /// Width and height of the image \[px\].
    pub size_px: [usize; 2],
    /// The features.
    pub features: Vec<FeatureSpot>,
}

/// A feature of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureSpot {
    /// Column and row \[px\].
    pub at_px: [f64; 2],
    /// Whether the feature is a landmark that agrees with the pose.
    pub is_tracked: bool,
}

/// A loop closure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedLoop {
    /// Stamp of the image that closed the loop.
    pub stamp: Stamp,
    /// `map_from_base` after the closure.
    pub pose: Pose2,
}

/// The visual map in the map frame.
#[derive(Debug, Clone, Default)]
pub struct VisualMapView {
    /// Poses of the keyframes' cameras on the floor; the heading is that of the optical axis.
    pub keyframes: Vec<Pose2>,
    /// Positions of landmarks \[m\]; of a large map a part.
    pub landmarks: Vec<Vector3>,
}

/// Number of runs of the robot's parts since its start. The difference of two views gives a rate.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RunCounts {
    /// Camera poses by SLAM.
    pub slam: u64,
    /// Scans drawn into the map.
    pub mapping: u64,
    /// Control steps.
    pub control: u64,
    /// Images that a newer one replaced before they were processed.
    pub dropped_images: u64,
    /// The stages that ran, each with its time so far by the clock \[s\].
    pub stages: Vec<(&'static str, f64)>,
}

/// A colour image of the camera.
#[derive(Debug, Clone)]
pub struct ImageView {
    /// Time of the image.
    pub stamp: Stamp,
    /// The bytes of a JPEG.
    pub jpeg: Vec<u8>,
}

/// A plan, map frame.
#[derive(Debug, Clone)]
pub struct PlanView {
    /// The way-points of the search, start and goal included.
    pub waypoints: Vec<Vector2>,
    /// The curve through them with its times.
    pub trajectory: Trajectory,
}

/// A mission as displayed.
#[derive(Debug, Clone, Default)]
pub struct MissionView {
    /// Number of the request that started the mission; 0 for the mission of the setup.
    pub id: u64,
    /// The present task.
    pub task: Option<Task>,
    /// The tasks that have not ended, the present one first.
    pub left: Arc<Vec<Task>>,
    /// The tasks that have ended.
    pub ended: Arc<Vec<TaskRecord>>,
    /// Whether all tasks have ended. An empty mission is not over.
    pub is_over: bool,
}

/// The map of a run.
#[derive(Debug, Clone)]
pub struct MapView {
    /// Number of maps that an operator has replaced until then.
    pub number: u64,
    /// Number of scans that were drawn into it so far: maps of equal numbers are equal, if no loop was closed.
    pub revision: u64,
    /// The map.
    pub grid: OccupancyGrid,
}
