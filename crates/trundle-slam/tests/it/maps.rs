//! Several maps, and look-alike places.

use crate::room::{Clean, camera, shoot};
use crate::walks::{dark, turned};
use nalgebra::{Matrix6, Vector6};
use trundle_core::{CameraMotion, Pose3, RgbdImage};
use trundle_slam::{Mode, RgbdSlam, SlamConfig, TrackReport, Tracking};

/// Poses of the camera. It maps one side of the room, is carried to the other in the dark (`None`), is lost there, begins a second map, and
/// turns until the first map is in view.
fn carried() -> Vec<Option<Pose3>> {
    let first = (0..20).step_by(2).map(|i| Some(turned(i)));
    let second = (0..12).map(|_| Some(turned(50)));
    let back = (50..130).step_by(2).map(|i| Some(turned(i)));
    first.chain([None; 3]).chain(second).chain(back).collect()
}

/// Runs the SLAM on all poses.
fn run(images: &[RgbdImage]) -> (RgbdSlam, Vec<TrackReport>) {
    let mut config = SlamConfig::default();
    config.tracking.patience = 8;
    let mut slam = RgbdSlam::new(camera(), config).unwrap();
    let reports = images.iter().map(|image| slam.step(image, None)).collect();
    (slam, reports)
}

#[test]
fn a_lost_camera_begins_a_second_map_that_is_merged_when_the_first_is_seen() {
    let path = carried();
    let shot = |(i, pose): (usize, &Option<Pose3>)| pose.map_or_else(|| dark(i), |pose| shoot(i, pose));
    let images: Vec<RgbdImage> = path.iter().enumerate().map(shot).collect();
    let (slam, reports) = run(&images);
    let second_map = reports.iter().position(|r| r.map != reports[0].map).expect("a second map");
    assert_eq!(second_map, 17, "after 8 frames of patience");
    assert!(reports[10..second_map].iter().all(|r| r.tracking == Tracking::Lost));
    assert_eq!(reports[second_map].visual_from_camera, Pose3::identity(), "the second map has its own frame");
    assert!(reports[second_map..].iter().all(|r| r.tracking.is_located()), "and never lost again");
    let at = reports.iter().position(|r| r.merged.is_some()).expect("the maps are merged");
    let merged = reports[at].merged.unwrap();
    assert_eq!((merged.into, merged.from), (reports[0].map, reports[second_map].map));
    assert_eq!((slam.maps(), reports[at].map), (vec![merged.into], merged.into));
    let jump = reports[at].visual_from_camera * reports[at - 1].visual_from_camera.inverse();
    assert!((merged.correction.inverse() * jump).log().norm() < 0.2, "reported as a correction: {jump:?}");

    let located =
        reports.iter().zip(&path).filter(|(r, _)| r.tracking.is_located()).map(|(_, pose)| pose.unwrap());
    let trajectory = slam.trajectory();
    let errors = located.zip(&trajectory).map(|(truth, (_, pose))| (truth.inverse() * *pose).log().norm());
    let errors: Vec<f64> = errors.collect();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    println!("merged at {at} by {} points, worst error {worst:.3} (m and rad)", merged.points);
    assert_eq!((errors.len(), trajectory.len()), (path.len() - 7, path.len() - 7));
    assert!(worst < 0.06, "{worst}");

    let (again, the_same) = run(&images);
    assert!(reports == the_same && trajectory == again.trajectory(), "every run gives the same");
    assert!(slam.save() == again.save(), "to the byte");
}

/// Drives in the dark into a second room with identical views.
#[test]
fn a_look_alike_room_is_not_merged() {
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    let step = Pose3::exp(Vector6::new(0.0, 0.0, 0.4, 0.0, 0.0, 0.0));
    for i in 0..20 {
        assert!(slam.step(&shoot(i, turned(2 * i)), Some(turned(2).into())).tracking.is_located());
    }
    let mut truth = turned(38);
    for i in 20..30 {
        truth = truth * step;
        assert_eq!(slam.step(&dark(i), Some(step.into())).tracking, Tracking::DeadReckoning);
    }
    for i in 30..60 {
        truth = truth * turned(2);
        let report = slam.step(&shoot(i, turned(2 * i - 20)), Some(turned(2).into()));
        assert!(!report.relocalised && report.closed_loop.is_none() && report.merged.is_none(), "frame {i}");
        let error = (truth.inverse() * report.visual_from_camera).log().norm();
        assert!(error < 0.1, "frame {i} is off by {error:.3}");
    }
}

/// Carried elsewhere during a turn: the new view does not continue the first map.
#[test]
fn a_camera_that_is_carried_between_two_images_does_not_go_on_mapping() {
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    for i in 0..20 {
        assert!(slam.step(&shoot(i, turned(2 * i)), Some(turned(2).into())).tracking.is_located());
    }
    for i in 20..48 {
        let report = slam.step(&shoot(i, turned(2 * i + 30)), Some(turned(2).into()));
        assert!(report.features >= 200 && !report.tracking.is_located(), "frame {i}: {report:?}");
        assert!(!report.new_keyframe, "frame {i} is at another place than by the wheels");
    }
    let found =
        (48..60).find(|i| slam.step(&shoot(*i, turned(10)), Some(Pose3::identity().into())).relocalised);
    assert_eq!(found, None, "the wheels count until the robot is declared as carried");
    slam.kidnapped();
    let found =
        (60..70).find(|i| slam.step(&shoot(*i, turned(10)), Some(Pose3::identity().into())).relocalised);
    assert!(found.is_some());
}

/// The wheels lost ticks in the dark: a second map begins, until the first map is in view again.
#[test]
fn after_uncertain_dead_reckoning_another_map_begins_and_is_merged() {
    let unsure = |motion: Pose3| CameraMotion {
        motion,
        covariance: Some(Matrix6::from_diagonal(&Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4))),
    };
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    for i in 0..20 {
        assert!(slam.step(&shoot(i, turned(2 * i)), Some(turned(2).into())).tracking.is_located());
    }
    // Half a turn. The wheels report 0.2 rad less, and 0.3 m of motion that did not happen.
    let reported = turned(4) * Pose3::exp(Vector6::new(0.0, 0.0, 0.03, 0.0, 0.01, 0.0));
    for i in 20..30 {
        assert_eq!(slam.step(&dark(i), Some(unsure(reported))).tracking, Tracking::DeadReckoning);
    }
    let mut merged = None;
    for (i, view) in (30..100).zip((80..).step_by(2)) {
        let report = slam.step(&shoot(i, turned(view)), Some(turned(2).into()));
        assert!(i == 30 || report.tracking.is_located(), "frame {i}");
        let first = report.map.number() == 0;
        assert_eq!(first, i == 30 || merged.is_some() || report.merged.is_some(), "frame {i}");
        merged = merged.or(report.merged);
        let error = (turned(view).inverse() * report.visual_from_camera).log().norm();
        assert!(!first || i == 30 || error < 0.05, "frame {i} is off by {error:.3}");
    }
    assert!(merged.is_some(), "the turn is complete");
    assert_eq!(slam.maps().len(), 1);
}

#[test]
fn without_odometry_a_relocalisation_must_be_within_reach() {
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    for i in 0..20 {
        assert!(slam.step(&shoot(i, turned(2 * i)), None).tracking.is_located());
    }
    // Back at the first view, 2.4 rad away, one frame later: at 3.5 rad/s this takes 18 frames.
    let back = Clean::at(turned(0));
    let tracking: Vec<Tracking> = (20..50).map(|i| slam.step(&back.shot(i), None).tracking).collect();
    let found = tracking.iter().position(|t| t.is_located()).expect("it is a place of the map");
    assert!((15..20).contains(&found), "found after {found} frames");
    assert!(
        tracking[..found].iter().all(|t| *t == Tracking::Lost)
            && tracking[found..].iter().all(|t| t.is_located())
    );
    assert_eq!(slam.maps().len(), 1);
}

/// The place is in two maps that were not merged: two hypotheses of the pose must not keep the camera lost.
#[test]
fn a_lost_camera_is_found_where_two_maps_overlap() {
    let mut config = SlamConfig::default();
    config.tracking.patience = 8;
    config.loops.consistency = 1000;
    let mut slam = RgbdSlam::new(camera(), config).unwrap();
    for (i, pose) in carried().into_iter().enumerate() {
        slam.step(&pose.map_or_else(|| dark(i), |pose| shoot(i, pose)), None);
    }
    assert_eq!(slam.maps().len(), 2);
    slam.set_mode(Mode::Localisation);
    for i in 100..103 {
        assert_eq!(slam.step(&dark(i), None).tracking, Tracking::Lost);
    }
    let found = (103..115).position(|i| slam.step(&shoot(i, turned(105)), None).tracking.is_located());
    assert!(found.is_some_and(|frames| frames <= 4), "{found:?}");
}

/// Turns without odometry: 0.38 rad per frame, and 0.19 rad with every second image dark.
#[test]
fn a_lost_camera_that_turns_fast_or_has_few_usable_images_is_found() {
    let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap();
    for i in 0..25 {
        slam.step(&shoot(i, turned(4 * i)), None);
    }
    let saved = slam.save();
    for (step, dark_between) in [(1, false), (6, false), (3, true)] {
        let mut slam = RgbdSlam::load(&saved, camera(), SlamConfig::default()).unwrap();
        slam.set_mode(Mode::Localisation);
        let shot = |i: usize| {
            if dark_between && i % 2 == 1 { dark(3 * i) } else { shoot(3 * i, turned((step * i) % 100)) }
        };
        let found = (200..240).position(|i| slam.step(&shot(i), None).tracking.is_located());
        assert!(found.is_some_and(|frames| frames <= 6), "{step} steps a frame: {found:?}");
    }
}
