//! Facts of a run that a viewer gets once.

use serde::Serialize;
use std::path::Path;
use trundle_app::RunSetup;
use trundle_core::{DriveLimits, Footprint, Invalid};
use trundle_runtime::RobotConfig;

/// Kind of the displayed run; it determines the commands on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunKind {
    /// A robot with missions.
    Robot,
    /// A base without autonomy: it can be driven by hand.
    Drive,
    /// A recorded sequence of images.
    Sequence,
}

/// Facts of a run that a viewer gets once.
#[derive(Debug, Clone)]
pub struct RunFacts {
    /// Kind of the run.
    pub kind: RunKind,
    /// Name of the run, for the title of the page: `demo: house`.
    pub title: String,
    /// Outline of the robot.
    pub footprint: Footprint,
    /// Limits of the robot's speed.
    pub limits: DriveLimits,
    /// Content of the recording, in one word; empty if the page does not show it.
    pub recording: &'static str,
}

/// Radius of the disc by which the camera of a sequence is drawn \[m\]. Source: ours.
const CAMERA_RADIUS_M: f64 = 0.08;

impl RunFacts {
    /// The facts of an experiment with this robot.
    ///
    /// # Errors
    /// When the footprint of the robot cannot be used.
    pub fn of_experiment(name: &str, robot: &RobotConfig) -> Result<Self, Invalid> {
        let (title, footprint) = (format!("experiment: {name}"), robot.footprint()?);
        Ok(Self { kind: RunKind::Robot, title, footprint, limits: robot.limits, recording: "" })
    }

    /// The facts of a drive of a round base without autonomy.
    #[must_use]
    pub fn of_drive(scene: &str, radius_m: f64, is_recorded: bool) -> Self {
        let (title, footprint) = (format!("sim: {scene}"), Footprint::Disc { radius: radius_m });
        let recording = if is_recorded { "all" } else { "none" };
        Self { kind: RunKind::Drive, title, footprint, limits: DriveLimits::KOBUKI, recording }
    }

    /// The facts of a recorded sequence.
    #[must_use]
    pub fn of_sequence(path: &Path) -> Self {
        Self::of_file("slam", path)
    }

    /// The facts of a log that is mapped.
    #[must_use]
    pub fn of_log(path: &Path) -> Self {
        Self::of_file("map", path)
    }

    fn of_file(command: &str, path: &Path) -> Self {
        let name = path.file_name().unwrap_or(path.as_os_str()).display();
        let (title, footprint) = (format!("{command}: {name}"), Footprint::Disc { radius: CAMERA_RADIUS_M });
        Self { kind: RunKind::Sequence, title, footprint, limits: DriveLimits::KOBUKI, recording: "" }
    }

    /// The facts of a setup.
    ///
    /// # Errors
    /// When the footprint of the robot cannot be used.
    pub fn of(setup: &RunSetup) -> Result<Self, Invalid> {
        Ok(Self {
            kind: RunKind::Robot,
            title: format!("{}: {}", setup.command, setup.scene),
            footprint: setup.robot.footprint()?,
            limits: setup.robot.limits,
            recording: setup.recording.name(),
        })
    }
}
