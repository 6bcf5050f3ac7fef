//! What breaks while the robot drives: every day must end as it should, without a contact.

use crate::program;
use crate::workspace::Verdict;
use std::path::Path;

/// Lives through every bad day of `trundle experiment faults`, two at a time.
pub fn run(root: &Path) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let out = program::scratch(root, "bad-days")?.join("out").display().to_string();
    let code = program::run(&trundle, &["experiment", "faults", "--threads", "2", "--out", &out])?;
    Ok(code == Some(0))
}
