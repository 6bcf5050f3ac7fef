//! Agreement with the PyPI tool `evo` 1.38.1 on TUM trajectories: its numbers are in `data/evo`, with the command lines that made them.

#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use trundle_core::{Pose3, Stamp};
use trundle_eval::*;

/// Largest difference between the two programs: rounding only.
const TOLERANCE: f64 = 1e-6;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The trajectory file, from the project's own data or, for large ones, from the shared data; `None` if absent.
fn trajectory(name: &str) -> Option<Vec<(Stamp, Pose3)>> {
    let folders = ["data/trajectories", "../shared/data/trajectories"];
    let path = folders.iter().map(|folder| root().join(folder).join(name)).find(|path| path.exists())?;
    Some(std::fs::read_to_string(path).unwrap().lines().filter_map(pose).collect())
}

fn pose(line: &str) -> Option<(Stamp, Pose3)> {
    let fields: Vec<&str> = line.split_whitespace().collect();
    if fields.first()?.starts_with('#') {
        return None;
    }
    let (secs, fraction) = fields[0].split_once('.').unwrap();
    let nanos = format!("{secs}{fraction:0<9}").parse().unwrap();
    let numbers: Vec<f64> = fields[1..].iter().map(|f| f.parse().unwrap()).collect();
    Some((Stamp::from_nanos(nanos), Pose3::from(<[f64; 7]>::try_from(numbers).unwrap())))
}

fn same(name: &str, ours: &ErrorStatistics, in_degrees: bool, fixture: &Value) {
    let theirs = &fixture["results"][name];
    let unit = if in_degrees { 180.0 / std::f64::consts::PI } else { 1.0 };
    assert_eq!(Some(ours.count as u64), theirs["count"].as_u64(), "{name}: number of errors");
    for (key, value) in [
        ("rmse", ours.rmse),
        ("mean", ours.mean),
        ("median", ours.median),
        ("std", ours.std),
        ("min", ours.min),
        ("max", ours.max),
    ] {
        let (ours, theirs) = (value * unit, theirs[key].as_f64().expect(key));
        assert!((ours - theirs).abs() < TOLERANCE, "{name} {key}: {ours}, evo has {theirs}");
    }
}

fn agrees_with_evo(fixture: &str) {
    let text = std::fs::read_to_string(root().join("data/evo").join(fixture)).unwrap();
    let fixture: Value = serde_json::from_str(&text).unwrap();
    let name = |key: &str| fixture[key].as_str().unwrap().to_owned();
    let (Some(truth), Some(estimate)) = (trajectory(&name("reference")), trajectory(&name("estimate")))
    else {
        eprintln!("skipped: {} or {} is not here", name("reference"), name("estimate"));
        return;
    };
    for (key, alignment) in [
        ("ape_none", Alignment::None),
        ("ape_rigid", Alignment::Rigid),
        ("ape_similarity", Alignment::Similarity),
    ] {
        let mut config = AbsoluteConfig::default();
        config.alignment = alignment;
        let error = absolute_trajectory_error(&truth, &estimate, &config).unwrap();
        same(key, &error.statistics, false, &fixture);
        if alignment == Alignment::None {
            same("ape_angle_deg", &error.rotation, true, &fixture);
        }
    }
    for (key, delta) in [
        ("rpe_frames_1", Delta::Frames(1)),
        ("rpe_frames_7", Delta::Frames(7)),
        ("rpe_metres", Delta::Metres(0.3)),
    ] {
        let mut config = RelativeConfig::default();
        config.delta = delta;
        let error = relative_pose_error(&truth, &estimate, &config).unwrap();
        same(&format!("{key}_translation"), &error.translation, false, &fixture);
        same(&format!("{key}_angle_deg"), &error.rotation, true, &fixture);
    }
    let mut config = RelativeConfig::default();
    config.delta = Delta::Frames(7);
    config.all_pairs = true;
    let error = relative_pose_error(&truth, &estimate, &config).unwrap();
    same("rpe_frames_7_all_translation", &error.translation, false, &fixture);
}

#[test]
fn agrees_on_rgbdslam_of_freiburg1_xyz() {
    agrees_with_evo("fr1_xyz_rgbdslam.json");
}

#[test]
fn agrees_on_a_drifting_and_turned_estimate() {
    agrees_with_evo("fr1_xyz_rgbdslam_drift.json");
}

#[test]
fn agrees_on_a_monocular_estimate_without_scale() {
    agrees_with_evo("fr1_xyz_orb_kf_mono.json");
}

#[test]
fn agrees_on_freiburg2_desk() {
    agrees_with_evo("fr2_desk_orb.json");
}
