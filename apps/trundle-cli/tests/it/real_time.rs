//! Runs in real time: replay and interruption.

use crate::program::{summary, text, trundle};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A robot file with a small camera: a loaded machine can process most of its images.
const SMALL_CAMERA: &str =
    "[camera]\nwidth = 128\nheight = 106\nfx = 91.5\nfy = 91.5\ncx = 63.5\ncy = 52.5\n";

/// The files that must be equal in a run and its replay.
const SAME: [&str; 6] =
    ["map.pgm", "map.yaml", "trajectory.txt", "groundtruth.txt", "report.html", "recording.mcap"];

fn replay_is_the_same(scratch: &Path, live: &Path) {
    let again = scratch.join("again");
    let recording = live.join("recording.mcap");
    let output = trundle(&["replay", text(&recording), "--threads", "1", "--quiet", "--out", text(&again)]);
    assert!(output.status.code() != Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    for name in SAME {
        let bytes = |folder: &Path| fs::read(folder.join(name)).unwrap();
        assert!(bytes(live) == bytes(&again), "{name} differs");
    }
    let without_clock = |folder: &Path| {
        let mut numbers = summary(folder);
        numbers.as_object_mut().unwrap().remove("wall_clock");
        numbers
    };
    assert_eq!(without_clock(live), without_clock(&again));
}

/// The arguments of a run in real time of the robot in a file, recorded into a folder.
fn demo<'a>(robot: &'a Path, live: &'a Path) -> [&'a str; 9] {
    ["demo", "--real-time", "--record", "all", "--quiet", "--config", text(robot), "--out", text(live)]
}

/// On a loaded machine with any order of threads: no contact, and the replay is equal.
#[test]
fn a_run_in_real_time_replays_byte_for_byte() {
    let scratch = tempfile::tempdir().unwrap();
    let (live, robot) = (scratch.path().join("live"), scratch.path().join("robot.toml"));
    fs::write(&robot, SMALL_CAMERA).unwrap();
    let direct = ["--direct", "--goal", "0.6,0,0"];
    let output = trundle(&[&demo(&robot, &live)[..], &direct].concat());
    assert!(output.status.code() != Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&live);
    assert_eq!(numbers["contacts"], 0);
    assert!(numbers["wall_clock"]["real_time"]["control"]["steps"].as_u64().unwrap() > 50, "{numbers}");
    replay_is_the_same(scratch.path(), &live);
}

/// Ctrl-C: the run ends normally, with all files written.
#[cfg(unix)]
#[test]
fn the_user_may_end_a_run_in_real_time() {
    let scratch = tempfile::tempdir().unwrap();
    let (live, robot) = (scratch.path().join("live"), scratch.path().join("robot.toml"));
    fs::write(&robot, SMALL_CAMERA).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trundle"))
        .args(demo(&robot, &live))
        .stdin(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(4));
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let asked = Instant::now();
    while child.try_wait().unwrap().is_none() && asked.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(child.wait().unwrap().code(), Some(130), "ended by Ctrl-C");
    assert_eq!(summary(&live)["state"], "stopped: the user ended the run");
    assert_eq!(summary(&live)["interrupted"], true);
    replay_is_the_same(scratch.path(), &live);
}
