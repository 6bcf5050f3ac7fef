//! What is kept through a restart, and waking up with it.

use super::Robot;
use crate::{
    checkpoint::schedule::CheckpointSchedule,
    checkpoint::{Checkpoint, CheckpointError},
    config::RobotConfig,
};
use trundle_core::{Invalid, OccupancyGrid};
use trundle_localization::Localizer;
use trundle_mapping::{LiveMapper, MapperConfig};

impl Robot {
    /// A robot that wakes up with what another one remembered: it knows the rooms, not where in them it stands, and turns on the
    /// spot until it recognises a place or its scans fit one alone. Then it goes on with what was left of the mission. The map frame is that
    /// of the memory.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range, or the memory does not fit it: other cells, another camera.
    pub fn resume(config: RobotConfig, memory: &Checkpoint) -> Result<Self, CheckpointError> {
        let mut robot = Self::new(config.clone())?;
        if let Some(perception) = &mut robot.perception {
            perception.recall(&config, &memory.visual)?;
        }
        robot.know(&config, &memory.grid)?;
        robot.localizer =
            Localizer::new(config.localization, robot.base_from_camera)?.resumed(memory.visual_maps.clone());
        robot.restore_mission(memory.mission.clone().woken());
        Ok(robot)
    }

    /// A robot that has just been switched on and brings a map of the place: its frame is where the robot stands.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range, or the map has other cells.
    pub fn on_map(config: RobotConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        let mut robot = Self::new(config.clone())?;
        robot.know(&config, grid)?;
        Ok(robot)
    }

    /// Goes on with a map in place of its own, which is empty.
    fn know(&mut self, config: &RobotConfig, grid: &OccupancyGrid) -> Result<(), Invalid> {
        let blind_range = self.perception.as_ref().map_or(0.0, |perception| perception.blind_range());
        let mapping = MapperConfig { blind_range, ..config.mapping.clone() };
        self.mapper = LiveMapper::from_grid(mapping, grid)?;
        Ok(())
    }

    /// The robot, saying every 3 to 10 s, the larger the map the more seldom, what it would take along through a restart:
    /// [`crate::StepReport::memory`].
    #[must_use]
    pub fn with_checkpoints(mut self) -> Self {
        if let Some(perception) = &mut self.perception {
            perception.saving = Some(CheckpointSchedule::default());
        }
        self
    }

    /// What the robot would take along through a restart now; none while it looks in the background, or does not know its place.
    pub fn memory(&mut self) -> Option<Checkpoint> {
        let visual = self.perception.as_ref()?.slam().save();
        // The grid that fits it.
        self.mapper.work_within(usize::MAX, 1);
        let now = self.localizer.estimate().stamp;
        self.knows_its_place(now).then(|| self.remember(visual))
    }

    pub(super) fn remember(&mut self, visual: Vec<u8>) -> Checkpoint {
        if let Some(decision_worker) = &self.decision_worker {
            self.latest.mission = decision_worker.executor.mission();
        }
        let mut visual_maps = self.localizer.visual_maps();
        if let Some(slam) = self.slam() {
            let maps: Vec<u32> = slam.maps().iter().map(|map| map.number()).collect();
            visual_maps.retain(|map, _| maps.contains(map));
        }
        Checkpoint {
            visual,
            visual_maps,
            grid: self.mapper.grid().clone(),
            mission: self.latest.mission.clone(),
        }
    }
}
