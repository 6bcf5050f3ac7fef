//! Makes the views of a run.

use super::DepthViewpoint;
use super::image_feed::ImageFeed;
use super::perception_feed::PerceptionFeed;
use super::run_view::{MapView, MissionView, PerceptionView, PlanView, RunCounts, RunState, RunView};
use super::visual_map_feed::VisualMapFeed;
use std::sync::Arc;
use trundle_core::{PinholeCamera, Scan, Stamp, Twist2};
use trundle_planning::PlanResult;
use trundle_runtime::{Robot, Stage, StepReport};

/// Time between two copies of the map \[s\]. A map of 100 x 100 m is 4 million cells, a copy of 1 ms. Source: ours.
const MAP_PERIOD_S: f64 = 1.0;

/// Makes the views of a run: keeps the large parts that did not change.
#[derive(Debug, Default)]
pub(super) struct ViewFeed {
    twist: Twist2,
    mission: MissionView,
    scan: Option<Arc<Scan>>,
    plan: Option<Arc<PlanView>>,
    map: Option<Arc<MapView>>,
    map_copied: Option<Stamp>,
    /// Number of replaced maps.
    map_number: u64,
    /// Images of the camera.
    pub(super) images: ImageFeed,
    visual_map: VisualMapFeed,
    perception: PerceptionFeed,
    /// The camera; `None` without images.
    pub(super) camera: Option<PinholeCamera>,
}

impl ViewFeed {
    /// Notes the number of the request that began the present mission.
    pub(super) fn note_mission(&mut self, id: u64) {
        self.mission = MissionView { id, ..MissionView::default() };
        self.plan = None;
    }

    /// Marks that another map replaced the present one: the next view contains the new map.
    pub(super) fn note_map_replaced(&mut self) {
        self.map_number += 1;
        self.map = None;
        self.map_copied = None;
    }

    /// The view after a step; `None` after a step without command or result. Scan and map are copied if the run `is_watched`.
    pub(super) fn view(
        &mut self,
        stamp: Stamp,
        robot: &Robot,
        report: &StepReport,
        is_watched: bool,
    ) -> Option<RunView> {
        let is_result = report.track.is_some() || report.replanned || report.finished || report.map_replaced;
        let is_shown = report.twist.is_some() || is_result;
        if !is_shown {
            return None;
        }
        self.twist = report.twist.unwrap_or(self.twist);
        self.update_mission(robot, report);
        self.update_plan(robot, report);
        if let Some(track) = &report.track {
            self.perception.note_loop(track, robot.estimate().pose);
        }
        if is_watched || report.map_replaced {
            self.update_map(stamp, robot);
        }
        if is_watched {
            if let (Some(track), Some(slam)) = (&report.track, robot.slam()) {
                let size_px = self.camera.map_or([0; 2], |camera| [camera.width(), camera.height()]);
                self.perception.update(size_px, track, slam);
            }
            self.update_scan(robot);
            self.visual_map.update(stamp, robot.slam(), robot.map_from_visual());
        }
        Some(RunView {
            stamp,
            estimate: robot.estimate(),
            odometry: robot.odometry(),
            twist: self.twist,
            state: RunState::Robot(report.state.clone(), report.transition),
            mission: self.mission.clone(),
            battery: robot.battery(),
            hold: robot.hold(),
            scan: self.scan.clone(),
            scan_pose: robot.scan_pose(),
            plan: self.plan.clone(),
            map: self.map.clone(),
            perception: PerceptionView {
                movers: robot.moving_obstacles().to_vec(),
                station: robot.station().map(|station| station.pose),
                depth_viewpoint: is_watched.then(|| self.depth_viewpoint(robot)).flatten(),
                ..self.perception.view(&self.images, &self.visual_map)
            },
            counts: counts(robot),
            settings: Some(robot.run_settings()),
        })
    }

    /// While a decision job runs, the mission of the view does not change.
    fn update_mission(&mut self, robot: &Robot, report: &StepReport) {
        self.mission.is_over = report.finished;
        let Some(progress) = robot.mission_progress() else { return };
        let is_new = progress.task != self.mission.task || progress.ended.len() != self.mission.ended.len();
        if is_new || self.mission.left.is_empty() {
            self.mission.left = Arc::new(robot.tasks_left().unwrap_or_default());
        }
        self.mission.task = progress.task;
        if progress.ended.len() != self.mission.ended.len() {
            self.mission.ended = Arc::new(progress.ended.to_vec());
        }
    }

    fn update_plan(&mut self, robot: &Robot, report: &StepReport) {
        if report.replanned {
            let view = |plan: &PlanResult| PlanView {
                waypoints: plan.waypoints.points().to_vec(),
                trajectory: plan.trajectory.clone(),
            };
            self.plan = robot.plan().map(|plan| Arc::new(view(plan)));
        }
    }

    /// Viewpoint of the newest depth image, by the newest estimate.
    fn depth_viewpoint(&self, robot: &Robot) -> Option<DepthViewpoint> {
        let (camera, depth) = (self.camera?, self.images.depth()?);
        Some(DepthViewpoint { camera, map_from_camera: robot.map_from_camera_at(depth.stamp) })
    }

    fn update_scan(&mut self, robot: &Robot) {
        let stamp = |scan: &Scan| scan.stamp();
        if robot.scan().map(stamp) != self.scan.as_deref().map(stamp) {
            self.scan = robot.scan().map(|scan| Arc::new(scan.clone()));
        }
    }

    fn update_map(&mut self, now: Stamp, robot: &Robot) {
        let is_due = self.map_copied.is_none_or(|copied| now - copied >= MAP_PERIOD_S);
        let revision = robot.times().runs(Stage::Mapping);
        if is_due && self.map.as_ref().is_none_or(|map| map.revision != revision) {
            self.map =
                Some(Arc::new(MapView { number: self.map_number, revision, grid: robot.grid().clone() }));
            self.map_copied = Some(now);
        }
    }
}

fn counts(robot: &Robot) -> RunCounts {
    let runs = |stage| robot.times().runs(stage);
    RunCounts {
        slam: runs(Stage::Slam),
        mapping: runs(Stage::Mapping),
        control: runs(Stage::Control),
        dropped_images: robot.dropped_images().len() as u64,
        stages: Stage::ALL.iter().map(|stage| (stage.name(), robot.times().total(*stage))).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DepthImage, Pose3, SensorEvent, WheelTicks};
    use trundle_runtime::{OperatorCommand, PoseGuess, RobotConfig};

    #[test]
    fn a_depth_image_has_the_pose_at_its_stamp_unless_the_pose_is_unknown() {
        let config = RobotConfig::default();
        let (camera, base_from_camera) = (config.camera, config.mount.base_from_camera());
        let mut robot = Robot::new(config).unwrap();
        let mut feed = ViewFeed { camera: Some(camera), ..ViewFeed::default() };
        let stamp = |step: u16| Stamp::from_nanos(20_000_000 * i64::from(step));
        let drive = |step: u16| {
            let ticks = WheelTicks { stamp: stamp(step), left: 30 * step, right: 60 * step };
            robot.step(&SensorEvent::Wheels(ticks));
            robot.estimate().pose
        };
        let poses: Vec<_> = (0..20).map(drive).collect();
        assert_eq!(feed.depth_viewpoint(&robot), None, "no depth image");
        feed.images.note_depth(stamp(15), &DepthImage::filled(camera.width(), camera.height(), 1.0));
        let found = feed.depth_viewpoint(&robot).unwrap().map_from_camera.unwrap();
        let off = |step: usize| (Pose3::from_pose2(poses[step]) * base_from_camera).inverse() * found;
        assert!(off(15).log().norm() < 1e-6 && off(19).log().norm() > 0.01, "{found:?}");
        let guess = PoseGuess { pose: poses[19], position_sigma: 9.0, heading_sigma: 0.2 };
        robot.execute(OperatorCommand::SetPose(guess)).unwrap();
        assert_eq!(feed.depth_viewpoint(&robot).unwrap().map_from_camera, None);
    }
}
