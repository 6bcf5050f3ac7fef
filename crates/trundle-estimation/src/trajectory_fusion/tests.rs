//! A drive along a curve with dark stretches that end visual maps.

use super::frame::{MapPose, SequenceFrame};
use super::fuse::fuse_frames;
use nalgebra::{Matrix3, Vector6};
use trundle_core::{CameraMotion, Pose2, Pose3, Stamp};

/// Number of frames of the drive.
const FRAME_COUNT: usize = 60;

/// Pose of the base at frame `i`: 2 cm and 0.5 deg per frame.
fn base_at(i: usize) -> Pose2 {
    (0..i).fold(Pose2::IDENTITY, |pose, _| pose * Pose2::new(0.02, 0.0, 0.0087))
}

fn base_from_camera() -> Pose3 {
    Pose3::new(nalgebra::UnitQuaternion::from_euler_angles(-1.7, 0.0, -1.57), [0.05, 0.0, 0.45].into())
}

fn camera_at(i: usize) -> Pose3 {
    Pose3::from_pose2(base_at(i)) * base_from_camera()
}

/// The odometry's motion to frame `i`, longer than the true one by the fraction `error`.
fn step_to(i: usize, error: f64) -> CameraMotion {
    let mut motion = base_at(i - 1).inverse() * base_at(i);
    motion.x *= 1.0 + error;
    let noise = Matrix3::from_diagonal(&[8e-6, 2e-8, 2e-6].into());
    CameraMotion::of_base((motion, noise), base_from_camera())
}

/// Pose of map `map` in map 0.
fn world_from(map: u32) -> Pose3 {
    Pose3::exp(Vector6::new(0.3, -0.2, 0.1, 0.2, -0.1, 0.7) * f64::from(map))
}

/// The drive; `map_of` names the map in which a frame is located.
fn drive(odometry_error: f64, map_of: impl Fn(usize) -> Option<u32>) -> Vec<SequenceFrame> {
    let in_map =
        |i: usize, map: u32| MapPose { map, map_from_camera: world_from(map).inverse() * camera_at(i) };
    let frame = |i: usize| SequenceFrame {
        stamp: Stamp::from_nanos(i as i64 * 66_000_000),
        visual: map_of(i).map(|map| in_map(i, map)),
        motion: (i > 0).then(|| step_to(i, odometry_error)),
    };
    (0..FRAME_COUNT).map(frame).collect()
}

/// Largest distance of the poses from the true ones, m; all frames must have one.
fn worst(poses: &[Option<Pose3>]) -> f64 {
    let off = |(i, pose): (usize, &Option<Pose3>)| {
        (pose.expect("a pose").translation - camera_at(i).translation).norm()
    };
    poses.iter().enumerate().map(off).fold(0.0, f64::max)
}

#[test]
fn frames_that_images_locate_keep_their_pose_to_the_bit() {
    let frames = drive(0.1, |_| Some(0));
    for (frame, pose) in frames.iter().zip(fuse_frames(&frames)) {
        assert_eq!(frame.visual.map(|visual| visual.map_from_camera), pose);
    }
}

#[test]
fn a_second_map_is_laid_into_the_first_by_the_path_between() {
    let two_maps = |i: usize| match i {
        0..20 => Some(0),
        40.. => Some(3),
        _ => None,
    };
    assert!(worst(&fuse_frames(&drive(0.0, two_maps))) < 1e-9);
    let off = worst(&fuse_frames(&drive(0.1, two_maps)));
    // 42 cm in the dark, with 10 % error of odometry.
    assert!((0.03..0.045).contains(&off), "{off} m");
}

#[test]
fn a_map_met_again_takes_the_error_out_of_the_path() {
    let again = |i: usize| if (20..40).contains(&i) { None } else { Some(0) };
    let off = worst(&fuse_frames(&drive(0.1, again)));
    assert!(off < 0.01, "both ends are known: {off} m");
    // Map 0, dark, map 1, dark, map 0: the error is distributed over both dark paths.
    let around = |i: usize| match i {
        0..15 | 45.. => Some(0),
        25..35 => Some(1),
        _ => None,
    };
    let off = worst(&fuse_frames(&drive(0.1, around)));
    assert!(off < 0.01, "{off} m");
}

#[test]
fn frames_beyond_a_gap_of_the_odometry_stay_without_a_pose() {
    let mut frames = drive(0.0, |i| match i {
        0..15 => Some(0),
        45.. => Some(1),
        _ => None,
    });
    frames[25].motion = None;
    let poses = fuse_frames(&frames);
    let placed: Vec<usize> = (0..FRAME_COUNT).filter(|i| poses[*i].is_some()).collect();
    assert_eq!(placed, (0..25).collect::<Vec<_>>(), "the first of two maps of equal size, and its path");
    frames[10].visual = None;
    let poses = fuse_frames(&frames);
    assert!(
        poses[..25].iter().all(Option::is_none) && poses[25..].iter().all(Option::is_some),
        "the larger map"
    );
    frames.iter_mut().for_each(|frame| frame.visual = None);
    assert!(fuse_frames(&frames).iter().all(Option::is_none) && fuse_frames(&[]).is_empty());
}

#[test]
fn motions_that_are_not_finite_or_have_no_covariance_place_no_map() {
    let two_maps = |i: usize| (!(20..40).contains(&i)).then_some(u32::from(i >= 40));
    let broken = [
        CameraMotion { covariance: None, ..step_to(30, 0.0) },
        CameraMotion { covariance: Some(nalgebra::Matrix6::identity() * f64::NAN), ..step_to(30, 0.0) },
    ];
    for motion in broken {
        let mut frames = drive(0.0, two_maps);
        frames[30].motion = Some(motion);
        let poses = fuse_frames(&frames);
        assert!(poses.iter().flatten().all(Pose3::is_finite));
        assert!(poses[20..29].iter().all(Option::is_some), "dead reckoning from the first map");
    }
}
