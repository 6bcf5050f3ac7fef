//! Checkpoints of the robot, and starts from a checkpoint or a map.

use super::Robot;
use crate::{
    checkpoint::schedule::CheckpointSchedule,
    checkpoint::{Checkpoint, CheckpointError},
    config::RobotConfig,
};
use std::sync::Arc;
use trundle_core::{Invalid, OccupancyGrid};
use trundle_estimation::Localizer;
use trundle_vision::Vocabulary;

impl Robot {
    /// A robot resumed from a checkpoint, with its maps and an unknown pose. The robot turns on the spot until an image or its scans give a
    /// unique pose, and continues the mission. The map frame is that of the checkpoint.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range, or the checkpoint does not fit it: other cells, another camera.
    pub fn resume(config: RobotConfig, checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let mut robot = Self::new(config.clone())?;
        if let Some(perception) = &mut robot.perception {
            perception.load_maps(&config, &checkpoint.visual)?;
        }
        robot.mapping.resume(&checkpoint.grid)?;
        robot.localizer = Localizer::new(config.localization, robot.base_from_camera)?
            .resumed(checkpoint.visual_maps.clone());
        checkpoint.station.iter().for_each(|station| robot.station.restore(station));
        robot.annotate(checkpoint.annotations.clone());
        robot.steering.begin(checkpoint.mission.clone().after_restart());
        Ok(robot)
    }

    /// A robot on a given map, to which it matches its scans. Its start pose is the origin of the map frame.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range, or the map has other cells.
    pub fn on_map(config: RobotConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        let mut robot = Self::new(config.clone())?;
        robot.mapping.replace(grid)?;
        Ok(robot)
    }

    /// The same robot with this visual vocabulary instead of the built-in one; call it before the first event.
    #[must_use]
    pub fn with_vocabulary(mut self, vocabulary: &Arc<Vocabulary>) -> Self {
        if let Some(perception) = &mut self.perception {
            perception.set_vocabulary(vocabulary);
        }
        self
    }

    /// The robot with a checkpoint in its report every 3 to 10 s, less often for large maps: [`crate::StepReport::checkpoint`].
    #[must_use]
    pub fn with_checkpoints(mut self) -> Self {
        if let Some(perception) = &mut self.perception {
            perception.saving = Some(CheckpointSchedule::default());
        }
        self
    }

    /// A checkpoint of the present state; `None` while a perception job runs or the pose is unknown.
    pub fn checkpoint(&mut self) -> Option<Checkpoint> {
        let visual = self.perception.as_ref()?.slam().save();
        // Completes the redraw, so that the grid agrees with the visual map.
        self.mapping.mapper.work_within(usize::MAX, 1);
        let now = self.localizer.estimate().stamp;
        self.is_pose_known(now).then(|| self.checkpoint_with(visual))
    }

    pub(super) fn checkpoint_with(&mut self, visual: Vec<u8>) -> Checkpoint {
        let mut visual_maps = self.localizer.visual_maps();
        if let Some(slam) = self.slam() {
            let maps: Vec<u32> = slam.maps().iter().map(|map| map.number()).collect();
            visual_maps.retain(|map, _| maps.contains(map));
        }
        Checkpoint {
            visual,
            visual_maps,
            grid: self.mapping.grid().clone(),
            mission: self.steering.mission().clone(),
            station: self.station.estimate(),
            annotations: self.annotations().as_ref().clone(),
        }
    }
}
