//! Experiments in parts: the runs of a shard are kept in a folder, and shards are merged into the report of the whole experiment.

mod arguments;
mod kept_runs;
pub(crate) mod points;
mod run_origin;
mod shard;
mod shard_folder;

pub use arguments::shard_arguments;
pub use kept_runs::KeptRuns;
pub use run_origin::RunOrigin;
pub use shard::Shard;
pub use shard_folder::{ShardManifest, ShardWriter};
