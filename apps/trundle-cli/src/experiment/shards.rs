//! Shards of an experiment on the command line.

use super::args::{Experiment, ExperimentArgs, MergeArgs, SeriesArgs};
use clap::Parser;
use trundle::app::AppError;
use trundle::experiments::{RunOrigin, ShardManifest, shard_arguments};
use trundle::runtime::settings::to_commented_toml;

/// The words after `trundle experiment`.
#[derive(Debug, Parser)]
#[command(no_binary_name = true)]
struct ExperimentLine {
    #[command(flatten)]
    experiment: ExperimentArgs,
}

/// The origin of the runs, by the options of an experiment.
///
/// # Errors
/// When the robot file cannot be read.
pub fn origin_of(series: Option<&SeriesArgs>) -> Result<RunOrigin, AppError> {
    let Some((series, shard)) = series.and_then(|series| Some((series, series.shard?))) else {
        return Ok(RunOrigin::Made);
    };
    let words = std::env::args().skip_while(|word| word != "experiment").skip(1);
    let manifest = ShardManifest {
        arguments: shard_arguments(words),
        robot_toml: series.robot.robot_if_given()?.map(|robot| to_commented_toml(&robot)),
        version: env!("TRUNDLE_LONG_VERSION").to_owned(),
        shard,
    };
    Ok(RunOrigin::Shard(Box::new(manifest), series.run.clone()))
}

/// The experiment of merged shards, with the output of the merge.
///
/// # Errors
/// When the arguments in the manifest do not belong to an experiment of this version.
pub fn experiment_of(manifest: &ShardManifest, merge: &MergeArgs) -> Result<Experiment, AppError> {
    let out = ["--out".into(), merge.out.as_os_str().to_owned()];
    let quiet = merge.common.quiet.then(|| "--quiet".into());
    let words = manifest.arguments.iter().map(Into::into).chain(out).chain(quiet);
    let line = ExperimentLine::try_parse_from(words);
    Ok(line.map_err(|error| AppError::Input(format!("shard.json: {error}")))?.experiment.which)
}
