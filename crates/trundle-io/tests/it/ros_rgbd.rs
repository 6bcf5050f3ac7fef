//! RGB-D images of ROS bags.

use crate::frame;
use std::io::Cursor;
use std::path::Path;
use tempfile::NamedTempFile;
use trundle_core::{Distortion, PinholeCamera, Pose3, Stamp, Vector3};
use trundle_io::ros_message::RosMessage;
use trundle_io::*;

const COLOR: &str = "/camera/color/image_raw/compressed";
const DEPTH: &str = "/camera/depth/image_raw/compressedDepth";
const SIZE: (usize, usize) = (40, 30);

fn stamp(millis: i64) -> Stamp {
    Stamp::from_nanos(1_700_000_000_000_000_000 + millis * 1_000_000)
}

fn camera() -> PinholeCamera {
    let lens = Distortion { k1: 0.1, ..Distortion::default() };
    PinholeCamera::new(SIZE, (50.0, 51.0), (19.5, 14.5), lens).unwrap()
}

fn mount() -> Pose3 {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.6, 0.0, -1.57);
    Pose3::new(turn, Vector3::new(0.1, 0.0, 0.4))
}

/// A message, its topic and its time, ms.
type Line = (i64, &'static str, RosMessage);

/// Three images 100 ms apart, depth 4 ms later; camera_info, mount, odometry, ground truth.
fn lines() -> Vec<Line> {
    let mut lines =
        vec![(0, "/tf_static", ros_message::transforms(&[(stamp(0), "base_link", "camera", mount())]))];
    for ms in [0, 100, 200] {
        let image = EncodedRgbd::encode(&frame(stamp(ms), SIZE.0, SIZE.1)).unwrap();
        let x = Pose3::new(Default::default(), Vector3::new(ms as f64 * 0.001, 0.0, 0.0));
        lines.push((ms, "/odom", ros_message::odometry_pose(stamp(ms), "odom", "base_link", x)));
        lines.push((ms, "/ground_truth", ros_message::odometry_pose(stamp(ms), "world", "base_link", x)));
        let info = ros_message::camera_info(stamp(ms), "camera", &camera());
        lines.push((ms, "/camera/color/camera_info", info));
        lines.push((ms, COLOR, ros_message::color_image(stamp(ms), "camera", &image.color_jpeg)));
        lines.push((ms, DEPTH, ros_message::depth_image(stamp(ms + 4), "camera", &image.depth)));
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

fn open(lines: &[Line], options: &RosSequenceOptions) -> Result<(NamedTempFile, RosSequence), String> {
    let file = bag(lines);
    let sequence = RosSequence::open(file.path(), options, true);
    let named = |error: IoError| error.to_string().replace(&file.path().display().to_string(), "BAG");
    sequence.map_err(named).map(|sequence| (file, sequence))
}

fn refusal(lines: &[Line]) -> String {
    open(lines, &RosSequenceOptions::default()).err().unwrap()
}

#[test]
fn images_camera_mount_and_poses_come_out_of_a_bag() {
    let (file, sequence) = open(&lines(), &RosSequenceOptions::default()).unwrap();
    assert_eq!(FileKind::of(file.path()).unwrap(), FileKind::Ros2Mcap);
    assert_eq!((sequence.len(), sequence.unpaired(), sequence.camera()), (3, 0, Some(camera())));
    assert_eq!((sequence.topics().color.as_str(), sequence.topics().depth.as_str()), (COLOR, DEPTH));
    let off = sequence.base_from_camera().unwrap().inverse() * mount();
    assert!(off.log().norm() < 1e-12, "{off:?}");
    assert_eq!(sequence.odometry().unwrap()[2].1.x, 0.2);
    let truth = sequence.ground_truth().unwrap()[2].1;
    assert!((truth.translation - Vector3::new(0.3, 0.0, 0.4)).norm() < 1e-12);
    for (i, frame_of_bag) in sequence.frames(1000.0).unwrap().enumerate() {
        let expected = EncodedRgbd::encode(&frame(stamp(100 * i as i64), SIZE.0, SIZE.1)).unwrap();
        let (read, expected) = (frame_of_bag.unwrap().decode().unwrap(), expected.decode().unwrap());
        assert!(read.stamp() == expected.stamp() && read.color() == expected.color());
        let pairs = read.depth().data().iter().zip(expected.depth().data());
        assert!(pairs.fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs())) < 1e-6, "the same millimetres");
    }
    assert_eq!(sequence.frames(1000.0).unwrap().count(), 3);
    assert!(sequence.warnings().is_empty());
}

#[test]
fn a_bag_whose_depth_comes_much_later_and_is_cut_is_read_too() {
    let (mut sorted, image) = (lines(), |line: &Line| line.1 == DEPTH);
    sorted.sort_by_key(image);
    let (_file, sequence) = open(&sorted, &RosSequenceOptions::default()).unwrap();
    assert_eq!(sequence.frames(1000.0).unwrap().filter_map(Result::ok).count(), 3);
    let file = bag(&lines());
    let bytes = std::fs::read(file.path()).unwrap();
    for end in (0..bytes.len()).step_by(211) {
        std::fs::write(file.path(), &bytes[..end]).unwrap();
        if let Ok(sequence) = RosSequence::open(file.path(), &RosSequenceOptions::default(), true) {
            let frames = sequence.frames(1000.0).unwrap().filter_map(Result::ok).count();
            assert!(frames <= 3);
        }
    }
}

#[test]
fn missing_and_ambiguous_topics_are_named() {
    let without = |topic: &str| lines().into_iter().filter(|line| line.1 != topic).collect::<Vec<_>>();
    let problem = refusal(&without("/camera/color/camera_info"));
    assert!(
        problem.contains("no camera_info on /camera/color/camera_info for the images of /camera"),
        "{problem}"
    );
    let problem = refusal(&without(DEPTH));
    assert!(
        problem.starts_with("BAG: no depth images, expected some; its images: /camera/color"),
        "{problem}"
    );
    assert!(refusal(&without(COLOR)).starts_with("BAG: no colour images"));
    let late: Vec<Line> = without(DEPTH)
        .into_iter()
        .chain([(900, DEPTH, ros_message::depth_image(stamp(900), "camera", b"x"))])
        .collect();
    assert!(refusal(&late).contains("is within 0.02 s of one of"), "{}", refusal(&late));
    let second = (0, "/other/depth/compressedDepth", lines().pop().unwrap().2);
    let twice: Vec<Line> = lines().into_iter().chain([second]).collect();
    assert!(refusal(&twice).contains("several topics hold depth images"), "{}", refusal(&twice));
    let mut asked = RosSequenceOptions::default();
    asked.depth_topic = Some(DEPTH[1..].to_owned());
    assert_eq!(
        open(&twice, &asked).unwrap().1.topics().left,
        [("/other/depth/compressedDepth".to_owned(), 1)]
    );
}

#[test]
fn depth_of_another_camera_is_refused() {
    let image = EncodedRgbd::encode(&frame(stamp(0), SIZE.0, SIZE.1)).unwrap();
    let aside = Pose3::new(Default::default(), Vector3::new(0.05, 0.0, 0.0));
    let other = |line: Line| match line.1 {
        DEPTH => (line.0, DEPTH, ros_message::depth_image(stamp(line.0), "infrared", &image.depth)),
        _ => line,
    };
    let apart: Vec<Line> = lines().into_iter().map(other).collect();
    assert!(
        open(&apart, &RosSequenceOptions::default()).unwrap().1.warnings().count() == 1,
        "it is not known"
    );
    let transform = ros_message::transforms(&[(stamp(0), "camera", "infrared", aside)]);
    let apart: Vec<Line> = apart.into_iter().chain([(0, "/tf_static", transform)]).collect();
    let problem = refusal(&apart);
    assert!(problem.contains("0.050 m and 0.00 deg apart: expected depth registered to colour"), "{problem}");
}
