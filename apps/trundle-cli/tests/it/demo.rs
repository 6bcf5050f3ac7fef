use crate::program::{summary, text, trundle};
use std::fs;

/// The whole robot in closed loop: there on its own senses, nothing touched, and every promised file written.
#[test]
fn the_demo_reaches_its_goal_and_replays_byte_for_byte() {
    let scratch = tempfile::tempdir().unwrap();
    let (live, again) = (scratch.path().join("live"), scratch.path().join("again"));
    let output = trundle(&["demo", "--direct", "--seed", "2", "--quiet", "--out", text(&live)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());

    let numbers = summary(&live);
    assert_eq!(numbers["contacts"], 0);
    assert!(numbers["goal_error_m"].as_f64().unwrap() < 0.05, "{numbers}");
    assert!(numbers["goal_error_heading_rad"].as_f64().unwrap().abs() < 3_f64.to_radians(), "{numbers}");
    assert!(numbers["path_length_m"].as_f64().unwrap() > 5.0, "{numbers}");

    let recording = live.join("recording.mcap");
    let output = trundle(&["replay", text(&recording), "--threads", "1", "--quiet", "--out", text(&again)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["map.pgm", "map.yaml", "trajectory.txt", "groundtruth.txt", "report.html", "recording.mcap"]
    {
        let bytes = |folder: &std::path::Path| fs::read(folder.join(name)).unwrap();
        assert!(bytes(&live) == bytes(&again), "{name} differs");
    }
}
