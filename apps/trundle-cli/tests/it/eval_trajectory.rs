//! Evaluation of trajectories: the numbers of the PyPI tool evo, and the files of the folder.

use crate::program::{refusal, summary, text, trundle};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name)
}

fn evaluated(options: &[&str]) -> Value {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("eval");
    let (reference, estimate) =
        (data("trajectories/freiburg1_xyz-groundtruth.txt"), data("trajectories/freiburg1_xyz-rgbdslam.txt"));
    let args = ["eval", "trajectory", text(&reference), text(&estimate), "--out", text(&out)];
    let output = trundle(&[&args[..], options].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["report.html", "trajectory.png", "ate.svg", "rpe.svg", "aligned.txt"] {
        assert!(out.join(name).metadata().unwrap().len() > 100, "{name}");
    }
    summary(&out)
}

#[test]
fn the_numbers_are_those_of_evo() {
    let fixture = std::fs::read_to_string(data("evo/fr1_xyz_rgbdslam.json")).unwrap();
    let evo: Value = serde_json::from_str(&fixture).unwrap();
    let radians = |degrees: &Value| degrees.as_f64().unwrap().to_radians();
    let rmse = |name: &str| evo["results"][name]["rmse"].clone();
    let same = |ours: &Value, theirs: f64| {
        let ours = ours["rmse"].as_f64().unwrap();
        assert!((ours - theirs).abs() < 1e-9, "{ours}, evo has {theirs}");
    };
    let rigid = evaluated(&["--delta", "7"]);
    same(&rigid["ate_translation_m"], rmse("ape_rigid").as_f64().unwrap());
    same(&rigid["rpe_translation_m"], rmse("rpe_frames_7_translation").as_f64().unwrap());
    same(&rigid["rpe_rotation_rad"], radians(&rmse("rpe_frames_7_angle_deg")));
    let scaled = evaluated(&["--align", "sim3", "--delta", "0.3", "--unit", "m"]);
    same(&scaled["ate_translation_m"], rmse("ape_similarity").as_f64().unwrap());
    same(&scaled["rpe_translation_m"], rmse("rpe_metres_translation").as_f64().unwrap());
    let placed = evaluated(&["--align", "none"]);
    same(&placed["ate_translation_m"], rmse("ape_none").as_f64().unwrap());
    same(&placed["ate_rotation_rad"], radians(&rmse("ape_angle_deg")));
}

#[test]
fn line_ends_of_old_mac_programs_are_read() {
    let scratch = tempfile::tempdir().unwrap();
    let reference = data("trajectories/freiburg1_xyz-groundtruth.txt");
    let mac = scratch.path().join("mac.txt");
    std::fs::write(&mac, std::fs::read_to_string(&reference).unwrap().replace('\n', "\r")).unwrap();
    let output = trundle(&["eval", "trajectory", text(&reference), text(&mac)]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn poses_without_stamps_of_their_own_and_short_trajectories_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let (rounded, short) = (scratch.path().join("rounded.txt"), scratch.path().join("short.txt"));
    let lines = |stamp: fn(i32) -> f64| -> String {
        (0..40).map(|i| format!("{} {} 0 0 0 0 0 1\n", stamp(i), f64::from(i) * 0.01)).collect()
    };
    std::fs::write(&rounded, lines(|i| f64::from(i / 20))).unwrap();
    std::fs::write(&short, lines(|i| f64::from(i) * 0.1)).unwrap();
    for which in ["relations", "trajectory"] {
        let sentence = refusal(&["eval", which, text(&rounded), text(&rounded)]);
        assert!(
            sentence.contains("rounded.txt: 38 of 40 poses have the timestamp of the pose before"),
            "{sentence}"
        );
    }
    let sentence = refusal(&["eval", "relations", text(&short), text(&short)]);
    assert!(sentence.contains("its path is 0.39 m long"), "{sentence}");
}

#[test]
fn inputs_that_cannot_be_evaluated_are_named() {
    let scratch = tempfile::tempdir().unwrap();
    let (a, b) = (scratch.path().join("a.txt"), scratch.path().join("b.txt"));
    std::fs::write(&a, "1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0 1\n").unwrap();
    std::fs::write(&b, "101.0 0 0 0 0 0 0 1\n102.0 1 0 0 0 0 0 1\n").unwrap();
    let apart = refusal(&["eval", "trajectory", text(&a), text(&b)]);
    assert!(apart.contains("a.txt") && apart.contains("b.txt"), "{apart}");
    assert!(refusal(&["eval", "trajectory", text(&a), text(&a)]).contains("3"), "two poses");
    let half = refusal(&["eval", "trajectory", text(&a), text(&a), "--delta", "0.5"]);
    assert!(half.contains("delta is 0.5 frames, expected a whole number"), "{half}");
}
