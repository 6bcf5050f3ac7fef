//! Gyro and laser of ROS bags, for a robot.

use nalgebra::UnitQuaternion;
use std::io::Cursor;
use std::path::Path;
use tempfile::NamedTempFile;
use trundle_core::{Beam, BeamTimes, GyroRate, Pose3, Scan, Stamp, Vector2, Vector3};
use trundle_io::ros_message::RosMessage;
use trundle_io::*;

/// A message, its topic and its time, ms.
type Line = (i64, &'static str, RosMessage);

fn stamp(millis: i64) -> Stamp {
    Stamp::from_nanos(1_700_000_000_000_000_000 + millis * 1_000_000)
}

fn at(x: f64, roll: f64) -> Pose3 {
    Pose3::new(UnitQuaternion::from_euler_angles(roll, 0.0, 0.0), Vector3::new(x, 0.0, 0.1))
}

fn odometry(ms: i64) -> Line {
    let pose = at(ms as f64 * 1e-3, 0.0);
    (ms, "/odom", ros_message::odometry_pose(stamp(ms), "odom", "base_link", pose))
}

fn gyro(ms: i64, frame: &str, omega: f64) -> Line {
    (ms, "/imu", ros_message::gyro(frame, &GyroRate { stamp: stamp(ms), omega }))
}

fn scan_of(ms: i64, frame: &str, count: usize) -> RosMessage {
    let beams = vec![Beam::Hit { range: 2.0 }; count];
    let scan = Scan::new(stamp(ms), Vector2::zeros(), -0.5, 0.25, beams).unwrap();
    ros_message::scan(frame, &scan)
}

fn scan(ms: i64, frame: &str, count: usize) -> Line {
    (ms, "/scan", scan_of(ms, frame, count))
}

/// An IMU upside down and a laser 0.2 m ahead.
fn mounts() -> Line {
    let stamp = stamp(0);
    let links = [
        (stamp, "base_link", "imu", at(0.0, std::f64::consts::PI)),
        (stamp, "base_link", "laser", at(0.2, 0.0)),
    ];
    (0, "/tf_static", ros_message::transforms(&links))
}

/// One second of odometry, gyro and scans.
fn lines() -> Vec<Line> {
    let mut lines = vec![mounts()];
    for ms in (0..=1000).step_by(50) {
        lines.extend([odometry(ms), gyro(ms, "imu", 0.5)]);
        if ms % 100 == 0 {
            lines.push(scan(ms, "laser", 5));
        }
    }
    lines
}

fn bag(lines: &[Line]) -> NamedTempFile {
    let mut bag = Recorder::bag(Cursor::new(Vec::new()), Path::new("a.mcap")).unwrap();
    for (ms, topic, message) in lines {
        bag.record_message(topic, stamp(*ms), message).unwrap();
    }
    let file = NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bag.finish().unwrap().into_inner()).unwrap();
    file
}

fn for_robot() -> RosSequenceOptions {
    let mut options = RosSequenceOptions::default();
    options.is_for_robot = true;
    options
}

fn open_with(lines: &[Line], options: &RosSequenceOptions) -> Result<RosSequence, String> {
    let file = bag(lines);
    let named = |error: IoError| error.to_string().replace(&file.path().display().to_string(), "BAG");
    RosSequence::open(file.path(), options, true).map_err(named)
}

fn open(lines: &[Line]) -> RosSequence {
    open_with(lines, &for_robot()).unwrap()
}

fn warnings(sequence: &RosSequence) -> Vec<String> {
    sequence.warnings().iter().map(ToString::to_string).collect()
}

#[test]
fn gyro_and_scans_are_in_the_frame_of_the_base() {
    let sequence = open(&lines());
    assert!(sequence.is_empty() && sequence.camera().is_none(), "no images");
    assert_eq!(warnings(&sequence), Vec::<String>::new());
    let uses: Vec<_> = sequence.topics().uses().collect();
    assert_eq!(uses, [("odometry", "/odom"), ("gyro", "/imu"), ("laser", "/scan")]);
    assert_eq!(sequence.topics().to_string(), "odometry on /odom, gyro on /imu, laser on /scan");
    assert_eq!(sequence.gyro().len(), 21);
    assert!((sequence.gyro()[20].omega + 0.5).abs() < 1e-12, "the IMU is upside down");
    let times: Vec<_> = sequence.scan_times().collect();
    assert_eq!((times.len(), times[10]), (11, (stamp(1000), stamp(1000))));
    let scan = sequence.scan(10).unwrap();
    assert_eq!((scan.stamp(), scan.origin()), (stamp(1000), Vector2::new(0.2, 0.0)));
    assert!(scan.hits().count() == 5 && sequence.scan(11).is_none());
}

#[test]
fn a_sweep_keeps_free_ranges_and_the_times_of_its_beams() {
    let beams = vec![Beam::Hit { range: 2.0 }, Beam::Unseen, Beam::Free { range: 8.0 }];
    let written = Scan::new(stamp(500), Vector2::zeros(), -0.5, 0.25, beams).unwrap();
    for step_s in [0.0, 0.125, -0.125] {
        let times = BeamTimes { first_s: if step_s < 0.0 { 0.25 } else { 0.0 }, step_s };
        let written = written.clone();
        let written = if step_s == 0.0 { written } else { written.with_beam_times(times).unwrap() };
        let mut lines = lines();
        lines.retain(|line| line.1 != "/scan");
        lines.push((500, "/scan", ros_message::sweep("laser", &written)));
        let read = open(&lines).scan(0).unwrap();
        assert_eq!((read.stamp(), read.beams()), (written.stamp(), written.beams()));
        assert_eq!((read.angle(0), read.angle(2), read.beam_times()), (-0.5, 0.0, written.beam_times()));
    }
}

#[test]
fn a_bag_without_images_is_for_a_robot_only() {
    let problem = open_with(&lines(), &RosSequenceOptions::default()).err().unwrap();
    assert!(problem.starts_with("BAG: no colour images, expected some"), "{problem}");
    let mut named = for_robot();
    named.color_topic = Some("/color".to_owned());
    let problem = open_with(&lines(), &named).err().unwrap();
    assert!(problem.starts_with("BAG: no colour images on /color"), "{problem}");
    let no_laser: Vec<Line> = lines().into_iter().filter(|line| line.1 != "/scan").collect();
    let problem = open_with(&no_laser, &for_robot()).err().unwrap();
    assert!(problem.ends_with("no usable scans of a laser, expected images or scans"), "{problem}");
    let no_odometry: Vec<Line> = lines().into_iter().filter(|line| line.1 != "/odom").collect();
    let problem = open_with(&no_odometry, &for_robot()).err().unwrap();
    assert!(problem.contains("no odometry beside the scans of a laser"), "{problem}");
    let unmounted: Vec<Line> = lines().into_iter().filter(|line| line.1 != "/tf_static").collect();
    let problem = open_with(&unmounted, &for_robot()).err().unwrap();
    assert!(
        problem.contains("laser on /scan: no transform leads from base_link to its frame 'laser'"),
        "{problem}"
    );
}

#[test]
fn a_topic_can_be_requested_and_the_most_usable_one_is_taken_otherwise() {
    let mut two = lines();
    for ms in (0..=1000).step_by(10) {
        two.push((
            ms,
            "/camera/imu",
            ros_message::gyro("nowhere", &GyroRate { stamp: stamp(ms), omega: 0.1 }),
        ));
        two.push((ms, "/scan_rear", scan_of(ms, "nowhere", 5)));
    }
    two.sort_by_key(|line| line.0);
    let sequence = open(&two);
    assert_eq!((sequence.topics().imu.as_str(), sequence.topics().scans.as_str()), ("/imu", "/scan"));
    let mut asked = for_robot();
    asked.imu_topic = Some("camera/imu".to_owned());
    let sequence = open_with(&two, &asked).unwrap();
    assert_eq!((sequence.topics().imu.as_str(), sequence.gyro().len()), ("", 0));
    assert!(warnings(&sequence).iter().any(|text| text.starts_with(
        "gyro on /camera/imu: no transform leads from base_link to its frame 'nowhere', expected one on /tf_static; \
         the reading is left out, 101 times: message "
    )));
    asked.imu_topic = Some("/odom".to_owned());
    let problem = open_with(&two, &asked).err().unwrap();
    assert_eq!(
        problem,
        "BAG: no sensor_msgs/msg/Imu on /odom, expected one of: /camera/imu (101), /imu (21)"
    );
    let mut asked = for_robot();
    asked.scan_topic = Some("/laser".to_owned());
    let problem = open_with(&two, &asked).err().unwrap();
    assert!(
        problem.contains("no sensor_msgs/msg/LaserScan on /laser, expected one of: /scan (11)"),
        "{problem}"
    );
}

#[test]
fn each_kind_of_bad_reading_is_one_warning() {
    let mut bad = lines();
    let year = 31_557_600_000;
    bad.extend([gyro(1010, "imu", f64::NAN), gyro(1020, "imu", f64::NAN), gyro(1030, "imu", f64::INFINITY)]);
    bad.extend([gyro(1040, "lost", 0.5), gyro(1050 + year, "imu", 0.5), gyro(500, "imu", 0.5)]);
    bad.extend([scan(1010 - year, "laser", 5), scan(1020, "lost", 5), scan(1030, "laser", 9)]);
    let mut cut = bag(&bad);
    let sequence = RosSequence::open(cut.path(), &for_robot(), true).unwrap();
    let all = warnings(&sequence).join("\n");
    for expected in [
        "gyro on /imu: angular_velocity.z is NaN rad/s, expected a finite number; the reading is left out, 2 times: message ",
        "gyro on /imu: no transform leads from base_link to its frame 'lost', expected one on /tf_static; the reading is left out: ",
        "expected one clock for both; the reading is left out: message ",
        "gyro on /imu: time goes back from 1700000001.000000000 s to 1700000000.500000000 s; the reading is left out: ",
        "expected one clock for both; the scan is left out: message ",
        "laser on /scan: no transform leads from base_link to its frame 'lost', expected one on /tf_static; the scan is left out: ",
        "laser on /scan: the number of ranges changes from 5 to 9, expected one number; all are used: message ",
    ] {
        assert!(all.contains(expected), "{expected}\n{all}");
    }
    assert_eq!((sequence.gyro().len(), sequence.scan_times().count()), (21, 12), "{all}");
    let bytes = std::fs::read(cut.path()).unwrap();
    for end in (0..bytes.len()).step_by(97) {
        std::fs::write(cut.path(), &bytes[..end]).unwrap();
        let _ = RosSequence::open(cut.path(), &for_robot(), true);
    }
    cut = bag(&[]);
    assert!(RosSequence::open(cut.path(), &for_robot(), true).is_err());
}

#[test]
fn an_imu_of_another_clock_or_without_a_gyro_is_left_out() {
    let year = 31_557_600_000;
    let with = |imu: &dyn Fn(i64) -> Line| {
        let mut all: Vec<Line> = lines().into_iter().filter(|line| line.1 != "/imu").collect();
        all.extend((0..=1000).step_by(10).map(imu));
        open(&all)
    };
    let sequence = with(&|ms| gyro(ms + year, "imu", 0.5));
    let all = warnings(&sequence);
    assert!(sequence.gyro().is_empty() && sequence.topics().imu.is_empty());
    assert!(
        all.len() == 1 && all[0].contains("expected one clock for both; the reading is left out, 101 times"),
        "{all:?}"
    );
    let sequence = with(&|ms| gyro(ms, "imu", 0.0));
    let expected =
        "gyro on /imu: all 101 turn rates are 0 0 0 rad/s, expected those of a gyro; the gyro is unused";
    assert_eq!(warnings(&sequence), [expected]);
}

#[test]
fn a_quaternion_of_zeros_on_the_way_to_a_sensor_is_named() {
    let mut all: Vec<Line> = lines().into_iter().filter(|line| line.1 != "/tf_static").collect();
    let broken = Pose3::new(
        UnitQuaternion::new_unchecked(nalgebra::Quaternion::from_imag(Vector3::zeros())),
        Vector3::zeros(),
    );
    let stamp = stamp(0);
    let links = [(stamp, "base_link", "imu", broken), (stamp, "base_link", "laser", at(0.2, 0.0))];
    all.insert(0, (0, "/tf_static", ros_message::transforms(&links)));
    let sequence = open(&all);
    let text = warnings(&sequence).join("\n");
    assert!(
        text.starts_with("gyro on /imu: the transform base_link > imu: the quaternion is 0 0 0 0 (x y z w), which is not a rotation")
            && text.contains("21 times"),
        "{text}"
    );
    assert_eq!((sequence.gyro().len(), sequence.scan_times().count()), (0, 11));
}
