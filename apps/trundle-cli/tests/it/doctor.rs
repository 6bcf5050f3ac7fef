//! `trundle doctor` on this computer, and with wrong variables.

use crate::program::trundle;
use std::process::{Command, Stdio};

#[test]
fn every_check_is_ok_or_has_a_remedy() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("runs").display().to_string();
    let output = trundle(&["doctor", "--json", "--out", &out]);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let checks = report["checks"].as_array().unwrap();
    assert!(checks.len() >= 13, "{report}");
    assert!(checks.iter().all(|check| (check["level"] == "ok") == check["remedy"].is_null()), "{report}");
    let problems = checks.iter().filter(|check| check["level"] == "problem").count();
    assert_eq!(report["problems"], problems);
    assert_eq!(output.status.code(), Some(i32::from(problems > 0)), "{report}");
    assert!(!place.path().join("runs").exists(), "nothing is written");
}

#[test]
fn a_wrong_domain_is_a_problem_with_exit_code_1() {
    let mut doctor = Command::new(env!("CARGO_BIN_EXE_trundle"));
    let output = doctor.arg("doctor").env("ROS_DOMAIN_ID", "many").stdin(Stdio::null()).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    let line = text.lines().find(|line| line.contains("ROS_DOMAIN_ID is")).unwrap();
    assert!(
        line.trim_start().starts_with("problem")
            && line.contains("expected 0 to 232: export ROS_DOMAIN_ID=0"),
        "{line}"
    );
}

#[test]
fn a_file_in_place_of_the_folder_is_one_problem() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("runs");
    std::fs::write(&file, "mine").unwrap();
    let output = trundle(&["doctor", "--out", file.to_str().unwrap()]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("is not a folder, so runs cannot write there: choose another folder by --out"),
        "{text}"
    );
    assert!(!text.contains("1 problems"), "{text}");
}
