//! What a run tells a viewer once.

use serde::Serialize;
use trundle_app::RunSetup;
use trundle_core::{DriveLimits, Footprint, Invalid};

/// What a page shows: by it the page offers what can be commanded.
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

/// What a run tells a viewer once.
#[derive(Debug, Clone)]
pub struct RunFacts {
    /// What it is.
    pub kind: RunKind,
    /// The run, for the title of the page: `demo: house`.
    pub title: String,
    /// Outline of the robot.
    pub footprint: Footprint,
    /// Limits of its speed.
    pub limits: DriveLimits,
    /// Content of the recording, in a word; empty where the page says nothing about it.
    pub recording: &'static str,
}

impl RunFacts {
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
