//! Experiments in parts: a shard stores its runs in a folder, and a merge of the shards gives the report of the whole experiment.

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
