//! `trundle sim`: recordings, way-points, maps, and determinism.

use crate::program::{refusal, summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A file in `folder`.
fn file(folder: &Path, name: &str, content: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

/// All files below a folder, with their bytes, by name.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(contents(&path));
        } else {
            found.push((path.clone(), fs::read(path).unwrap()));
        }
    }
    found.sort();
    found
}

/// Records a short drive in the demo room; `extra` arguments go to `trundle sim`.
fn record(folder: &Path, name: &str, threads: &str, extra: &[&str]) -> PathBuf {
    let drive = file(folder, "drive.txt", "# t v omega\n0 0.3 0.2\n1.5 0.2 -0.3\n2.4 0 0\n");
    let out = folder.join(name);
    let output = Command::new(env!("CARGO_BIN_EXE_trundle"))
        .env("RAYON_NUM_THREADS", threads)
        .args(["sim", "demo", "--quiet", "--drive", text(&drive), "--record", text(&out)])
        .args(extra)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    out
}

/// A recording is tracked without options: its own camera, odometry as prior, evaluated against its own ground truth.
#[test]
fn a_recorded_drive_is_read_by_slam_as_it_is() {
    let scratch = tempfile::tempdir().unwrap();
    let data = record(scratch.path(), "data", "2", &["--rate", "10"]);
    let numbers = summary(&data);
    assert_eq!((numbers["images"].as_u64(), numbers["contacts"].as_u64()), (Some(24), Some(0)), "{numbers}");
    let driven = numbers["path_length_m"].as_f64().unwrap();
    assert!((0.4..0.7).contains(&driven), "{driven} m");
    for name in
        ["groundtruth.txt", "associations.txt", "orb_slam.yaml", "camera.toml", "map.yaml", "overview.png"]
    {
        assert!(fs::metadata(data.join(name)).unwrap().len() > 20, "{name}");
    }
    let out = scratch.path().join("slam");
    let output = trundle(&["slam", text(&data), "--quiet", "--height=0.45", "--tilt=8", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&out);
    assert_eq!(numbers["frames_ok"], 24, "{numbers}");
    assert!(numbers["ate_rmse_m"].as_f64().unwrap() < 0.02, "{numbers}");
}

#[test]
fn the_same_command_gives_the_same_bytes_on_any_number_of_threads() {
    let scratch = tempfile::tempdir().unwrap();
    let extra = ["--rate", "5", "--duration", "1"];
    let one = contents(&record(scratch.path(), "one", "1", &extra));
    let two = contents(&record(scratch.path(), "two", "2", &extra));
    assert_eq!(one.len(), two.len());
    assert!(one.len() > 15);
    for ((a, bytes), (b, others)) in one.iter().zip(&two) {
        assert_eq!(a.file_name(), b.file_name());
        assert!(bytes == others, "{} differs", a.display());
    }
}

#[test]
fn way_points_are_reached_and_one_in_a_wall_is_not() {
    let scratch = tempfile::tempdir().unwrap();
    let trajectory = file(scratch.path(), "way.txt", "1.0 0.9 30\n");
    let output = trundle(&["sim", "obstacles", "--follow", text(&trajectory), "--rate", "0.5"]);
    let message = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{message}");
    assert!(message.contains("every way-point reached") && message.contains("1 of 1"), "{message}");
    let wall = file(scratch.path(), "wall.txt", "0.9 0.8 30\n-2 0.8 180\n");
    let args = ["sim", "obstacles", "--rate", "0.5", "--duration", "6", "--follow"];
    let output = trundle(&[&args[..], &[text(&wall)]].concat());
    let message = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("way-point 2 of 2 not reached"), "{message}");
}

#[test]
fn the_true_map_is_written_alone_and_read_again() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scratch.path().join("deep/room.yaml");
    let args = ["sim", "obstacles", "--resolution", "0.1", "--band", "0.05", "0.6", "--map", text(&map)];
    let output = trundle(&args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let planned = scratch.path().join("plan");
    let output = trundle(&[
        "plan",
        text(&map),
        "--from=0.7,0.7,45",
        "--to=5.3,5.2,90",
        "--quiet",
        "--out",
        text(&planned),
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_scenes_are_listed() {
    let message = String::from_utf8(trundle(&["sim", "--list"]).stdout).unwrap();
    for name in ["room", "obstacles", "corridor-d", "office", "house", "warehouse"] {
        assert!(
            message.lines().any(|line| line.trim().starts_with(name) && line.ends_with(" m")),
            "{message}"
        );
    }
}

#[test]
fn scenes_that_are_none() {
    let sentence = refusal(&["sim", "moon"]);
    assert!(sentence.contains("scene is moon, expected one of demo, room, obstacles"), "{sentence}");
    let sentence = refusal(&["sim"]);
    assert!(sentence.contains("[SCENE]") || sentence.contains("<SCENE>"), "{sentence}");
}

#[test]
fn drives_that_are_none() {
    let scratch = tempfile::tempdir().unwrap();
    let drive = |option: &str, content: &str| {
        let path = file(scratch.path(), "way.txt", content);
        refusal(&["sim", "demo", option, text(&path)])
    };
    for (option, content, words) in [
        ("--drive", "0 0.1 0\n1 NaN 0\n", "way.txt: v in line 2 is NaN, expected a finite number"),
        ("--drive", "0 0.1 0\n2 0 0\n1 0 0\n", "way.txt: t in line 3 is 1 s, expected more than 2"),
        ("--drive", "0 0.1\n", "way.txt: line 1 is '0 0.1', expected 3 numbers: t v omega"),
        ("--drive", "# nothing\n", "way.txt: lines of commands is 0, expected 1 or more"),
        ("--follow", "1 1 0\n1 inf 0\n", "way.txt: y in line 2 is inf, expected a finite number"),
        ("--follow", "", "way.txt: way-points is 0, expected 1 or more"),
    ] {
        let sentence = drive(option, content);
        assert!(sentence.trim_end().ends_with(words), "{sentence}");
    }
    let sentence = refusal(&["sim", "demo", "--drive", "nowhere.txt"]);
    assert!(sentence.contains("cannot read nowhere.txt: it does not exist"), "{sentence}");
    let sentence = refusal(&["sim", "demo", "--drive", "a.txt", "--follow", "b.txt"]);
    assert!(sentence.contains("'--drive <FILE>' cannot be used with '--follow <FILE>'"), "{sentence}");
}

#[test]
fn numbers_and_places_that_cannot_be() {
    let scratch = tempfile::tempdir().unwrap();
    for (args, words) in [
        (["--duration", "-3"], "--duration is -3 s, expected a number in s, above 0 and at most 1000000"),
        (["--duration", "NaN"], "--duration is 'NaN', expected a number in s"),
        (["--rate", "0"], "--rate is 0 Hz, expected a number in Hz, above 0"),
        (["--rate", "1000"], "camera_rate_hz is 1000 Hz"),
        (["--map", "picture.png"], "picture.png: expected a map file whose name ends in .yaml"),
    ] {
        let sentence = refusal(&[&["sim", "demo"], &args[..]].concat());
        assert!(sentence.contains(words), "{sentence}");
    }
    let map = scratch.path().join("map.yaml");
    let sentence = refusal(&["sim", "demo", "--resolution", "0.0001", "--map", text(&map)]);
    assert!(sentence.contains("--resolution is 0.0001 m, expected a number in m, 0.001 to 2"), "{sentence}");
    let sentence = refusal(&["sim", "demo", "--band", "0.5", "0.2", "--map", text(&map)]);
    assert!(sentence.contains("high end of the height band is 0.2 m, expected more than 0.5"), "{sentence}");
    let taken = file(scratch.path(), "taken", "mine");
    let sentence = refusal(&["sim", "demo", "--record", text(&taken)]);
    assert!(sentence.contains("taken: this is a file, expected a folder"), "{sentence}");
    assert_eq!(fs::read_to_string(taken).unwrap(), "mine");
    file(scratch.path(), "rgb.txt", "# timestamp filename");
    let sentence = refusal(&["sim", "demo", "--record", text(scratch.path())]);
    assert!(sentence.contains("files that trundle did not write there"), "{sentence}");
    assert!(scratch.path().join("rgb.txt").exists());
    let sentence = refusal(&["sim", "room", "--start=100,0,0", "--duration", "0.1"]);
    assert!(
        sentence.contains("start at (100.000, 0.000) m is outside scene 'room', which reaches from (-3."),
        "{sentence}"
    );
}

/// The example in the scene file's documentation.
#[test]
fn the_documented_scene_file_runs_for_as_long_as_asked() {
    let scratch = tempfile::tempdir().unwrap();
    let formats = include_str!("../../../../docs/formats.md");
    let (_, rest) = formats.split_once("## Scene files").unwrap();
    let (example, _) = rest.split_once("```toml").unwrap().1.split_once("```").unwrap();
    let scene = file(scratch.path(), "office.toml", example);
    let out = scratch.path().join("out");
    let output = trundle(&["sim", text(&scene), "--rate", "0.5", "--duration", "6", "--record", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found = summary(&out);
    assert_eq!(found["scene"], "crowded office");
    assert!(found["duration_s"].as_f64().unwrap() > 5.9, "{found}");
}

#[test]
fn keys_need_a_keyboard() {
    let sentence = refusal(&["sim", "demo", "--keys"]);
    assert!(
        sentence.contains("--keys reads the keyboard, but standard input is not a terminal"),
        "{sentence}"
    );
}
