//! `trundle config`: the robot file printed, checked and written.

use crate::program::{refusal, summary, text, trundle};
use std::fs;

fn printed(args: &[&str]) -> String {
    let output = trundle(&[&["config"], args].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_printed_file_reads_back_to_itself() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.toml");
    let first = printed(&[]);
    fs::write(&file, &first).unwrap();
    assert_eq!(printed(&[text(&file)]), first);
}

#[test]
fn a_key_that_is_set_stands_in_the_file() {
    let text = printed(&["--set", "footprint_radius_m=0.21"]);
    assert!(text.contains("footprint_radius_m = 0.21"), "{text}");
}

#[test]
fn the_folder_holds_file_schema_and_summary() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    assert!(printed(&["--quiet", "--out", text(&out)]).is_empty());
    let file = fs::read_to_string(out.join("robot.toml")).unwrap();
    assert_eq!(file.trim_end(), printed(&[]).trim_end());
    let schema: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("robot.schema.json")).unwrap()).unwrap();
    assert!(schema["properties"].is_object());
    assert!(summary(&out)["robot"].is_object());
}

#[test]
fn a_wrong_file_is_refused_with_its_line() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("robot.toml");
    fs::write(&file, "footprint_radius_m = 0.2\nwheels = 7\n").unwrap();
    let sentence = refusal(&["config", text(&file)]);
    assert!(sentence.contains("robot.toml, line 2") && sentence.contains("wheels"), "{sentence}");
    assert!(refusal(&["config", "no/robot.toml"]).contains("no/robot.toml"));
    assert!(refusal(&["config", "--set", "no.such.key=1"]).contains("no.such.key"));
}
