//! Views of the robot's state, for reports and front ends.

use super::Robot;
use crate::{
    goal_approach::GoalApproachReport,
    mission::{Task, TaskRecord},
    operator::RunSettings,
    stage::StageTimes,
};
use std::sync::Arc;
use trundle_control::MotionHold;
use trundle_core::{
    Battery, MapAnnotations, OccupancyGrid, Odometry, Pose2, Pose3, PoseEstimate, Scan, Stamp,
};
use trundle_estimation::StationEstimate;
use trundle_planning::{MovingObstacle, PlanResult};
use trundle_slam::RgbdSlam;

/// Progress of a mission.
#[derive(Debug, Clone, Copy)]
pub struct MissionProgress<'r> {
    /// The present task.
    pub task: Option<Task>,
    /// The tasks that have ended.
    pub ended: &'r [TaskRecord],
}

impl Robot {
    /// The pose estimate.
    pub fn estimate(&self) -> PoseEstimate {
        self.localizer.estimate()
    }

    /// The map.
    pub fn grid(&self) -> &OccupancyGrid {
        self.mapping.grid()
    }

    /// The visual tracker with its landmark map; `None` while a perception job runs.
    pub fn slam(&self) -> Option<&RgbdSlam> {
        self.perception.as_ref().map(|perception| perception.slam())
    }

    /// The visual tracker's frame in the map.
    pub fn map_from_visual(&self) -> Option<Pose3> {
        self.localizer.map_from_visual()
    }

    /// The tasks of the mission that have ended; empty while a decision job runs.
    pub fn tasks_ended(&self) -> &[TaskRecord] {
        self.mission_progress().map_or(&[], |progress| progress.ended)
    }

    /// Progress of the mission; `None` while a decision job runs.
    pub fn mission_progress(&self) -> Option<MissionProgress<'_>> {
        let executor = &self.steering.decision_worker.as_ref()?.executor;
        Some(MissionProgress { task: executor.task(), ended: executor.records() })
    }

    /// The tasks of the mission that have not ended, the present one first; `None` while a decision job runs.
    pub fn tasks_left(&self) -> Option<Vec<Task>> {
        Some(self.steering.decision_worker.as_ref()?.executor.tasks_left().collect())
    }

    /// Report of turns and straight moves for the present goal, or for the last goal with such a request; `None` while a decision job runs.
    pub fn docking(&self) -> Option<&GoalApproachReport> {
        Some(self.steering.decision_worker.as_ref()?.navigator.docking())
    }

    /// The present task; `None` while a decision job runs.
    pub fn task(&self) -> Option<Task> {
        self.mission_progress()?.task
    }

    /// The newest plan; `None` while a decision job runs.
    pub fn plan(&self) -> Option<&PlanResult> {
        self.steering.decision_worker.as_ref()?.navigator.plan()
    }

    /// The newest scan.
    pub fn scan(&self) -> Option<&Scan> {
        self.latest.scan.as_ref()
    }

    /// `map_from_base` at the newest scan, by the newest estimate; `None` without odometry since the scan.
    pub fn scan_pose(&self) -> Option<Pose2> {
        let carried = self.latest.scan_with_odometry()?;
        Some(self.localizer.estimate().pose * carried.odom_now.inverse() * carried.odom_at_scan)
    }

    /// `map_from_camera` at a stamp of the last seconds, by the newest estimate. `None` while the pose is unknown, and without odometry at
    /// the stamp.
    pub fn map_from_camera_at(&self, stamp: Stamp) -> Option<Pose3> {
        let newest = self.latest.odometry.filter(|odometry| self.is_pose_known(odometry.stamp))?;
        let odom_from_base = self.localizer.odometry_at(stamp).ok()?.pose;
        let base = self.localizer.estimate().pose * newest.pose.inverse() * odom_from_base;
        Some(Pose3::from_pose2(base) * self.base_from_camera)
    }

    /// Number of images skipped because the camera was frozen.
    pub fn frozen_images(&self) -> usize {
        self.latest.frozen
    }

    /// The battery; `None` before the body's first report.
    pub fn battery(&self) -> Option<Battery> {
        self.latest.body.battery()
    }

    /// Moving obstacles nearby, predicted to the newest decision.
    pub fn moving_obstacles(&self) -> &[MovingObstacle] {
        &self.obstacles.movers
    }

    /// The charging station; `None` before the first light.
    pub fn station(&self) -> Option<StationEstimate> {
        self.station.estimate()
    }

    /// Present values of the settings that may change while the robot runs.
    pub fn run_settings(&self) -> RunSettings {
        self.settings
    }

    /// Zones and named places of the map.
    pub fn annotations(&self) -> &Arc<MapAnnotations> {
        self.zones.annotations()
    }

    /// Cost of the stages.
    pub fn times(&self) -> &StageTimes {
        &self.times
    }

    /// The newest odometry; `None` before the first reading.
    pub fn odometry(&self) -> Option<Odometry> {
        self.latest.odometry
    }

    /// The condition under which no wheel may turn; `None` if the robot may drive.
    pub fn hold(&self) -> Option<MotionHold> {
        self.latest.body.hold(self.range_sensor.source)
    }
}
