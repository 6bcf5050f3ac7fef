//! Commands of an operator.

use super::{Robot, event_log};
use crate::{
    global_localization::LocalizedPose,
    mission::MissionState,
    operator::{OperatorCommand, PoseGuess, RunSetting},
    report::StepReport,
    stage::Stage,
};
use std::sync::Arc;
use trundle_core::{Invalid, MapAnnotations, OccupancyGrid, Stamp, Vector3};
use trundle_estimation::PoseMonitor;

impl Robot {
    /// Executes an operator's command between two events.
    ///
    /// # Errors
    /// Names the number of the command that is not finite or outside its range. The command is then ignored.
    pub fn execute(&mut self, command: OperatorCommand) -> Result<StepReport, Invalid> {
        let now = self.localizer.estimate().stamp;
        let mut report = StepReport::default();
        match command.validated()? {
            OperatorCommand::Begin(mission) => {
                self.steering.begin_for_operator(MissionState::new(mission));
                report.mission_replaced = true;
            }
            OperatorCommand::Pause => self.pause(true, now, &mut report),
            OperatorCommand::Continue => self.pause(false, now, &mut report),
            OperatorCommand::SetPose(guess) => self.take_pose(&guess, now),
            OperatorCommand::Change(setting) => self.change(setting, now),
            OperatorCommand::Annotate(annotations) => {
                event_log::annotated(now, &annotations);
                self.annotate(annotations);
            }
            OperatorCommand::LoadMap(grid) => self.replace_map(&grid, now, &mut report),
            OperatorCommand::Drive(twist) => {
                self.pause(true, now, &mut report);
                self.steering.teleop.drive(twist, now);
            }
            OperatorCommand::GoalLinkLost => self.lose_goal_link(now, &mut report),
        }
        self.complete(&mut report);
        Ok(report)
    }

    /// Replaces the zones and named places of the map.
    pub fn annotate(&mut self, annotations: MapAnnotations) {
        self.zones.set(annotations);
    }

    /// Replaces the map: the mission ends and the robot brakes to rest. An unusable map is refused, and the robot continues with its own.
    fn replace_map(&mut self, grid: &OccupancyGrid, now: Stamp, report: &mut StepReport) {
        let replaced = self.times.measure(Stage::Mapping, || self.mapping.replace(grid));
        event_log::map_given(now, grid.geometry(), replaced.as_ref().err());
        if replaced.is_err() {
            return;
        }
        (report.map_replaced, report.mission_replaced) = (true, true);
        self.steering.begin_for_operator(MissionState::default());
        self.localizer.forget_visual_maps();
        self.station.forget();
        self.annotate(MapAnnotations::default());
        self.latest.pose_monitor = PoseMonitor::default();
        self.lose_pose();
        if self.perception.is_some() {
            self.on_map_replaced(report);
        } else {
            self.mapping.voids_search = true;
        }
        self.decide(now, report);
    }

    /// Ends the search in the replaced map and reports a new checkpoint, since the last one contains the replaced map. No perception job of
    /// that map may run. The pose is unknown, as after a resume.
    pub(super) fn on_map_replaced(&mut self, report: &mut StepReport) {
        let Some(perception) = &mut self.perception else { return };
        perception.global_localization.end();
        if perception.saving.is_some() {
            let visual = perception.slam().save();
            report.checkpoint = Some(Arc::new(self.checkpoint_with(visual)));
        }
    }

    fn change(&mut self, setting: RunSetting, now: Stamp) {
        event_log::setting_changed(now, setting);
        let is_same = |known: &&mut RunSetting| known.key() == setting.key();
        self.settings.iter_mut().find(is_same).into_iter().for_each(|known| *known = setting);
        self.steering.change(setting);
    }

    fn pause(&mut self, is_paused: bool, now: Stamp, report: &mut StepReport) {
        self.steering.teleop.release();
        let before = self.latest.body.hold(self.range_sensor.source);
        self.latest.body.set_paused(is_paused);
        self.on_hold(before, now, report);
    }

    fn lose_goal_link(&mut self, now: Stamp, report: &mut StepReport) {
        let before = self.latest.body.hold(self.range_sensor.source);
        self.latest.body.lose_goal_link();
        self.on_hold(before, now, report);
    }

    /// Replaces the estimate by the operator's pose. Without odometry the pose is ignored.
    fn take_pose(&mut self, guess: &PoseGuess, now: Stamp) {
        let variances =
            Vector3::new(guess.position_sigma, guess.position_sigma, guess.heading_sigma).map(|s| s * s);
        event_log::pose_given(now, guess);
        self.latest.pose_monitor = PoseMonitor::default();
        self.lose_pose();
        self.apply_global_localization(Some(LocalizedPose {
            stamp: now,
            map_from_base: guess.pose,
            covariance: nalgebra::Matrix3::from_diagonal(&variances),
        }));
    }
}
