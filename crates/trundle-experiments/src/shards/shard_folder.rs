//! The folder of a shard: its manifest, and one line per run.

use super::Shard;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use trundle_app::AppError;

/// Name of the manifest in the folder of a shard.
pub const SHARD_FILE: &str = "shard.json";
/// Name of the file of the runs in the folder of a shard.
pub(super) const RUNS_FILE: &str = "runs.jsonl";

/// The experiment of a shard, from which a merge makes the same plan of runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShardManifest {
    /// The experiment and its options, as on the command line, without the options of the shard.
    pub arguments: Vec<String>,
    /// The robot file, if one was given.
    pub robot_toml: Option<String>,
    /// Version and commit of the program.
    pub version: String,
    /// The part of the runs.
    pub shard: Shard,
}

/// A run in the file of the runs.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct RunLine<T> {
    /// Name of the run.
    pub(super) run: String,
    /// Result of the run.
    pub(super) result: T,
}

/// Writes the folder of a shard, one run at a time. A finished run is in the file immediately.
#[derive(Debug)]
pub struct ShardWriter {
    shard: Shard,
    /// Name of the only run to execute; `None` for all runs of the shard.
    only: Option<String>,
    path: PathBuf,
    file: Mutex<File>,
    dead: Mutex<Vec<String>>,
}

impl ShardWriter {
    /// Creates the files of a shard in the existing `folder`.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn create(folder: &Path, manifest: &ShardManifest, only: Option<String>) -> Result<Self, AppError> {
        let text = serde_json::to_string_pretty(manifest).map_err(AppError::input)?;
        let written = |path: &Path, error: std::io::Error| {
            AppError::Environment(format!("{}: {error}", path.display()))
        };
        let path = folder.join(SHARD_FILE);
        std::fs::write(&path, text + "\n").map_err(|error| written(&path, error))?;
        let path = folder.join(RUNS_FILE);
        let file = File::create(&path).map_err(|error| written(&path, error))?;
        Ok(Self { shard: manifest.shard, only, path, file: Mutex::new(file), dead: Mutex::default() })
    }

    /// The plans of this part.
    ///
    /// # Errors
    /// When the shard has no runs.
    pub(crate) fn selected<P>(
        &self,
        plans: Vec<P>,
        name_of: impl Fn(&P) -> String,
    ) -> Result<Vec<P>, AppError> {
        let total = plans.len();
        let is_mine = |(place, plan): &(usize, P)| match &self.only {
            Some(only) => name_of(plan) == *only,
            None => self.shard.has(*place),
        };
        let mine: Vec<P> = plans.into_iter().enumerate().filter(is_mine).map(|(_, plan)| plan).collect();
        match &self.only {
            _ if !mine.is_empty() => Ok(mine),
            Some(only) => Err(AppError::Input(format!("--run '{only}': no run has this name"))),
            None => Err(AppError::Input(format!(
                "--shard {}: the experiment has {total} runs, expected N at most {total}",
                self.shard
            ))),
        }
    }

    /// Records a run that panicked.
    pub(crate) fn note_dead(&self, run: &str) {
        self.dead.lock().unwrap_or_else(PoisonError::into_inner).push(run.to_owned());
    }

    /// The runs that panicked, sorted.
    pub(crate) fn dead(&self) -> Vec<String> {
        let mut dead = self.dead.lock().unwrap_or_else(PoisonError::into_inner).clone();
        dead.sort();
        dead
    }

    /// Stores the result of a run.
    ///
    /// # Errors
    /// When the file cannot be written, or the result could not be read back.
    pub(crate) fn keep<T: Serialize + DeserializeOwned>(
        &self,
        run: &str,
        result: &T,
    ) -> Result<(), AppError> {
        let failed = |error: &dyn std::fmt::Display| {
            AppError::Environment(format!("{}, run '{run}': {error}", self.path.display()))
        };
        let line = RunLine { run: run.to_owned(), result };
        let text = serde_json::to_string(&line).map_err(|error| failed(&error))?;
        // JSON has no form for a number that is not finite.
        serde_json::from_str::<RunLine<T>>(&text).map_err(|error| failed(&error))?;
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all((text + "\n").as_bytes()).map_err(|error| failed(&error))
    }
}
