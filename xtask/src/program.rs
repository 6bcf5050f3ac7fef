//! Running other programs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Features of the program of a release: all that need no library of the system.
pub const FEATURES: &str = "ros2,mqtt,foxglove,tls";

/// Runs `cargo` with `args` (and `env`) in the workspace, without standard input. Returns whether it succeeded.
pub fn cargo(root: &Path, args: &[&str], env: &[(&str, &str)]) -> Result<bool, String> {
    let mut command = Command::new(cargo_path());
    command.args(args).envs(env.iter().copied()).current_dir(root).stdin(Stdio::null());
    let status = command.status().map_err(|e| format!("cannot start cargo {}: {e}", args.join(" ")))?;
    Ok(status.success())
}

/// Builds the program in a profile (`release`, `dev`); its path. The program of a release has all its features.
pub fn trundle(root: &Path, profile: &str) -> Result<PathBuf, String> {
    let features: &[&str] = if profile == "release" { &["--features", FEATURES] } else { &[] };
    let build = ["build", "--profile", profile, "--package", "trundle-cli"];
    if !cargo(root, &[&build, features].concat(), &[])? {
        return Err(format!("the program does not build in profile {profile}"));
    }
    let folder = if profile == "dev" { "debug" } else { profile };
    Ok(target(root)?.join(folder).join(format!("trundle{}", std::env::consts::EXE_SUFFIX)))
}

/// Builds the release program; its path.
pub fn release_trundle(root: &Path) -> Result<PathBuf, String> {
    trundle(root, "release")
}

/// Runs the program; returns its exit code (`None`: killed). Its output is not captured.
pub fn run(program: &Path, args: &[&str]) -> Result<Option<i32>, String> {
    println!("  trundle {}", args.join(" "));
    let status = Command::new(program).args(args).stdin(Stdio::null()).status();
    Ok(status.map_err(|e| format!("cannot start {}: {e}", program.display()))?.code())
}

/// Runs the program, and prints an exit code other than 0. Returns whether the exit code is 0.
pub fn ends_well(program: &Path, args: &[&str]) -> Result<bool, String> {
    let code = run(program, args)?;
    if code != Some(0) {
        let code = code.map_or("none (killed)".into(), |code| code.to_string());
        println!("exit code {code}, expected 0: trundle {}", args.join(" "));
    }
    Ok(code == Some(0))
}

/// Lets go the recording of a run that went well: some GB.
pub fn drop_recording(out: &Path) {
    // A file that cannot be removed is overwritten by the next run.
    let _ = std::fs::remove_file(out.join("recording.mcap"));
}

/// Standard output of `cargo` with `args`, in the workspace.
pub fn cargo_output(root: &Path, args: &[&str]) -> Result<String, String> {
    let output = Command::new(cargo_path()).args(args).current_dir(root).stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start cargo {}: {e}", args.join(" ")))?;
    if !output.status.success() {
        return Err(format!("cargo {}: {}", args.join(" "), String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Cargo's metadata of the workspace: packages and folders.
pub fn metadata(root: &Path) -> Result<serde_json::Value, String> {
    let text = cargo_output(root, &["metadata", "--format-version=1", "--no-deps", "--offline"])?;
    serde_json::from_str(&text).map_err(|e| format!("cargo metadata: {e}"))
}

/// The folder of build results.
pub fn target(root: &Path) -> Result<PathBuf, String> {
    let metadata = metadata(root)?;
    let target = metadata["target_directory"].as_str().ok_or("cargo metadata names no target_directory")?;
    Ok(PathBuf::from(target))
}

/// An empty folder below the build results.
pub fn scratch(root: &Path, name: &str) -> Result<PathBuf, String> {
    let folder = target(root)?.join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|e| format!("cannot clear {}: {e}", folder.display()))?;
    }
    std::fs::create_dir_all(&folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
    Ok(folder)
}

/// Standard output of a program that must succeed.
pub fn output(program: &Path, args: &[&str]) -> Result<Vec<u8>, String> {
    let output = Command::new(program).args(args).stdin(Stdio::null()).output();
    let output = output.map_err(|e| format!("cannot start {}: {e}", program.display()))?;
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(format!("{} {}: {}: {why}", program.display(), args.join(" "), output.status));
    }
    Ok(output.stdout)
}

/// Whether a program can be started.
pub fn answers(program: &str, argument: &str) -> bool {
    let mut process = Command::new(program);
    process.arg(argument).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    process.status().is_ok_and(|status| status.success())
}

/// The cargo that runs this program.
pub fn cargo_path() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_build_results_are_found_and_scratch_is_empty() {
        let scratch = scratch(&crate::workspace::root(), "xtask-test").unwrap();
        assert!(scratch.is_dir() && std::fs::read_dir(&scratch).unwrap().next().is_none());
        std::fs::remove_dir(scratch).unwrap();
    }
}
