//! The bag of a robot with a laser and no camera.

use crate::program::{summary, text, trundle};
use std::path::{Path, PathBuf};
use trundle::core::{Beam, GyroRate, Pose3, Scan, Stamp, Vector2};
use trundle::io::{OutputFolder, ros_message};

/// Three seconds of a robot that stands in the middle of a round room; its IMU is in the frame `imu`.
fn bag(place: &Path, imu: &str) -> PathBuf {
    let folder = OutputFolder::create(place).unwrap();
    let mut bag = folder.bag("bag.mcap").unwrap();
    let scan = |stamp| {
        let ranges = (0..180_u8).map(|i| Beam::Hit { range: if i < 20 { 1.5 } else { 2.0 } }).collect();
        Scan::new(stamp, Vector2::zeros(), -3.0, 0.03, ranges).unwrap()
    };
    for i in 0..150 {
        let stamp = Stamp::from_nanos(1_700_000_000_000_000_000 + i * 20_000_000);
        let odometry = ros_message::odometry_pose(stamp, "odom", "base_link", Pose3::identity());
        bag.record_message("/odom", stamp, &odometry).unwrap();
        let gyro = ros_message::gyro(imu, &GyroRate { stamp, omega: 0.001 * (i % 5) as f64 });
        bag.record_message("/imu", stamp, &gyro).unwrap();
        if i % 5 == 0 {
            bag.record_message("/scan", stamp, &ros_message::scan("base_link", &scan(stamp))).unwrap();
        }
    }
    bag.finish().unwrap();
    folder.commit().unwrap().join("bag.mcap")
}

#[test]
fn a_bag_with_a_laser_is_listed_replayed_and_recorded() {
    let scratch = tempfile::tempdir().unwrap();
    let place = |name: &str| scratch.path().join(name);
    let file = bag(&place("bag"), "base_link");
    let run = |arguments: &[&str]| {
        let output = trundle(arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments:?}: {message}");
        (String::from_utf8(output.stdout).unwrap(), message)
    };
    let (list, _) = run(&["convert", text(&file), "--list"]);
    let used =
        |topic: &str| list.lines().map(str::trim).find(|line| line.starts_with(topic)).unwrap().to_owned();
    assert!(used("/imu").ends_with("gyro") && used("/odom").ends_with("odometry"), "{list}");
    assert!(used("/scan").ends_with("laser"), "{list}");

    let (one, two) = (place("one"), place("two"));
    let (_, message) = run(&["replay", text(&file), "--quiet", "--out", text(&one)]);
    assert!(!message.contains("left out"), "{message}");
    assert!(one.join("map.yaml").exists());
    let recording = place("recording");
    run(&["convert", text(&file), text(&recording), "--to", "recording", "--quiet"]);
    run(&["replay", text(&recording.join("recording.mcap")), "--quiet", "--out", text(&two)]);
    let picture = |folder: &Path| std::fs::read(folder.join("map.pgm")).unwrap();
    assert_eq!(picture(&one), picture(&two));
    assert_eq!(summary(&one)["duration_s"], summary(&two)["duration_s"]);

    let lost = bag(&place("lost"), "imu_link");
    let (_, message) = run(&["replay", text(&lost), "--quiet", "--out", text(&one)]);
    let expected = "gyro on /imu: no transform leads from base_link to its frame 'imu_link', expected one on /tf_static; the reading is \
                    left out, 150 times: message ";
    assert!(message.contains(expected), "{message}");
}
