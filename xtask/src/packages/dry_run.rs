//! The publication of every crate, in order and without an upload: what the registry's client checks before one.

use crate::program;
use std::path::Path;
use std::process::{Command, Stdio};

/// Longest time of the dry runs \[s\]; a registry that takes longer counts as unreachable. Source: ours, all crates together take 55 to 80 s: cargo
/// asks the registry anew for each dependency of each crate.
const MAX_S: &str = "180";
/// Exit code of `timeout` if the time was over. Source: its manual.
const TIME_OVER: i32 = 124;

/// What cargo prints if the registry cannot be reached.
const UNREACHABLE: [&str; 6] = [
    "spurious network error",
    "failed to download from",
    "Could not resolve host",
    "Couldn't connect to server",
    "failed to query replaced source registry",
    "download of config.json failed",
];

/// Result of a dry run.
#[derive(Debug, PartialEq, Eq)]
pub enum DryRun {
    /// Every crate can be published.
    Passed,
    /// The registry cannot be reached: the reason.
    Unreachable(String),
    /// What cargo has against a crate.
    Failed(String),
}

/// Runs `cargo publish --dry-run` for all crates, in the order of their dependencies. Without builds: the workspace's own builds are
/// those of the same sources.
pub fn run(root: &Path) -> Result<DryRun, String> {
    let mut cargo = Command::new("timeout");
    cargo.arg(MAX_S).arg(program::cargo_path());
    cargo.args(["publish", "--workspace", "--dry-run", "--no-verify", "--allow-dirty", "--locked"]);
    // One answer tells whether there is a network.
    cargo.env("CARGO_NET_RETRY", "1").current_dir(root).stdin(Stdio::null());
    let output = cargo.output().map_err(|e| format!("cannot start timeout and cargo publish: {e}"))?;
    Ok(match output.status.code() {
        Some(0) => DryRun::Passed,
        Some(TIME_OVER) => DryRun::Unreachable(format!("it takes more than {MAX_S} s")),
        _ => failure(&String::from_utf8_lossy(&output.stderr)),
    })
}

/// What the output of a failed run means.
fn failure(text: &str) -> DryRun {
    let is_of_network = |line: &&str| UNREACHABLE.iter().any(|part| line.contains(part));
    match text.lines().find(is_of_network) {
        Some(line) => DryRun::Unreachable(line.trim().to_owned()),
        None => DryRun::Failed(text.trim().to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_network_is_no_fault_of_a_crate() {
        let text = "    Updating crates.io index\nwarning: spurious network error (1 try remaining): [6] Could not resolve host\nerror: x\n";
        assert!(matches!(failure(text), DryRun::Unreachable(why) if why.starts_with("warning: spurious")));
        let text = "error: failed to verify manifest at `Cargo.toml`\n";
        assert_eq!(failure(text), DryRun::Failed(text.trim().to_owned()));
    }
}
