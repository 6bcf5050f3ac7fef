//! The source of an experiment's runs, before its output folder exists.

use super::{KeptRuns, ShardManifest, ShardWriter};
use crate::RunSource;
use std::sync::Arc;
use trundle_app::{AppError, parse_robot};
use trundle_io::OutputFolder;
use trundle_runtime::RobotConfig;

/// The source of an experiment's runs.
#[derive(Debug, Clone)]
pub enum RunOrigin {
    /// All runs are executed.
    Made,
    /// A part of the runs is executed and stored; with a name, only the run of this name.
    Shard(Box<ShardManifest>, Option<String>),
    /// The runs are stored by shards.
    Kept(Arc<KeptRuns>),
}

impl RunOrigin {
    /// The robot of the experiment: the shards' robot if they stored one, otherwise the robot `given` on the command line.
    ///
    /// # Errors
    /// Those of `given`, and when the robot file of the shards is invalid.
    pub fn robot(
        &self,
        given: impl FnOnce() -> Result<Option<RobotConfig>, AppError>,
    ) -> Result<Option<RobotConfig>, AppError> {
        let Self::Kept(kept) = self else { return given() };
        let text = kept.manifest().robot_toml.as_deref();
        text.map(|text| parse_robot(text, Some("the robot file in shard.json"), &[])).transpose()
    }

    /// The source of the runs for an experiment that writes into `folder`.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn in_folder(&self, folder: &OutputFolder) -> Result<RunSource, AppError> {
        Ok(match self {
            Self::Made => RunSource::Made,
            Self::Shard(manifest, run) => {
                let writer = ShardWriter::create(&folder.staged(""), manifest, run.clone())?;
                RunSource::Shard(Arc::new(writer))
            }
            Self::Kept(kept) => RunSource::Kept(kept.clone()),
        })
    }
}
