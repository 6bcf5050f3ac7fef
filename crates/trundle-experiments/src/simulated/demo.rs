//! The setup of a demo: a mission in a simulated scene.

use super::body::{require_free, simulated_body, simulated_real_time_body, time_limit};
use super::fault_file::read_faults;
use super::scene::{SceneOptions, load_scene};
use std::path::PathBuf;
use trundle_app::{AppError, MissionRequest, RecordingContent, RunSetup, read_checkpoint};
use trundle_core::Pose2;
use trundle_runtime::{Mission, RobotConfig};
use trundle_sim::{Scene, Simulator};

/// A demo: scene, mission, robot and files.
#[derive(Debug, Clone)]
pub struct DemoRequest {
    /// The scene: a name or a file.
    pub scene: String,
    /// Seed, start and furniture of the scene.
    pub place: SceneOptions,
    /// Goals in the map frame; empty for the scene's own.
    pub goals: Vec<Pose2>,
    /// Whether the robot drives straight to the goals, without exploring before and returning after them.
    pub is_direct: bool,
    /// Whether the mission ends on the charging station.
    pub dock: bool,
    /// Whether a person may give commands to the run.
    pub is_operated: bool,
    /// Whether the run is in real time; an operated one is.
    pub real_time: bool,
    /// The file that stores the robot's state.
    pub checkpoint: Option<PathBuf>,
    /// Pose of the robot in the scene, with which it resumes from the checkpoint.
    pub resume: Option<Pose2>,
    /// Content of the recording.
    pub record: RecordingContent,
    /// A file of a vocabulary.
    pub vocabulary: Option<PathBuf>,
    /// A file of faults.
    pub faults: Option<PathBuf>,
    /// Longest time of the run \[s\]; `None` for that of the mission.
    pub time_limit: Option<f64>,
    /// The robot.
    pub robot: RobotConfig,
}

impl DemoRequest {
    /// The run and its simulated body.
    ///
    /// # Errors
    /// Names the file, the value, or the start or goal that is not free.
    pub fn prepare(
        self,
        with_zones: impl FnOnce(RunSetup) -> Result<RunSetup, AppError>,
    ) -> Result<(RunSetup, Simulator), AppError> {
        let mut scene = load_scene(&self.scene, self.place)?;
        let faults = self.faults.as_deref().map(read_faults).transpose()?.unwrap_or_default();
        let resumed = self.resume.and(self.checkpoint.as_deref()).map(read_checkpoint).transpose()?;
        let mission = match &resumed {
            Some((checkpoint, _)) => checkpoint.mission.left.clone(),
            None => self.mission(&scene)?,
        };
        let mut setup = with_zones(self.setup(&scene, mission, resumed.map(|(_, bytes)| bytes))?)?;
        setup.map_from_world = scene.start.inverse();
        require_free("start", &scene, scene.start, &setup.robot)?;
        for goal in setup.mission.tasks().iter().filter_map(RunSetup::goal_of) {
            require_free("goal", &scene, scene.start * goal, &setup.robot)?;
        }
        scene.start = self.resume.unwrap_or(scene.start);
        let body = if setup.real_time { simulated_real_time_body } else { simulated_body };
        let body = Simulator::new(scene, body(&setup.robot, faults)?, self.place.seed);
        Ok((setup, body.map_err(AppError::input)?))
    }

    fn setup(
        &self,
        scene: &Scene,
        mission: Mission,
        checkpoint: Option<Vec<u8>>,
    ) -> Result<RunSetup, AppError> {
        let seed = self.place.seed;
        let mut setup = RunSetup::new(&scene.name, mission, self.robot.clone().with_seed(seed));
        setup.seed = seed;
        setup.is_operated = self.is_operated;
        let limit = if self.is_operated { f64::MAX } else { time_limit(&setup.mission) };
        setup.time_limit = self.time_limit.unwrap_or(limit);
        setup.real_time = self.real_time || self.is_operated;
        setup.recording = self.record;
        let setup = setup.with_vocabulary_of(self.vocabulary.as_deref())?;
        Ok(checkpoint.iter().fold(setup, |setup, bytes| setup.resumed_from(bytes)))
    }

    /// The requested goals, or the scene's. Unless the drive is direct, exploration precedes the goals and the return follows.
    fn mission(&self, scene: &Scene) -> Result<Mission, AppError> {
        let mut goals = self.goals.clone();
        if goals.is_empty() && !(self.is_direct && self.dock) {
            goals.push(scene.start_from_goal());
        }
        MissionRequest { goals, explore: !self.is_direct, dock: self.dock, file: None }.mission()
    }
}
