//! The display and the source of the runs of an experiment.

use crate::experiment_display::ExperimentDisplay;
use crate::shards::{KeptRuns, ShardWriter};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use trundle_app::AppError;

/// The display and the source of the runs of an experiment.
#[derive(Debug, Clone, Default)]
pub struct ExperimentContext {
    /// Display of the experiment.
    pub display: ExperimentDisplay,
    /// Source of the experiment's runs.
    pub runs: RunSource,
}

/// The source of the runs of an experiment.
#[derive(Debug, Clone, Default)]
pub enum RunSource {
    /// All runs are executed.
    #[default]
    Made,
    /// The program executes the runs of the shard and stores their results.
    Shard(Arc<ShardWriter>),
    /// The results are stored results of an earlier execution.
    Kept(Arc<KeptRuns>),
}

impl RunSource {
    /// The plans of this source's runs.
    ///
    /// # Errors
    /// When a shard has no run, or a stored run is missing.
    pub(crate) fn selected<P>(
        &self,
        plans: Vec<P>,
        name_of: impl Fn(&P) -> String,
    ) -> Result<Vec<P>, AppError> {
        match self {
            Self::Made => Ok(plans),
            Self::Shard(writer) => writer.selected(plans, name_of),
            Self::Kept(kept) => {
                kept.require_all(&plans.iter().map(name_of).collect::<Vec<_>>())?;
                Ok(plans)
            }
        }
    }

    /// Returns the stored result of a run, or executes the run. `None` for a run that panicked.
    ///
    /// # Errors
    /// When a stored result is invalid, or the run cannot be executed.
    pub(crate) fn result<T: DeserializeOwned>(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<Option<T>, AppError>,
    ) -> Result<Option<T>, AppError> {
        match self {
            Self::Made | Self::Shard(_) => make(),
            Self::Kept(kept) => kept.result(name).map(Some),
        }
    }

    /// Records a panic of the run `name`; returns whether the other runs continue.
    pub(crate) fn goes_on_without(&self, name: &str) -> bool {
        match self {
            Self::Shard(writer) => {
                writer.note_dead(name);
                true
            }
            Self::Made | Self::Kept(_) => false,
        }
    }

    /// A sentence about the runs of a shard that panicked; `None` without a panic.
    #[must_use]
    pub fn dead(&self) -> Option<AppError> {
        let Self::Shard(writer) = self else { return None };
        let dead = writer.dead();
        let (count, names) = (dead.len(), dead.join("', '"));
        let problem = format!("{count} runs ended without a result and are left out: '{names}'");
        (count > 0).then_some(AppError::Environment(problem))
    }

    /// Stores the result of a run of a shard.
    ///
    /// # Errors
    /// When the result cannot be written.
    pub(crate) fn keep<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        result: &T,
    ) -> Result<(), AppError> {
        match self {
            Self::Shard(writer) => writer.keep(name, result),
            Self::Made | Self::Kept(_) => Ok(()),
        }
    }
}
