//! Ten laps of one room take the memory of three laps; memory does not grow with time.

use crate::points::{Dice, Room, camera, darkness, stamp};
use nalgebra::Vector6;
use std::f64::consts::TAU;
use trundle_core::Pose3;
use trundle_slam::{RgbdSlam, SlamConfig, Tracking};

/// Frames of a lap.
const LAP: usize = 72;

/// A lap of the room, on a slightly different path each time.
fn lap(frame: usize, dice: &mut Dice) -> Pose3 {
    let t = frame as f64 / LAP as f64 * TAU;
    let (dx, dz) = (0.05 * (dice.uniform() - 0.5), 0.05 * (dice.uniform() - 0.5));
    Pose3::exp(Vector6::new(0.7 * t.cos() + dx, 0.0, 0.7 * t.sin() + dz, 0.0, 0.0, 0.0))
        * Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, -t + 0.05 * (dice.uniform() - 0.5), 0.0))
}

#[test]
fn ten_laps_of_a_room_take_no_more_than_three() {
    let (room, mut dice) = (Room::new(), Dice(5));
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    let (mut at, mut after, mut weak) = (lap(0, &mut dice), Vec::new(), 0);
    for i in 0..10 * LAP {
        let to = if i == 0 { at } else { lap(i, &mut dice) };
        let (features, depth) = room.seen_from(to, &mut dice);
        let report = slam.step_with_features(stamp(i), features, &depth, Some((at.inverse() * to).into()));
        assert!(report.tracking.is_located(), "frame {i}");
        weak += usize::from(report.tracking == Tracking::Weak);
        at = to;
        if (i + 1) % LAP == 0 {
            after.push((report.keyframes, report.landmarks, slam.save().len()));
        }
    }
    println!("keyframes, landmarks, bytes after each lap: {after:?}");
    let within = |ten: usize, three: usize| ten as f64 <= 1.1 * three as f64;
    let (three, ten) = (after[2], after[9]);
    assert!(within(ten.0, three.0), "keyframes");
    assert!(within(ten.1, three.1) && within(ten.2, three.2), "landmarks and bytes");
    assert!(weak <= 3, "{weak} weak frames");
}

#[test]
fn only_wanted_poses_of_the_newest_frames_are_kept() {
    let mut config = SlamConfig::default();
    config.kept_frames = 7;
    let mut slam = RgbdSlam::new(camera(), config).unwrap();
    let (room, mut dice) = (Room::new(), Dice(5));
    let mut reported = Vec::new();
    for i in 0..20 {
        let (features, depth) =
            if i % 5 == 3 { darkness() } else { room.seen_from(lap(i, &mut Dice(5)), &mut dice) };
        let report = slam.step_with_features(stamp(i), features, &depth, Some(Pose3::identity().into()));
        reported.push(report.stamp);
    }
    let kept: Vec<_> = slam.trajectory().into_iter().map(|(stamp, _)| stamp).collect();
    assert_eq!(kept, reported[13..]);
    slam.forget_frames(|stamp| stamp == reported[15]);
    let kept: Vec<_> = slam.trajectory().into_iter().map(|(stamp, _)| stamp).collect();
    assert_eq!(kept, [reported[15], reported[19]], "that one, and the last");
    let mut none = SlamConfig::default();
    none.kept_frames = 0;
    let error = RgbdSlam::new(camera(), none).unwrap_err().to_string();
    assert_eq!(error, "slam.kept_frames is 0, expected 1 or more");
}
