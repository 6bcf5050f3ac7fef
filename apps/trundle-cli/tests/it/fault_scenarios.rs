//! Fault scenarios of the program: resume after a kill, damaged checkpoints, a full disk.

use crate::program::{refusal, summary, text, trundle};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A file of so many bytes holds the maps of a robot that has looked around.
const LOOKED_AROUND: u64 = 400_000;

/// The program is killed in the middle of its mission; switched on again, elsewhere in the room, it recognises where it is and
/// does the rest.
#[test]
fn a_killed_robot_wakes_up_and_goes_on_with_its_mission() {
    let scratch = tempfile::tempdir().unwrap();
    let [memory, first, second] = ["memory", "first", "second"].map(|name| scratch.path().join(name));
    let mut running = Command::new(env!("CARGO_BIN_EXE_trundle"))
        .args([
            "demo",
            "--direct",
            "--seed",
            "2",
            "--quiet",
            "--memory",
            text(&memory),
            "--out",
            text(&first),
        ])
        .stdin(Stdio::null())
        .spawn()
        .unwrap();
    let patience = Instant::now();
    while std::fs::metadata(&memory).map_or(0, |file| file.len()) < LOOKED_AROUND {
        assert!(running.try_wait().unwrap().is_none(), "it ended before it remembered anything");
        assert!(patience.elapsed() < Duration::from_secs(300), "it remembers nothing");
        std::thread::sleep(Duration::from_millis(20));
    }
    running.kill().unwrap();
    running.wait().unwrap();
    assert!(!first.exists(), "no half results");

    let again = ["demo", "--seed", "2", "--quiet", "--wake", "1.5,1.3,60", "--checkpoint", text(&memory)];
    let output = trundle(&[again.as_slice(), &["--out", text(&second)]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&second);
    assert_eq!(numbers["contacts"], 0);
    assert!(numbers["goal_error_m"].as_f64().unwrap() < 0.05, "{numbers}");
}

#[test]
fn a_memory_that_is_none_is_refused_by_its_name() {
    let scratch = tempfile::tempdir().unwrap();
    let memory = scratch.path().join("memory");
    std::fs::write(&memory, b"TRUNDLEM but no more").unwrap();
    let sentence = refusal(&["demo", "--wake", "1,1,0", "--checkpoint", text(&memory)]);
    assert!(sentence.contains(text(&memory)) && sentence.contains("version"), "{sentence}");
    let sentence = refusal(&["demo", "--wake", "1,1,0"]);
    assert!(sentence.contains("--checkpoint"), "{sentence}");
}

/// A file that may not grow is as a disk that is full: the recording ends, the robot does not.
#[test]
#[cfg(unix)]
fn a_full_disk_ends_the_recording_and_not_the_mission() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let script = format!(
        "trap '' XFSZ; ulimit -f 8000; exec {} demo --direct --seed 2 --record all --out {}",
        env!("CARGO_BIN_EXE_trundle"),
        text(&out)
    );
    let output = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("recording.mcap") && message.contains("the robot continues"), "{message}");
    assert_eq!(summary(&out)["contacts"], 0);
    assert!(summary(&out)["goal_error_m"].as_f64().unwrap() < 0.05);
    assert!(!out.join("recording.mcap").exists());
}
