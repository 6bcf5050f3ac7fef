//! Missions of `trundle demo`: exploration, and a black camera.

use crate::program::{summary, text, trundle};
use std::fs;

/// Exploration from an empty map, then a goal, then the return: each truly reached, without contact.
#[test]
fn an_unknown_room_is_explored_and_the_robot_comes_back() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output = trundle(&["demo", "--scene", "room", "--goal=2,-1,90", "--quiet", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&out);
    assert_eq!(numbers["contacts"], 0);
    let goals = numbers["goals"].as_array().unwrap();
    assert_eq!(goals.len(), 2, "{numbers}");
    for goal in goals {
        assert_eq!(goal["end"], "done");
        assert!(goal["error"]["distance"].as_f64().unwrap() < 0.03, "{goal}");
    }
}

/// A black camera image for 5 s: the robot stops, and continues.
#[test]
fn a_black_camera_costs_time_and_nothing_else() {
    let scratch = tempfile::tempdir().unwrap();
    let (out, faults) = (scratch.path().join("out"), scratch.path().join("faults.toml"));
    fs::write(&faults, "[[faults]]\nfrom_s = 3.0\nto_s = 8.0\nkind = \"camera-black\"\n").unwrap();
    let room = ["demo", "--scene", "room", "--direct", "--goal=2,-1,0", "--quiet"];
    let output = trundle(&[&room[..], &["--faults", text(&faults), "--out", text(&out)]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&out);
    assert_eq!(numbers["contacts"], 0);
    assert!(numbers["duration_s"].as_f64().unwrap() > 8.0, "{numbers}");
    assert!(numbers["goal_error_m"].as_f64().unwrap() < 0.03, "{numbers}");
}
