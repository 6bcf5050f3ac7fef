//! Runs with failing sensors, slipping wheels and people in the path: each must end as its scenario expects, without a contact.

use crate::program;
use crate::workspace::Verdict;
use std::path::Path;

/// Runs every scenario of `trundle experiment faults`, two at a time.
pub fn run(root: &Path) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let out = program::scratch(root, "fault-scenarios")?.join("out").display().to_string();
    let code = program::run(&trundle, &["experiment", "faults", "--threads", "2", "--out", &out])?;
    Ok(code == Some(0))
}
