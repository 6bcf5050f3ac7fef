//! `trundle demo`: the goal, the replay, and the sizes of recordings.

use crate::program::{refusal, summary, text, trundle};
use std::fs;

/// The whole robot in closed loop: the goal is reached with its own estimate, without contact, and every file is written.
#[test]
fn the_demo_reaches_its_goal_and_replays_byte_for_byte() {
    let scratch = tempfile::tempdir().unwrap();
    let (live, again) = (scratch.path().join("live"), scratch.path().join("again"));
    let output =
        trundle(&["demo", "--direct", "--seed", "2", "--quiet", "--record", "all", "--out", text(&live)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());

    let numbers = summary(&live);
    assert_eq!(numbers["contacts"], 0);
    assert!(numbers["goal_error_m"].as_f64().unwrap() < 0.05, "{numbers}");
    assert!(numbers["goal_error_heading_rad"].as_f64().unwrap().abs() < 3_f64.to_radians(), "{numbers}");
    assert!(numbers["path_length_m"].as_f64().unwrap() > 5.0, "{numbers}");

    let recording = live.join("recording.mcap");
    let cut = scratch.path().join("cut.mcap");
    let bytes = fs::read(&recording).unwrap();
    fs::write(&cut, &bytes[..bytes.len() / 3]).unwrap();
    assert!(refusal(&["replay", text(&cut), "--out", text(&again)]).contains("--recover"));
    let output = trundle(&["replay", text(&cut), "--recover", "--quiet", "--out", text(&again)]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let place = format!("cut at byte {}; ", bytes.len() / 3);
    assert!(message.contains(&place), "{message}");
    assert!(summary(&again)["cut"].as_str().unwrap().contains(&place), "{}", summary(&again));
    assert_eq!(numbers["cut"], serde_json::Value::Null);
    let output = trundle(&["replay", text(&recording), "--threads", "1", "--quiet", "--out", text(&again)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["map.pgm", "map.yaml", "trajectory.txt", "groundtruth.txt", "report.html", "recording.mcap"]
    {
        let bytes = |folder: &std::path::Path| fs::read(folder.join(name)).unwrap();
        assert!(bytes(&live) == bytes(&again), "{name} differs");
    }
}

#[test]
fn a_time_limit_of_a_fraction_of_a_second_is_named_as_given() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output = trundle(&["demo", "--direct", "--time-limit", "0.3", "--out", text(&out)]);
    let message = String::from_utf8_lossy(&output.stdout);
    assert!(message.contains("less than 1 MB in 0.3 s"), "{message}");
    assert!(message.contains("the time limit of 0.3 s ended the run"), "{message}");
}

#[test]
fn a_recording_has_no_images_unless_it_is_asked_for_all() {
    let scratch = tempfile::tempdir().unwrap();
    let record = |what: &[&str]| {
        let out = scratch.path().join(what.join("-"));
        let args = ["demo", "--direct", "--time-limit", "4", "--out", text(&out)];
        let output = trundle(&[&args[..], what].concat());
        assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
        (out.join("recording.mcap"), String::from_utf8(output.stdout).unwrap())
    };
    let (events, message) = record(&[]);
    assert!(message.contains("Records events without images") && message.contains("MB in 4 s"), "{message}");
    let bytes = fs::metadata(&events).unwrap().len();
    assert!((50_000..2_000_000).contains(&bytes), "{bytes} bytes in 4 s");
    assert!(refusal(&["replay", text(&events)]).contains("--record all"));
    let (nothing, message) = record(&["--record", "none"]);
    assert!(message.contains("Nothing is recorded.") && !nothing.exists(), "{message}");
}
