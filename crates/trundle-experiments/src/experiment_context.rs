//! What accompanies an experiment: its display, and the source of its runs.

use crate::experiment_display::ExperimentDisplay;
use crate::shards::{KeptRuns, ShardWriter};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use trundle_app::AppError;

/// What accompanies an experiment.
#[derive(Debug, Clone, Default)]
pub struct ExperimentContext {
    /// Its display.
    pub display: ExperimentDisplay,
    /// The source of its runs.
    pub runs: RunSource,
}

/// The source of the runs of an experiment.
#[derive(Debug, Clone, Default)]
pub enum RunSource {
    /// Each run is made.
    #[default]
    Made,
    /// The runs of a shard are made and kept.
    Shard(Arc<ShardWriter>),
    /// The runs were made and kept before.
    Kept(Arc<KeptRuns>),
}

impl RunSource {
    /// The plans whose runs belong to this source.
    ///
    /// # Errors
    /// When a shard has no run, or a kept run is missing.
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

    /// The result of a run: read if it is kept, else made. `None` for a run that has died.
    ///
    /// # Errors
    /// When a kept result cannot be understood, or the run cannot be made.
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

    /// Whether the other runs go on after the run `name` has died.
    pub(crate) fn goes_on_without(&self, name: &str) -> bool {
        match self {
            Self::Shard(writer) => {
                writer.note_dead(name);
                true
            }
            Self::Made | Self::Kept(_) => false,
        }
    }

    /// The runs of a shard that have died.
    #[must_use]
    pub fn dead(&self) -> Vec<String> {
        match self {
            Self::Shard(writer) => writer.dead(),
            Self::Made | Self::Kept(_) => Vec::new(),
        }
    }

    /// Keeps the result of a run that was made for a shard.
    ///
    /// # Errors
    /// When it cannot be written.
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
