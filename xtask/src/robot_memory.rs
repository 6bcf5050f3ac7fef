//! Resident memory of the robot's process: `trundle run` against a simulated base and camera that run in another process.

use crate::program;
use crate::workspace::Verdict;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Scene of the exploration: larger than the area explored in ten minutes.
const SCENE: &str = "office";
/// Time between two samples. Source: ours.
const SAMPLE_PERIOD: Duration = Duration::from_secs(5);
/// Longest time until the simulator answers. Source: ours.
const START_LIMIT: Duration = Duration::from_secs(20);
/// Largest resident memory at the end \[MB\]. A computer with 1 GB needs most of its memory for other programs. Source: ours.
const MAX_RESIDENT_MB: f64 = 300.0;

/// Memory of a process, MB.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Memory {
    resident: f64,
    peak: f64,
}

/// Runs an exploration for some minutes. Returns whether its memory stays below the limit.
pub fn run(root: &Path, minutes: f64) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let scratch = program::scratch(root, "robot-memory")?;
    let (base, camera) = (scratch.join("base"), scratch.join("camera"));
    let duration = Duration::from_secs_f64(minutes * 60.0);
    let past_end = (duration.as_secs() + 60).to_string();
    let mut simulator = Command::new(&trundle);
    simulator.args(["sim", SCENE, "--quiet", "--duration", &past_end]);
    simulator.arg("--kobuki").arg(&base).arg("--camera-stream").arg(&camera);
    let _simulator = Running::start(simulator)?;
    wait_for(&[&base, &camera])?;
    let mut robot = Command::new(&trundle);
    robot.args(["run", "--quiet", "--explore", "--time-limit", &(duration.as_secs() + 30).to_string()]);
    robot.arg("--base").arg(format!("kobuki:{}", base.display()));
    robot.arg("--camera").arg(format!("stream:{}", camera.display()));
    robot.arg("--out").arg(scratch.join("out"));
    let mut robot = Running::start(robot)?;
    let last = watch(&mut robot.0, duration)?;
    println!("resident at the end: {:.1} MB", last.resident);
    println!("peak: {:.1} MB", last.peak);
    Ok(last.peak <= MAX_RESIDENT_MB)
}

/// Prints samples for `duration`; the last one. An error if the process ends before.
fn watch(robot: &mut Child, duration: Duration) -> Result<Memory, String> {
    let start = Instant::now();
    loop {
        if let Some(status) =
            robot.try_wait().map_err(|e| format!("cannot ask for the robot's state: {e}"))?
        {
            return Err(format!("the robot ended after {:.0} s: {status}", start.elapsed().as_secs_f64()));
        }
        let path = format!("/proc/{}/status", robot.id());
        let text = std::fs::read_to_string(&path).map_err(|e| format!("cannot read {path}: {e}"))?;
        let memory = memory(&text).ok_or(format!("{path} names no memory"))?;
        println!("{:6.0} s {:7.1} MB", start.elapsed().as_secs_f64(), memory.resident);
        if start.elapsed() >= duration {
            return Ok(memory);
        }
        std::thread::sleep(SAMPLE_PERIOD);
    }
}

/// Memory by the text of `/proc/PID/status`.
fn memory(status: &str) -> Option<Memory> {
    let mb = |key: &str| {
        let value = status.lines().find_map(|line| line.strip_prefix(key))?;
        Some(value.trim().trim_end_matches(" kB").parse::<f64>().ok()? / 1024.0)
    };
    Some(Memory { resident: mb("VmRSS:")?, peak: mb("VmHWM:")? })
}

fn wait_for(paths: &[&Path]) -> Result<(), String> {
    let start = Instant::now();
    while !paths.iter().all(|path| path.exists()) {
        if start.elapsed() > START_LIMIT {
            return Err("the simulator does not answer".into());
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    Ok(())
}

/// A program that is ended with this.
struct Running(Child);

impl Running {
    fn start(mut command: Command) -> Result<Self, String> {
        command.stdin(Stdio::null());
        command.spawn().map(Self).map_err(|e| format!("cannot start {command:?}: {e}"))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // A program that has ended already cannot be ended, and need not be.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_in_mb() {
        let status = "Name:\ttrundle\nVmHWM:\t  2048 kB\nVmRSS:\t  1536 kB\n";
        assert_eq!(memory(status), Some(Memory { resident: 1.5, peak: 2.0 }));
        assert_eq!(memory("VmHWM: 3 kB\n"), None);
    }

    #[test]
    fn a_robot_that_ends_early_is_not_measured() {
        let mut ended = Command::new("true").spawn().unwrap();
        ended.wait().unwrap();
        assert!(watch(&mut ended, Duration::ZERO).is_err());
    }
}
