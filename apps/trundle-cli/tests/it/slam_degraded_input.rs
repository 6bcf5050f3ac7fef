//! Difficult input of a robot with wheels: it turns too fast for the camera, is in the dark, or faces an untextured surface. SLAM is never
//! lost, and its pose is right one second after the view is back.

use crate::program::{summary, text, trundle};
use std::fs;
use std::path::Path;
use trundle::core::{Pose3, Stamp};
use trundle::io::read_trajectory;

/// A scene, a drive, what breaks, and when the view is back for a second, s.
struct BadDay<'a> {
    scene: &'a str,
    drive: &'static str,
    faults: Option<&'static str>,
    /// From when on the pose is evaluated again, s.
    judged_from: f64,
}

/// The pose at the first stamp that is no earlier than `at` (s).
fn pose_at(trajectory: &[(Stamp, Pose3)], at: f64) -> Pose3 {
    trajectory.iter().find(|(stamp, _)| stamp.as_secs() >= at - 1e-6).unwrap().1
}

/// Drives, tracks, and evaluates each frame from `judged_from` on by its motion since the first frame.
fn live_through(day: &BadDay) {
    let scratch = tempfile::tempdir().unwrap();
    let file = |name: &str, content: &str| {
        let path = scratch.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let (scene, drive) = (file("scene.toml", day.scene), file("drive.txt", day.drive));
    let faults = day.faults.map(|faults| file("faults.toml", faults));
    let (data, out) = (scratch.path().join("data"), scratch.path().join("out"));
    let mut args = vec!["sim", text(&scene), "--quiet", "--drive", text(&drive), "--record", text(&data)];
    args.extend(faults.iter().flat_map(|faults| ["--faults", text(faults)]));
    let output = trundle(&args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = trundle(&["slam", text(&data), "--quiet", "--height=0.45", "--tilt=8", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = summary(&out);
    assert_eq!(numbers["frames_lost"], 0, "{numbers}");
    judge(&data, &out, day.judged_from);
}

fn judge(data: &Path, out: &Path, from: f64) {
    let truth = read_trajectory(&data.join("groundtruth.txt")).unwrap();
    let found = read_trajectory(&out.join("trajectory.txt")).unwrap();
    let first = found[0].0.as_secs();
    let (found_first, true_first) = (found[0].1.inverse(), pose_at(&truth, first).inverse());
    let judged: Vec<_> = found.iter().filter(|(stamp, _)| stamp.as_secs() >= from).collect();
    assert!(judged.len() >= 5, "{} frames after {from} s", judged.len());
    for (stamp, pose) in judged {
        let error = (true_first * pose_at(&truth, stamp.as_secs())).inverse() * (found_first * *pose);
        let (off, turned) = (error.translation.norm(), error.angle().to_degrees());
        assert!(off < 0.03 && turned < 1.0, "at {stamp}: {:.1} cm, {turned:.2} deg", off * 100.0);
    }
}

const ROOM: &str =
    "[base]\nscene = \"room\"\nseed = 7\n[robot]\nstart = { x = 0.0, y = 0.0, heading_deg = 0 }\n";

#[test]
fn turns_on_the_spot_at_180_degrees_a_second() {
    live_through(&BadDay {
        scene: ROOM,
        drive: "0 0.2 0\n1 0 3.14\n5 0 0\n6.7 0 0\n",
        faults: None,
        judged_from: 6.2,
    });
}

#[test]
fn three_seconds_of_darkness_while_driving() {
    live_through(&BadDay {
        scene: ROOM,
        drive: "0 0.3 0.1\n2 0.3 0.25\n5 0.2 -0.3\n7 0 0\n",
        faults: Some("[[faults]]\nfrom_s = 2.0\nto_s = 5.0\nkind = \"camera-black\"\n"),
        judged_from: 6.0,
    });
}

#[test]
fn a_blank_wall_at_one_metre_for_five_seconds() {
    let wall = "[[props]]\nkind = \"box\"\nx = 0.2\ny = -1.05\nsize = [3.0, 0.1, 2.4]\npaint = \"flat\"\ncolor = [200, 200, 196]\n";
    live_through(&BadDay {
        scene: &format!("{ROOM}{wall}"),
        drive: "0 0.2 0\n1 0 -1.5707963\n2 0.05 0\n3.5 -0.05 0\n5 0 0.2\n6 0 -0.2\n7 0 1.5707963\n8 0.1 0\n9.7 0 0\n",
        faults: None,
        judged_from: 9.0,
    });
}
