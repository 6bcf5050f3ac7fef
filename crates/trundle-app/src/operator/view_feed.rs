//! Makes the views of a run.

use super::image_feed::ImageFeed;
use super::perception_feed::PerceptionFeed;
use super::run_view::{MapView, MissionView, PerceptionView, PlanView, RunCounts, RunState, RunView};
use super::visual_map_feed::VisualMapFeed;
use std::sync::Arc;
use trundle_core::{Scan, Stamp, Twist2};
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
    /// Width and height of the camera's images \[px\].
    pub(super) image_size_px: [usize; 2],
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
                self.perception.update(self.image_size_px, track, slam);
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
