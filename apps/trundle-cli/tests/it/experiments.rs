//! `trundle experiment`: short runs of BARN, MRPB and plain rooms, and missing data.

use crate::program::{refusal, shared, summary, text, trundle};
use std::fs;

#[test]
fn a_barn_world_is_crossed() {
    let Some(data) = shared("nav/barn") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output =
        trundle(&["experiment", "barn", "--worlds", "2", "--data", text(&data), "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found = summary(&out);
    assert_eq!(found["success"].as_bool(), Some(true));
    assert!(found["mean_score"].as_f64().unwrap() > 0.4);
    let table = fs::read_to_string(out.join("barn.csv")).unwrap();
    assert!(table.starts_with("world,seed,success,contacts,") && table.lines().count() == 2, "{table}");
    assert!(fs::metadata(out.join("worst-1.png")).unwrap().len() > 1000);
}

#[test]
fn a_course_of_mrpb_is_driven() {
    let Some(data) = shared("nav/mrpb") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let course = ["--only", "office01add 3", "--data", text(&data), "--out", text(&out)];
    trundle(&[&["experiment", "mrpb"], &course[..]].concat());
    // The duration of the cycles depends on the machine: only the goal is checked.
    let found = summary(&out);
    assert_eq!((found["reached"].as_u64(), found["contacts"].as_u64()), (Some(1), Some(0)));
    assert!(fs::read_to_string(out.join("mrpb.csv")).unwrap().lines().count() == 2);
}

#[test]
fn a_hall_of_a_given_map_is_driven() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output =
        trundle(&["experiment", "known-map", "--only", "hall, seed 3", "--seeds", "3", "--out", text(&out)]);
    let found = summary(&out);
    assert!(output.status.success(), "{found}");
    assert_eq!((found["runs"].as_u64(), found["arrived"].as_u64()), (Some(1), Some(1)), "{found}");
    assert!(found["largest_estimate_error_m"].as_f64().unwrap() < 0.1, "{found}");
    assert!(refusal(&["experiment", "known-map", "--only", "cellar"]).contains("hall, maze, changed room"));
}

#[test]
fn a_plain_room_without_people_has_no_false_arrival() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let runs = ["--seeds", "1", "--only", "alone, seed 1", "--out", text(&out)];
    let output = trundle(&[&["experiment", "look-alikes"], &runs[..]].concat());
    let found = summary(&out);
    assert!(output.status.success(), "{found}");
    assert_eq!((found["false_arrivals"].as_u64(), found["jumps"].as_u64()), (Some(0), Some(0)));
    assert_eq!(found["arrivals"].as_u64(), Some(3), "{found}");
}

#[test]
fn missing_data_are_named() {
    assert!(refusal(&["experiment", "barn", "--data", "/nonexistent"]).contains("worlds.csv"));
    assert!(refusal(&["experiment", "mrpb", "--data", "/nonexistent"]).contains("start_goal.csv"));
    assert!(refusal(&["experiment", "barn", "--worlds", "5-2"]).contains("the last not below the first"));
}
