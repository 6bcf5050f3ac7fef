//! Runs each target in a separate process, and reports the input of a crashed process.

use crate::current_input::last_input;
use crate::finding;
use crate::watchdog::HANG_CODE;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};
use trundle_fuzz::FuzzTarget;

/// Number of crashes after which a target is abandoned. Source: ours.
const MAX_DEATHS: u64 = 3;
/// Memory disk, if available.
const MEMORY_DISK: &str = "/dev/shm";

/// Runs each target for some time, in parallel on all cores. Returns whether no fault was found.
pub fn run(targets: &[FuzzTarget], time: Duration, seed: u64) -> Result<bool, String> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (next, is_clean) = (AtomicUsize::new(0), AtomicBool::new(true));
    let failure = std::thread::scope(|scope| {
        let lane = || {
            while let Some(target) = targets.get(next.fetch_add(1, Relaxed)) {
                if !watch(target, time, seed)? {
                    is_clean.store(false, Relaxed);
                }
            }
            Ok(())
        };
        let lanes: Vec<_> = (0..cores.min(targets.len())).map(|_| scope.spawn(lane)).collect();
        lanes.into_iter().filter_map(|lane| lane.join().ok()).find_map(Result::err)
    });
    failure.map_or_else(|| Ok(is_clean.load(Relaxed)), Err)
}

/// Runs a target until its time is over, with a restart after each crash.
fn watch(target: &FuzzTarget, time: Duration, seed: u64) -> Result<bool, String> {
    let end = Instant::now() + time;
    let mut is_clean = true;
    for deaths in 0..MAX_DEATHS {
        let left = end.saturating_duration_since(Instant::now()).as_secs();
        if deaths > 0 && left == 0 {
            break;
        }
        let folder = scratch()?;
        let status = work(target, left.max(1), seed.wrapping_add(deaths), folder.path())?;
        match status.code() {
            Some(0) => break,
            Some(1) => return Ok(false),
            Some(2) => return Err(format!("{}: the target cannot be run", target.name)),
            _ => {
                is_clean = false;
                let input = last_input(folder.path()).unwrap_or_default();
                finding::report(target, &input, &death(status))?;
            }
        }
    }
    Ok(is_clean)
}

fn work(target: &FuzzTarget, seconds: u64, seed: u64, folder: &Path) -> Result<ExitStatus, String> {
    let program = std::env::current_exe().map_err(|error| format!("the runner's own path: {error}"))?;
    let mut command = Command::new(program);
    command
        .args(["work", &seconds.to_string(), &seed.to_string(), target.name])
        .arg(folder)
        .env("TMPDIR", folder);
    command.stdin(Stdio::null()).status().map_err(|error| format!("{}: cannot start: {error}", target.name))
}

/// A folder for the inputs, on a memory disk if available.
fn scratch() -> Result<tempfile::TempDir, String> {
    let made =
        if Path::new(MEMORY_DISK).is_dir() { tempfile::tempdir_in(MEMORY_DISK) } else { tempfile::tempdir() };
    made.map_err(|error| format!("a temporary folder cannot be created: {error}"))
}

fn death(status: ExitStatus) -> String {
    match status.code() {
        Some(HANG_CODE) => "hang: more than 1 s of processor time".to_owned(),
        _ => format!("the process ended: {status} (stack overflow, abort or memory)"),
    }
}
