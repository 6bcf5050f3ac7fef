//! Makes the views of a run.

use super::request::OperatorRequest;
use super::run_view::{MapView, MissionView, RunView};
use std::sync::Arc;
use trundle_core::{Scan, Stamp, Trajectory, Twist2};
use trundle_runtime::{OperatorCommand, Robot, Stage, StepReport};

/// Time between two copies of the map \[s\]. A map of 100 x 100 m is 4 million cells, a copy of 1 ms. Source: ours.
const MAP_PERIOD_S: f64 = 1.0;

/// Makes the views of a run: keeps the large parts that did not change.
#[derive(Debug, Default)]
pub(super) struct ViewFeed {
    twist: Twist2,
    mission: MissionView,
    scan: Option<Arc<Scan>>,
    plan: Option<Arc<Trajectory>>,
    map: Option<Arc<MapView>>,
    map_copied: Option<Stamp>,
}

impl ViewFeed {
    /// Notes which request began the present mission.
    pub(super) fn note_request(&mut self, request: &OperatorRequest) {
        if matches!(request.command, OperatorCommand::Begin(_)) {
            self.mission = MissionView { id: request.id, ..MissionView::default() };
            self.plan = None;
        }
    }

    /// The view after a step; `None` after a step without command or result.
    pub(super) fn view(&mut self, stamp: Stamp, robot: &Robot, report: &StepReport) -> Option<RunView> {
        let is_shown = report.twist.is_some() || report.track.is_some() || report.finished;
        if !is_shown {
            return None;
        }
        self.twist = report.twist.unwrap_or(self.twist);
        self.update_mission(robot, report);
        self.update_plan(robot, report);
        self.update_scan(robot);
        self.update_map(stamp, robot);
        Some(RunView {
            stamp,
            estimate: robot.estimate(),
            odometry: robot.odometry(),
            twist: self.twist,
            state: report.state.clone(),
            mission: self.mission.clone(),
            battery: robot.battery(),
            hold: robot.hold(),
            scan: self.scan.clone(),
            plan: self.plan.clone(),
            map: self.map.clone(),
        })
    }

    /// While a decision job runs, the mission stays as it was.
    fn update_mission(&mut self, robot: &Robot, report: &StepReport) {
        self.mission.is_over = report.finished;
        let Some(progress) = robot.mission_progress() else { return };
        self.mission.task = progress.task;
        if progress.ended.len() != self.mission.ended.len() {
            self.mission.ended = Arc::new(progress.ended.to_vec());
        }
    }

    fn update_plan(&mut self, robot: &Robot, report: &StepReport) {
        if report.replanned {
            self.plan = robot.plan().map(|plan| Arc::new(plan.trajectory.clone()));
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
            self.map = Some(Arc::new(MapView { revision, grid: robot.grid().clone() }));
            self.map_copied = Some(now);
        }
    }
}
