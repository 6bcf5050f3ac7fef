//! `trundle slam` on a drive through the dark: all frames get a pose, and missing frames are reported.

use crate::program::{summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};

/// A drive of 13 s in a room; the robot spins in the dark from 2 to 10 s, and then sees another part of the room.
fn dark_drive(scratch: &Path) -> PathBuf {
    let file = |name: &str, content: &str| {
        let path = scratch.join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let scene = file(
        "scene.toml",
        "[base]\nscene = \"room\"\nseed = 7\n[robot]\nstart = { x = 0.0, y = 0.0, heading_deg = 0 }\n",
    );
    let drive = file("drive.txt", "0 0.2 0\n2 0.15 2.8\n10 0.1 0\n13 0 0\n");
    let dark = file("faults.toml", "[[faults]]\nfrom_s = 2.0\nto_s = 10.0\nkind = \"camera-black\"\n");
    let data = scratch.join("data");
    let [scene, drive, dark, record] = [&scene, &drive, &dark, &data].map(|path| text(path));
    let output = trundle(&["sim", scene, "--quiet", "--drive", drive, "--faults", dark, "--record", record]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    data
}

/// Exit code and summary of tracking `data`, with more arguments.
fn track(data: &Path, out: &Path, extra: &[&str]) -> (Option<i32>, serde_json::Value) {
    let mut args = vec!["slam", text(data), "--quiet", "--height=0.45", "--tilt=8", "--out", text(out)];
    args.extend(extra);
    (trundle(&args).status.code(), summary(out))
}

#[test]
fn frames_in_the_dark_are_placed_by_odometry_and_missing_ones_are_reported() {
    let scratch = tempfile::tempdir().unwrap();
    let data = dark_drive(scratch.path());
    let [fused, visual, bare] = ["fused", "visual", "bare"].map(|name| scratch.path().join(name));
    let (code, numbers) = track(&data, &fused, &["--record", "none"]);
    assert_eq!((code, &numbers["frames_without_pose"]), (Some(0), &0.into()), "{numbers}");
    assert_eq!(numbers["trajectory"], "fused");
    assert_eq!(numbers["frames_posed"], numbers["frames"]);
    let [all, by_images, by_odometry] =
        ["frames_posed", "frames_posed_by_images", "frames_posed_by_odometry"]
            .map(|name| numbers[name].as_u64().unwrap());
    assert!(all == by_images + by_odometry && 2 * by_odometry > all, "{numbers}");
    assert!(numbers["ate_rmse_m"].as_f64().unwrap() < 0.05, "{numbers}");
    assert!(!fused.join("recording.mcap").exists());

    // Images of the dark alone: all poses are of odometry.
    let black = scratch.path().join("black");
    let lists = ["rgb.txt", "depth.txt"].map(|name| data.join(name));
    let whole = lists.clone().map(|list| fs::read_to_string(list).unwrap());
    for (list, text) in lists.iter().zip(&whole) {
        let is_dark = |line: &&str| line.starts_with(['4', '5', '6', '7']);
        fs::write(list, text.lines().filter(is_dark).map(|line| format!("{line}\n")).collect::<String>())
            .unwrap();
    }
    let (code, numbers) = track(&data, &black, &["--record", "none"]);
    assert_eq!((code, &numbers["frames_posed_by_images"]), (Some(1), &0.into()), "{numbers}");
    assert_eq!(numbers["frames_posed_by_odometry"], numbers["frames"], "{numbers}");
    lists.iter().zip(&whole).for_each(|(list, text)| fs::write(list, text).unwrap());

    // The last visual map alone holds the frames after the dark.
    let (code, numbers) = track(&data, &visual, &["--visual-only", "--record", "events"]);
    assert_eq!((code, &numbers["trajectory"]), (Some(1), &"visual".into()), "{numbers}");
    assert!(numbers["missing_share"].as_f64().unwrap() > 0.5, "{numbers}");
    assert!(fs::metadata(visual.join("recording.mcap")).unwrap().len() < 1_000_000, "without images");

    // Without odometry nothing places them.
    fs::remove_file(data.join("odometry.txt")).unwrap();
    let (code, numbers) = track(&data, &bare, &["--record", "none"]);
    assert_eq!((code, &numbers["trajectory"]), (Some(1), &"visual".into()), "{numbers}");
    assert!(numbers["failure"].as_str().unwrap().contains("frames have no pose"), "{numbers}");
}

#[test]
fn settings_of_a_robot_file_count_and_wrong_ones_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let data = dark_drive(scratch.path());
    let out = scratch.path().join("out");
    let (_, numbers) = track(&data, &out, &["--record=none", "--set", "slam.orb.features=300"]);
    let (_, default) = track(&data, &out, &["--record=none"]);
    let landmarks = [&numbers, &default].map(|run| run["landmarks"].as_u64().unwrap());
    assert!(2 * landmarks[0] < landmarks[1], "{landmarks:?}: 300 features an image in place of 1000");
    let output = trundle(&["slam", text(&data), "--set", "slam.tracking.patient=2", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("patient"));
}
