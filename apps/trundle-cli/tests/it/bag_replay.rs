//! The bag of a robot with a laser and no camera.

use crate::program::{summary, text, trundle};
use std::path::{Path, PathBuf};
use trundle::core::{Beam, GyroRate, Pose2, Pose3, Scan, Stamp, Vector2};
use trundle::io::{OutputFolder, ros_message};

/// Twelve seconds of a robot that turns once on the spot in a room of 4 x 3 m; `rate` gives the gyro's reading for the true turn rate, `range`
/// that of a beam for its true range.
fn turning_bag(place: &Path, rate: impl Fn(f64) -> f64, range: impl Fn(f64) -> Beam) -> PathBuf {
    let folder = OutputFolder::create(place).unwrap();
    let mut bag = folder.bag("bag.mcap").unwrap();
    let wall = |angle: f64| (2.0 / angle.cos().abs()).min(1.5 / angle.sin().abs());
    for i in 0..600 {
        let stamp = Stamp::from_nanos(1_700_000_000_000_000_000 + i * 20_000_000);
        let heading = 0.52 * 0.02 * i as f64;
        let pose = Pose3::from_pose2(Pose2::new(0.0, 0.0, heading));
        bag.record_message("/odom", stamp, &ros_message::odometry_pose(stamp, "odom", "base_link", pose))
            .unwrap();
        let gyro = GyroRate { stamp, omega: rate(0.52) + 0.001 * (i % 5) as f64 };
        bag.record_message("/imu", stamp, &ros_message::gyro("base_link", &gyro)).unwrap();
        if i % 5 == 0 {
            let beams = (0..180_u8).map(|k| range(wall(heading - 3.0 + 0.03 * f64::from(k)))).collect();
            let scan = Scan::new(stamp, Vector2::zeros(), -3.0, 0.03, beams).unwrap();
            bag.record_message("/scan", stamp, &ros_message::scan("base_link", &scan)).unwrap();
        }
    }
    bag.finish().unwrap();
    folder.commit().unwrap().join("bag.mcap")
}

#[test]
fn a_replay_that_does_not_locate_the_robot_is_no_success() {
    let scratch = tempfile::tempdir().unwrap();
    let place = |name: &str| scratch.path().join(name);
    let hit = |range| Beam::Hit { range };
    let run = |bag: &Path| {
        let output = trundle(&["replay", text(bag), "--quiet", "--out", text(&place("run"))]);
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, message) = run(&turning_bag(&place("good"), |rate| rate, hit));
    assert_eq!(code, Some(0), "{message}");
    assert!(!message.contains("gyro"), "{message}");
    let (code, message) = run(&turning_bag(&place("unseen"), |rate| rate, |_| Beam::Unseen));
    assert_eq!(code, Some(1), "{message}");
    assert!(
        message.contains("matched no scan to its map") || message.contains("no scan showed"),
        "{message}"
    );
    let (_, message) = run(&turning_bag(&place("against"), |rate| -rate, hit));
    assert!(message.contains("/imu: the gyro turns against the odometry over turns of 3"), "{message}");
    let (_, message) = run(&turning_bag(&place("degrees"), f64::to_degrees, hit));
    assert!(message.contains("are its rates in degrees a second?"), "{message}");
}

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

    let slam = trundle(&["slam", text(&file), "--out", text(&place("slam"))]);
    let message = String::from_utf8(slam.stderr).unwrap();
    assert_eq!(slam.status.code(), Some(2));
    assert!(message.contains("scans of a laser, which `trundle map` and `trundle replay` read"), "{message}");

    let lost = bag(&place("lost"), "imu_link");
    let (_, message) = run(&["replay", text(&lost), "--quiet", "--out", text(&one)]);
    let expected = "gyro on /imu: no transform leads from base_link to its frame 'imu_link', expected one on /tf_static; the reading is \
                    left out, 150 times: message ";
    assert!(message.contains(expected), "{message}");
}
