//! TUM folders as the writer leaves them.

use crate::frame;
use std::fs;
use tempfile::TempDir;
use trundle_core::{Beam, Distortion, PinholeCamera, Pose2, Pose3, RgbdImage, Scan, Stamp, Twist2, Vector2};
use trundle_io::*;

const SIZE: (usize, usize) = (40, 30);

fn camera() -> PinholeCamera {
    PinholeCamera::new(SIZE, (35.0, 36.5), (19.5, 14.25), Distortion::default()).unwrap()
}

/// Four images, 10 s apart, the last at 1000 s: more digits than the first.
fn images() -> Vec<RgbdImage> {
    [0, 10, 20, 1000]
        .map(|s| frame(Stamp::from_nanos(s * 1_000_000_000 + 66_000_000), SIZE.0, SIZE.1))
        .to_vec()
}

fn poses() -> Vec<(Stamp, Pose3)> {
    let pose = |i: i64| Pose3::from_pose2(Pose2::new(i as f64 * 0.1, -0.25, 0.5));
    (0..5).map(|i| (Stamp::from_nanos(i * 20_000_000), pose(i))).collect()
}

/// A complete folder, whose parts were added in an order other than that of time.
fn written() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&dir.path().join("run")).unwrap();
    let mut writer = TumWriter::new(&folder, camera(), 15.0);
    for image in images().iter().rev() {
        writer.frame(&TumFrame::encode(image).unwrap()).unwrap();
    }
    for (i, (stamp, pose)) in poses().into_iter().rev().enumerate() {
        writer.ground_truth(stamp, pose);
        writer.ground_truth(stamp, Pose3::identity()); // a second one of the same moment is left out
        writer.odometry(stamp, Pose2::new(i as f64, 1.0 / 3.0, -0.1));
    }
    writer.finish().unwrap();
    folder.commit().unwrap();
    dir
}

#[test]
fn a_written_folder_is_read_again() {
    let dir = written();
    let run = dir.path().join("run");
    let model = CameraModel::read(&run.join("camera.toml")).unwrap();
    assert_eq!(model, CameraModel { camera: camera(), depth_scale: TUM_DEPTH_SCALE });
    let sequence = TumSequence::open(&run, model.depth_scale, 0.0).unwrap().with_size(SIZE.0, SIZE.1);
    assert_eq!((sequence.len(), sequence.unpaired()), (4, 0));
    for (image, read) in images().iter().zip(sequence.frames()) {
        let read = read.unwrap();
        assert!(read.stamp() == image.stamp() && read.color() == image.color());
        let depths = image.depth().data().iter().zip(read.depth().data());
        assert!(depths.into_iter().all(|(a, b)| (a - b).abs() <= 0.1001e-3), "half a unit of 0.2 mm");
    }
    let (truth, expected) = (sequence.ground_truth().unwrap(), poses());
    assert_eq!(truth.len(), expected.len());
    for ((stamp, pose), (other, known)) in truth.iter().zip(&expected) {
        assert!(stamp == other && (pose.inverse() * *known).log().norm() < 1e-8);
    }
    let odometry = sequence.odometry().unwrap();
    assert_eq!((odometry.len(), odometry[0]), (5, (Stamp::default(), Pose2::new(4.0, 1.0 / 3.0, -0.1))));
}

#[test]
fn names_of_images_sort_as_their_stamps() {
    let dir = written();
    let run = dir.path().join("run");
    for (list, folder) in [("rgb.txt", "rgb"), ("depth.txt", "depth")] {
        let text = fs::read_to_string(run.join(list)).unwrap();
        let listed: Vec<&str> =
            text.lines().filter(|l| !l.starts_with('#')).map(|l| l.split(' ').nth(1).unwrap()).collect();
        let entries = fs::read_dir(run.join(folder)).unwrap();
        let mut found: Vec<String> =
            entries.map(|e| format!("{folder}/{}", e.unwrap().file_name().display())).collect();
        found.sort();
        assert_eq!(listed, found);
    }
    let pairs = fs::read_to_string(run.join("associations.txt")).unwrap();
    let last = "1000.066000000 rgb/0000001000.066000000.png 1000.066000000 depth/0000001000.066000000.png";
    assert_eq!((pairs.lines().last(), pairs.lines().count()), (Some(last), 4)); // no comment: ORB-SLAM takes none
}

#[test]
fn wrong_frames_and_empty_folders_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&dir.path().join("run")).unwrap();
    let mut writer = TumWriter::new(&folder, camera(), 15.0);
    let problem = |error: IoError| error.to_string().replace(&dir.path().display().to_string(), "DIR");
    let frame_of = |w, h| TumFrame::encode(&frame(Stamp::from_nanos(5), w, h)).unwrap();
    assert_eq!(
        problem(writer.frame(&frame_of(20, 30)).unwrap_err()),
        "DIR/run/rgb/0000000000.000000005.png: image is 20 x 30 px, expected 40 x 30 as the camera"
    );
    writer.frame(&frame_of(40, 30)).unwrap();
    assert_eq!(
        problem(writer.frame(&frame_of(40, 30)).unwrap_err()),
        "DIR/run/rgb/0000000000.000000005.png: a second image at 0.000000005 s, expected stamps that differ"
    );
    let empty = TumWriter::new(&folder, camera(), 15.0);
    assert_eq!(problem(empty.finish().unwrap_err()), "DIR/run: no image to write, expected 1 or more");
}

#[test]
fn a_laser_log_is_read_again() {
    let mut log = CarmenLog::new(5.6);
    let pose = |i: i64| Pose2::new(0.25 * i as f64, -0.5, 0.125);
    for i in 0..40 {
        let stamp = Stamp::from_nanos(i * 100_000_000);
        log.odometry(stamp, pose(i), Twist2::new(0.25, 0.0));
        let beam = |k: i64| match (k + i) % 10 {
            0 => Beam::Free { range: 5.6 },
            1 => Beam::Unseen,
            _ => Beam::Hit { range: 1.0 + k as f64 * 0.125 },
        };
        let beams = (0..30).map(beam).collect();
        log.scan(&Scan::new(stamp, Vector2::new(0.125, 0.0), -0.5, 0.03125, beams).unwrap());
    }
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("laser.log");
    fs::write(&path, log.into_text()).unwrap();
    let read = read_carmen(&path, &LaserLogOptions::default()).unwrap();
    assert_eq!((read.scans.len(), read.odometry.len(), read.skipped.len()), (40, 40, 0));
    let (mut log, mut scans) = LaserLogScans::open(&path, &LaserLogOptions::default()).unwrap();
    let one_at_a_time: Vec<_> = std::iter::from_fn(|| scans.next_scan(&mut log).unwrap()).collect();
    assert_eq!((&one_at_a_time, &log.statistics), (&read.scans, &read.statistics));
    let LaserLogScan { odom_from_base, scan } = &read.scans[7];
    assert!(odom_from_base.distance(&pose(7)) < 1e-6 && (scan.origin().x - 0.125).abs() < 1e-6);
    assert!((scan.angle_min() + 0.5).abs() < 1e-6 && (scan.angle_increment() - 0.03125).abs() < 1e-6);
    for (k, beam) in scan.beams().iter().enumerate() {
        match (k + 7) % 10 {
            0 | 1 => assert!(!matches!(beam, Beam::Hit { .. }), "beam {k}: {beam:?}"),
            _ => {
                assert!(matches!(beam, Beam::Hit { range } if (range - 1.0 - k as f64 * 0.125).abs() < 1e-3))
            }
        }
    }
}
