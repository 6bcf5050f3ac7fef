//! Facts of a run that a viewer gets once.

use trundle_app::RunSetup;
use trundle_core::{DriveLimits, Footprint, Invalid};

/// Facts of a run that a viewer gets once.
#[derive(Debug, Clone)]
pub struct RunFacts {
    /// The run, for the title of the page: `demo: house`.
    pub title: String,
    /// Outline of the robot.
    pub footprint: Footprint,
    /// Limits of its speed.
    pub limits: DriveLimits,
    /// Content of the recording, in a word.
    pub recording: &'static str,
}

impl RunFacts {
    /// The facts of a setup.
    ///
    /// # Errors
    /// When the footprint of the robot cannot be used.
    pub fn of(setup: &RunSetup) -> Result<Self, Invalid> {
        Ok(Self {
            title: format!("{}: {}", setup.command, setup.scene),
            footprint: setup.robot.footprint()?,
            limits: setup.robot.limits,
            recording: setup.recording.name(),
        })
    }
}
