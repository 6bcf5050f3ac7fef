//! Reproducible builds: the program of a release, built from two folders, has the same bytes.

use super::{build, sha256};
use crate::program;
use crate::workspace::Verdict;
use std::path::Path;
use std::process::{Command, Stdio};

/// Folder of the clone, below the build results. It is kept: the next run builds what has changed.
const CLONE: &str = "reproduce/a-clone-at-another-path";

/// Builds the committed sources here and in a clone at another path. Returns whether both programs have the same bytes.
pub fn run(root: &Path) -> Verdict {
    if !is_clean(root)? {
        return Err(
            "the sources have changes, and a clone has only what is committed: commit them first".into()
        );
    }
    let clone = program::target(root)?.join(CLONE);
    if !clone.exists() {
        git(root, &["clone", "--quiet", "--no-checkout", ".", &clone.display().to_string()])?;
    }
    let commit = git(root, &["rev-parse", "HEAD"])?;
    git(&clone, &["fetch", "--quiet", "origin", commit.trim()])?;
    git(&clone, &["checkout", "--quiet", "--force", "--detach", commit.trim()])?;
    let sums = [checksum(root)?, checksum(&clone)?];
    println!("{}", if sums[0] == sums[1] { "the same bytes" } else { "not the same bytes" });
    Ok(sums[0] == sums[1])
}

/// Builds the program of these sources; its checksum, which is printed as well.
fn checksum(root: &Path) -> Result<String, String> {
    let program = build(root, None)?;
    let sum = sha256(&program)?;
    println!("{sum}  {}", program.display());
    Ok(sum)
}

/// Whether every tracked file is as committed.
fn is_clean(root: &Path) -> Verdict {
    Ok(git(root, &["status", "--porcelain", "--untracked-files=no"])?.trim().is_empty())
}

/// Output of git.
fn git(root: &Path, args: &[&str]) -> Result<String, String> {
    let output = Command::new("git").args(args).current_dir(root).stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start git: {e}"))?;
    if !output.status.success() {
        return Err(format!("git {}: {}", args.join(" "), String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
