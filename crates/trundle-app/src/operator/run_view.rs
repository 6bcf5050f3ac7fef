//! View of a run for its front ends.

use std::sync::Arc;

use trundle_core::{
    Battery, OccupancyGrid, Odometry, Pose2, PoseEstimate, Scan, Stamp, Trajectory, Twist2, Vector3,
};
use trundle_planning::MovingObstacle;
use trundle_runtime::{DriveState, MotionHold, RunSetting, Task, TaskRecord};

/// State of a run after a step. Large parts are shared with earlier views in which they are the same.
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
    /// State of the robot; of the whole mission when it is over.
    pub state: DriveState,
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
    pub plan: Option<Arc<Trajectory>>,
    /// The map, at most one second old.
    pub map: Option<Arc<MapView>>,
    /// Surroundings of the robot besides the map.
    pub perception: PerceptionView,
    /// How often stages ran so far.
    pub counts: RunCounts,
    /// Present values of the settings that may change while the robot runs.
    pub settings: [RunSetting; 2],
}

/// Surroundings of a robot besides the map.
#[derive(Debug, Clone, Default)]
pub struct PerceptionView {
    /// The newest colour image.
    pub image: Option<Arc<ImageView>>,
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
    /// Whether it is a landmark that agrees with the pose.
    pub is_tracked: bool,
}

/// A loop closure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedLoop {
    /// Of the image by which it was closed.
    pub stamp: Stamp,
    /// `map_from_base` after it.
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

/// How often parts of the robot ran since its start. The difference of two views gives a rate.
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

/// A mission as a run shows it.
#[derive(Debug, Clone, Default)]
pub struct MissionView {
    /// The request that began it; 0 for the mission of the setup.
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
