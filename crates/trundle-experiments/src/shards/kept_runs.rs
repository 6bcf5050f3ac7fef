//! The stored runs of all shards of an experiment.

use super::shard_folder::{RUNS_FILE, RunLine, SHARD_FILE, ShardManifest};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trundle_app::AppError;

/// The stored runs of the shards of one experiment.
#[derive(Debug)]
pub struct KeptRuns {
    manifest: ShardManifest,
    /// The result of each run by its name, as JSON, with its folder.
    results: BTreeMap<String, (Value, PathBuf)>,
}

/// Maximum number of missing runs named in a message. Source: ours.
const MAX_NAMED: usize = 10;

impl KeptRuns {
    /// Reads the folders of shards.
    ///
    /// # Errors
    /// When there is no folder, a folder is not that of a shard, two folders are of different experiments, or two results of one run differ.
    pub fn read(folders: &[PathBuf]) -> Result<Self, AppError> {
        let mut kept: Option<Self> = None;
        for folder in folders {
            let manifest = read_manifest(folder)?;
            let kept =
                kept.get_or_insert_with(|| Self { manifest: manifest.clone(), results: BTreeMap::new() });
            kept.require_same_experiment(folder, &manifest)?;
            kept.add_runs(folder)?;
        }
        kept.ok_or_else(|| AppError::Input("no folder of a shard is given, expected at least one".to_owned()))
    }

    /// The experiment.
    #[must_use]
    pub fn manifest(&self) -> &ShardManifest {
        &self.manifest
    }

    /// Refuses an experiment with a run that is not stored.
    ///
    /// # Errors
    /// When runs are missing: the error names them, and the command that executes the first of them.
    pub(crate) fn require_all(&self, names: &[String]) -> Result<(), AppError> {
        let missing: Vec<&str> =
            names.iter().filter(|name| !self.results.contains_key(*name)).map(String::as_str).collect();
        let Some(first) = missing.first() else { return Ok(()) };
        let named = missing.iter().take(MAX_NAMED).copied().collect::<Vec<_>>().join("', '");
        let more = missing.len().saturating_sub(MAX_NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let arguments = self.manifest.arguments.join(" ");
        Err(AppError::Input(format!(
            "{} of {} runs are missing in the shards: '{named}'{more}. Make the first alone with `trundle experiment {arguments} --run \
             '{first}' --shard 1/1 --out DIR`, and merge DIR too",
            missing.len(),
            names.len()
        )))
    }

    /// The result of a run.
    ///
    /// # Errors
    /// When the run is not stored, or its result is invalid.
    pub(crate) fn result<T: DeserializeOwned>(&self, name: &str) -> Result<T, AppError> {
        let missing = || AppError::Input(format!("run '{name}' is missing in the shards"));
        let (result, folder) = self.results.get(name).ok_or_else(missing)?;
        let wrong =
            |error| AppError::Input(format!("{}, run '{name}': {error}", folder.join(RUNS_FILE).display()));
        T::deserialize(result).map_err(wrong)
    }

    fn require_same_experiment(&self, folder: &Path, other: &ShardManifest) -> Result<(), AppError> {
        let ShardManifest { arguments, robot_toml, version, .. } = &self.manifest;
        let differs = |what: &str, expected: &str, found: &str| {
            Err(AppError::Input(format!(
                "{}: {what} is '{found}', expected '{expected}' as in the first shard: merge shards of one experiment",
                folder.join(SHARD_FILE).display()
            )))
        };
        match other {
            _ if other.arguments != *arguments => {
                differs("the experiment", &arguments.join(" "), &other.arguments.join(" "))
            }
            _ if other.version != *version => differs("the version", version, &other.version),
            _ if other.robot_toml != *robot_toml => {
                differs("the robot file", "that of the first", "another one")
            }
            _ => Ok(()),
        }
    }

    fn add_runs(&mut self, folder: &Path) -> Result<(), AppError> {
        let path = folder.join(RUNS_FILE);
        let text = read_text(&path)?;
        for (i, line) in text.split_inclusive('\n').enumerate() {
            // A killed shard leaves an incomplete last line; the run of this line counts as missing.
            let Some(line) = line.strip_suffix('\n') else { break };
            let RunLine { run, result } = serde_json::from_str::<RunLine<Value>>(line)
                .map_err(|error| AppError::Input(format!("{}, line {}: {error}", path.display(), i + 1)))?;
            if let Some((earlier, other)) = self.results.get(&run)
                && *earlier != result
            {
                return Err(AppError::Input(format!(
                    "{}: run '{run}' differs from that in {}: expected equal results, give one of the two folders",
                    path.display(),
                    other.display()
                )));
            }
            self.results.insert(run, (result, folder.to_owned()));
        }
        Ok(())
    }
}

fn read_manifest(folder: &Path) -> Result<ShardManifest, AppError> {
    let path = folder.join(SHARD_FILE);
    let text = read_text(&path)?;
    serde_json::from_str(&text).map_err(|error| AppError::Input(format!("{}: {error}", path.display())))
}

fn read_text(path: &Path) -> Result<String, AppError> {
    std::fs::read_to_string(path).map_err(|error| {
        AppError::Input(format!(
            "{}: {error}; expected the folder of `trundle experiment ... --shard K/N`",
            path.display()
        ))
    })
}
