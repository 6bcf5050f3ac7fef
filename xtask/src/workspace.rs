//! Where the workspace is, and how a chore answers.

use std::path::{Path, PathBuf};

/// How a chore that ran ended: whether all is well, or why it could not run.
pub type Verdict = Result<bool, String>;

/// The workspace's folder.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("invariant: xtask lies in the workspace").to_path_buf()
}
