//! Folder of the workspace, and the result type of a task.

use std::path::{Path, PathBuf};

/// Result of a task: whether it passed, or the reason why it could not run.
pub type Verdict = Result<bool, String>;

/// The workspace's folder.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("invariant: xtask lies in the workspace").to_path_buf()
}
