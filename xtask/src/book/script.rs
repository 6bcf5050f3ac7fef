//! A script in a process group of its own: what it leaves in the background ends with it.

use std::io::{Read, Seek};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Longest time of a script \[s\]; a longer one is ended and fails. Source: ours, a script takes less than 20 s on an idle computer.
const MAX_SCRIPT_S: f64 = 300.0;
/// Time between two looks whether a script has ended \[ms\]. Source: ours.
const POLL_MS: u64 = 20;

/// The end of a script.
pub struct End {
    /// What it printed, both streams in the order of their lines.
    pub output: String,
    /// The exit code or the time, if the script failed.
    pub failure: Option<String>,
}

/// Runs a script without standard input.
pub fn run(shell: Command) -> Result<End, String> {
    run_for(shell, MAX_SCRIPT_S)
}

fn run_for(mut shell: Command, limit_s: f64) -> Result<End, String> {
    let failed = |e: std::io::Error| format!("cannot run sh: {e}");
    // A pipe would stay open as long as a process of the background does.
    let mut printed = tempfile::tempfile().map_err(failed)?;
    let streams = [printed.try_clone().map_err(failed)?, printed.try_clone().map_err(failed)?];
    let [out, err] = streams.map(Stdio::from);
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut shell, 0);
    let mut child = shell.stdin(Stdio::null()).stdout(out).stderr(err).spawn().map_err(failed)?;
    let status = wait(&mut child, limit_s);
    end_group(child.id());
    let failure = match status.map_err(failed)? {
        Some(status) => failure(status),
        None => {
            child.wait().map_err(failed)?;
            Some(format!("no end after {limit_s} s, expected one"))
        }
    };
    let mut bytes = Vec::new();
    printed.rewind().and_then(|()| printed.read_to_end(&mut bytes)).map_err(failed)?;
    Ok(End { output: String::from_utf8_lossy(&bytes).into_owned(), failure })
}

/// Waits for the end of a process; `None` if it takes longer than `limit_s`.
fn wait(child: &mut Child, limit_s: f64) -> std::io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    loop {
        let status = child.try_wait()?;
        if status.is_some() || start.elapsed().as_secs_f64() > limit_s {
            return Ok(status);
        }
        std::thread::sleep(Duration::from_millis(POLL_MS));
    }
}

fn failure(status: ExitStatus) -> Option<String> {
    let code = || status.code().map_or("none (killed)".into(), |code| code.to_string());
    (!status.success()).then(|| format!("exit code {}, expected 0", code()))
}

/// Kills what is left of a process group. An empty group is no error.
fn end_group(id: u32) {
    let mut kill = Command::new("kill");
    kill.args(["-KILL", "--", &format!("-{id}")]).stdin(Stdio::null()).stderr(Stdio::null());
    let _ = kill.status();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sh(text: &str, limit_s: f64) -> End {
        let mut shell = Command::new("sh");
        shell.args(["-c", text]);
        run_for(shell, limit_s).unwrap()
    }

    #[test]
    fn what_is_left_in_the_background_ends_with_the_script() {
        let start = Instant::now();
        let end = sh("sleep 60 & echo $!", 30.0);
        assert!(end.failure.is_none() && start.elapsed().as_secs_f64() < 20.0);
        let process = std::path::Path::new("/proc").join(end.output.trim());
        let is_gone = || {
            !process.exists()
                || std::fs::read_to_string(process.join("stat")).is_ok_and(|s| s.contains(") Z "))
        };
        while !is_gone() {
            assert!(start.elapsed().as_secs_f64() < 20.0, "{} is still there", process.display());
            std::thread::sleep(Duration::from_millis(POLL_MS));
        }
    }

    #[test]
    fn a_script_that_does_not_end_fails() {
        let end = sh("echo begun; sleep 60", 0.2);
        assert_eq!(
            (end.output.as_str(), end.failure.as_deref()),
            ("begun\n", Some("no end after 0.2 s, expected one"))
        );
    }
}
