//! Laws, faults and recoveries of the localizer.

use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector6};
use proptest::prelude::*;
use trundle_core::{Odometry, Pose2, Pose3, Stamp, Twist2, Vector2, Vector3, wrap_angle};
use trundle_estimation::{
    Correction, Localizer, LocalizerConfig, MapUncertainty, PoseUncertainty, Prediction, ScanPose,
    VisualPose, VisualQuality, planar_covariance,
};

fn at(ms: i64) -> Stamp {
    Stamp::from_nanos(ms * 1_000_000)
}

/// A scan match with a certain map.
fn matched(stamp: Stamp, map_from_base: Pose2, covariance: Matrix3<f64>) -> ScanPose {
    ScanPose { stamp, map_from_base, covariance, map: PoseUncertainty::default() }
}

/// A camera pitched 8 deg down.
fn base_from_camera() -> Pose3 {
    let optical = Pose3::from_matrix(
        Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0),
        Vector3::new(0.05, 0.0, 0.45),
    );
    let tilt = UnitQuaternion::from_euler_angles(0.0, 8.0_f64.to_radians(), 0.0);
    Pose3::new(tilt * optical.rotation, optical.translation)
}

const TWIST: Twist2 = Twist2::new(0.4, 0.3);

/// Odometry on a circle; its covariance grows with time.
fn odometry(ms: i64) -> Odometry {
    let t = ms as f64 * 1e-3;
    let back = adjoint(&Pose2::IDENTITY.advance(TWIST, 0.02).inverse());
    let noise = Matrix3::from_diagonal(&Vector3::new(8e-6, 2e-6, 2e-6));
    let covariance = (0..ms / 20).fold(Matrix3::zeros(), |c, _| back * c * back.transpose() + noise);
    Odometry { stamp: at(ms), pose: Pose2::IDENTITY.advance(TWIST, t), twist: TWIST, covariance }
}

fn adjoint(pose: &Pose2) -> Matrix3<f64> {
    let (s, c) = pose.theta.sin_cos();
    Matrix3::new(c, -s, pose.y, s, c, -pose.x, 0.0, 0.0, 1.0)
}

fn localizer() -> Localizer {
    Localizer::new(LocalizerConfig::default(), base_from_camera()).unwrap()
}

#[test]
fn a_resumed_localizer_has_no_pose_until_a_known_map_is_recognised() {
    let mut first = localizer();
    driven(0, 1000, &mut first);
    first.correct_visual(&visual(500, Pose2::IDENTITY));
    let mut second = localizer().resumed(first.visual_maps());
    driven(0, 1000, &mut second);
    assert!(second.estimate().covariance[(0, 0)] > 1e3);
    let foreign = VisualPose { map: 1, ..visual(400, Pose2::IDENTITY) };
    assert_eq!(second.correct_visual(&foreign), Correction::PoseUnknown);
    // Pose at 0.5 s in the first run's map.
    let pose = Pose2::new(3.0, -2.0, 2.5);
    assert!(second.correct_visual(&visual(500, pose)).is_applied());
    let there = second.pose_at(at(500)).unwrap();
    let expected = first.map_from_visual().unwrap()
        * visual(500, pose).visual_from_camera
        * base_from_camera().inverse();
    assert!(there.distance(&expected.to_pose2()) < 0.01, "{there:?}");
    assert!(wrap_angle(there.theta - expected.to_pose2().theta).abs() < 0.01);
    assert!(second.estimate().covariance[(0, 0)] < 0.01);
    assert!(matches!(second.correct_visual(&VisualPose { stamp: at(520), ..foreign }), Correction::Anchored));
}

#[test]
fn scan_matches_refine_an_uncertain_visual_anchor() {
    let mut localizer = localizer();
    driven(0, 20_000, &mut localizer);
    let truth = |ms: i64| Pose2::new(0.2, -0.1, 0.05) * odometry(ms).pose;
    localizer.correct_visual(&visual(19_000, truth(19_000)));
    let before = localizer.map_from_visual().unwrap();
    for ms in (19_020..19_980).step_by(40) {
        localizer.correct_visual(&visual(ms, truth(ms)));
    }
    assert!(
        localizer.estimate().covariance[(0, 0)] > 0.05_f64.powi(2),
        "a visual pose in its own frame adds no information"
    );
    for ms in (20_020..26_000).step_by(20) {
        localizer.predict(&odometry(ms));
        if ms % 100 == 0 {
            localizer.correct_scan(&matched(at(ms), truth(ms), Matrix3::identity() * 1e-5));
            localizer.correct_visual(&visual(ms, truth(ms)));
        }
    }
    // The anchor starts at the pose of the odometry; only the true frame agrees with visual poses and scans.
    let visual_from_map = base_from_camera().inverse();
    let off = |map_from_visual: Pose3| (visual_from_map * map_from_visual).translation.norm();
    let now = localizer.map_from_visual().unwrap();
    assert!(off(now) < 0.5 * off(before), "{} before, {} now", off(before), off(now));
}

fn driven(from: i64, to: i64, localizer: &mut Localizer) {
    for ms in (from..=to).step_by(20) {
        localizer.predict(&odometry(ms));
    }
}

/// A visual pose without error, in the frame of the first camera.
fn visual(ms: i64, map_from_base: Pose2) -> VisualPose {
    let visual_from_map = base_from_camera().inverse();
    VisualPose {
        stamp: at(ms),
        visual_from_camera: visual_from_map * Pose3::from_pose2(map_from_base) * base_from_camera(),
        covariance: Matrix6::zeros(),
        quality: VisualQuality::Ok,
        map: 0,
        recognised: false,
    }
}

fn gap(a: Pose2, b: Pose2) -> f64 {
    a.distance(&b) + wrap_angle(a.theta - b.theta).abs()
}

#[test]
fn odometry_alone_yields_an_estimate() {
    let mut localizer = localizer();
    assert_eq!(localizer.estimate().pose, Pose2::IDENTITY);
    driven(0, 4000, &mut localizer);
    let estimate = localizer.estimate();
    assert!(gap(estimate.pose, odometry(4000).pose) < 1e-9);
    assert_eq!((estimate.stamp, estimate.twist), (at(4000), TWIST));
    assert!((estimate.covariance - odometry(4000).covariance).norm() < 1e-12);
    assert_eq!(localizer.map_from_visual(), None);
}

#[test]
fn the_first_visual_pose_anchors_its_frame_and_leaves_the_estimate() {
    let mut localizer = localizer();
    driven(0, 400, &mut localizer);
    let before = localizer.estimate();
    // The tracker started late: its first pose is the identity, though the base has moved.
    let first = VisualPose { visual_from_camera: Pose3::identity(), ..visual(400, Pose2::IDENTITY) };
    assert_eq!(localizer.correct_visual(&first), Correction::Anchored);
    assert_eq!(localizer.estimate(), before);
    let map_from_base = localizer.map_from_visual().unwrap() * base_from_camera().inverse();
    assert!(gap(map_from_base.to_pose2(), before.pose) < 1e-9);
    assert!(map_from_base.translation.z.abs() < 1e-12);
}

#[test]
fn corrections_converge_to_the_measurement_and_keep_the_sigma_floor() {
    let mut localizer = localizer();
    driven(0, 1000, &mut localizer);
    localizer.correct_visual(&visual(0, Pose2::IDENTITY));
    let truth = odometry(1000).pose * Pose2::new(0.03, -0.02, 0.01);
    for _ in 0..60 {
        assert!(localizer.correct_visual(&visual(1000, truth)).is_applied());
    }
    let estimate = localizer.estimate();
    assert!(gap(estimate.pose, truth) < 2e-3, "{:?} {truth:?}", estimate.pose);
    assert!(estimate.covariance[(0, 0)].sqrt() >= 0.015 - 1e-12, "sixty correlated images");
    assert!(estimate.covariance[(2, 2)].sqrt() >= 0.45_f64.to_radians() - 1e-12);
}

#[test]
fn sixty_images_of_the_same_landmarks_are_no_more_certain_than_one_of_them() {
    let mut localizer = localizer();
    driven(0, 200, &mut localizer);
    localizer.correct_visual(&visual(0, Pose2::IDENTITY));
    driven(220, 4000, &mut localizer);
    let covariance = Matrix6::from_diagonal(&Vector6::from([2.25e-4; 6]));
    let measured = VisualPose { covariance, ..visual(4000, odometry(4000).pose) };
    let before = localizer.estimate();
    assert!(before.heading_sigma() > 0.019 && before.position_sigma() > 0.02, "{before:?}");
    (0..60).for_each(|_| assert!(localizer.correct_visual(&measured).is_applied()));
    let after = localizer.estimate();
    assert!((after.heading_sigma() - 0.015).abs() < 1e-6, "{}", after.heading_sigma());
    assert!(after.position_sigma() >= 0.015, "{}", after.position_sigma());
}

#[test]
fn weak_and_off_plane_poses_have_less_influence() {
    let pulled = |change: fn(&mut VisualPose)| {
        let mut localizer = localizer();
        driven(0, 1000, &mut localizer);
        localizer.correct_visual(&visual(0, Pose2::IDENTITY));
        let mut pose = visual(1000, odometry(1000).pose * Pose2::new(0.03, 0.0, 0.0));
        change(&mut pose);
        assert!(localizer.correct_visual(&pose).is_applied());
        gap(localizer.estimate().pose, odometry(1000).pose)
    };
    let usual = pulled(|_| {});
    let weak = pulled(|pose| pose.quality = VisualQuality::Weak);
    let unsure = pulled(|pose| pose.covariance = Matrix6::identity() * 0.01);
    let floating = pulled(|pose| pose.visual_from_camera.translation.y -= 0.2);
    assert!(usual > 0.01 && weak < 0.5 * usual && unsure < 0.5 * usual && floating < 0.5 * usual);
}

#[test]
fn invalid_measurements_are_rejected_with_the_reason() {
    let mut localizer = localizer();
    let here = visual(0, Pose2::IDENTITY);
    assert_eq!(localizer.correct_visual(&here), Correction::NoOdometry);
    driven(0, 4000, &mut localizer);
    assert!(matches!(localizer.correct_visual(&here), Correction::TooOld { by } if by > 1.5));
    assert_eq!(localizer.correct_visual(&visual(4000, odometry(4000).pose)), Correction::Anchored);
    assert!(matches!(localizer.correct_visual(&visual(4300, Pose2::IDENTITY)), Correction::TooNew { .. }));
    let broken = VisualPose { covariance: Matrix6::repeat(f64::NAN), ..here };
    assert_eq!(localizer.correct_visual(&broken), Correction::NotFinite);

    let before = localizer.estimate();
    let far = odometry(4000).pose * Pose2::new(0.0, 0.5, 0.0);
    let rejected = localizer.correct_scan(&matched(at(4000), far, Matrix3::identity() * 1e-4));
    assert!(matches!(rejected, Correction::Gated { distance } if distance > 4.0));
    assert_eq!(localizer.estimate(), before);

    assert!(matches!(localizer.predict(&odometry(3000)), Prediction::TimeWentBack { by } if by == 1.0));
    assert_eq!(localizer.predict(&odometry(4000)), Prediction::NothingNew);
    let broken = Odometry { covariance: Matrix3::repeat(f64::NAN), ..odometry(4020) };
    assert_eq!(localizer.predict(&broken), Prediction::NotFinite);
    assert_eq!(localizer.estimate(), before);
}

proptest! {
    #[test]
    fn a_delay_of_a_measurement_does_not_change_the_estimate(
        offsets in prop::collection::vec((-0.03..0.03, -0.03..0.03, -0.01..0.01), 6),
        delays in prop::collection::vec(0..20_i64, 6),
    ) {
        let measurement = |i: usize| {
            let (x, y, theta) = offsets[i];
            let ms = 200 + 200 * i as i64;
            (ms, odometry(ms).pose * Pose2::new(x, y, theta))
        };
        let noise = Matrix3::identity() * 1e-4;
        let run = |delay: &dyn Fn(usize) -> i64| {
            let mut localizer = localizer();
            for step in 0..=100 {
                localizer.predict(&odometry(step * 20));
                for i in 0..6 {
                    let (ms, pose) = measurement(i);
                    if step * 20 == ms + delay(i) * 20 {
                        assert!(localizer.correct_scan(&matched(at(ms), pose, noise)).is_applied());
                    }
                }
            }
            localizer.estimate()
        };
        let in_time = run(&|_| 0);
        let late = run(&|i| delays[i]);
        prop_assert!(gap(in_time.pose, late.pose) < 1e-9);
        prop_assert!((in_time.covariance - late.covariance).norm() < 1e-12);
    }

    #[test]
    fn a_measurement_between_two_readings_is_applied_at_its_stamp(ms in 1..999_i64) {
        let truth = |ms: i64| odometry(ms).pose;
        let mut localizer = localizer();
        driven(0, 1000, &mut localizer);
        prop_assert!(gap(localizer.pose_at(at(ms)).unwrap(), truth(ms)) < 1e-9);
        localizer.correct_scan(&matched(at(ms), truth(ms), Matrix3::identity() * 1e-4));
        prop_assert!(gap(localizer.estimate().pose, truth(1000)) < 1e-9);
    }
}

#[test]
fn a_measurement_may_be_ahead_of_the_odometry() {
    let mut localizer = localizer();
    driven(0, 1000, &mut localizer);
    assert!(localizer.correct_scan(&matched(at(1013), odometry(1013).pose, Matrix3::zeros())).is_applied());
    assert_eq!(localizer.estimate().stamp, at(1013));
    driven(1020, 2000, &mut localizer);
    assert!(gap(localizer.estimate().pose, odometry(2000).pose) < 1e-9);
}

#[test]
fn a_visual_frame_that_jumps_is_anchored_again_and_the_estimate_stays() {
    let mut localizer = localizer();
    let mut corrections = Vec::new();
    for ms in (0..=4000).step_by(20) {
        localizer.predict(&odometry(ms));
        if ms % 60 == 0 {
            let shift = if ms < 2000 { Pose2::IDENTITY } else { Pose2::new(0.4, 0.3, 0.1) };
            corrections.push(localizer.correct_visual(&visual(ms, shift * odometry(ms).pose)));
        }
    }
    assert_eq!(corrections.iter().filter(|c| matches!(c, Correction::Gated { .. })).count(), 7);
    assert_eq!(corrections.iter().filter(|c| **c == Correction::Reanchored).count(), 1);
    assert!(corrections.last().unwrap().is_applied());
    assert!(gap(localizer.estimate().pose, odometry(4000).pose) < 1e-6);
}

#[test]
fn wheels_that_spin_at_a_wall_do_not_move_the_estimate_away() {
    let mut localizer = localizer();
    let stuck = odometry(2000).pose;
    let mut recovered = 0;
    for ms in (0..=8000).step_by(20) {
        localizer.predict(&odometry(ms));
        let truth = if ms < 2000 { odometry(ms).pose } else { stuck };
        if ms % 60 == 0 {
            let correction = localizer.correct_visual(&visual(ms, truth));
            recovered += usize::from(matches!(correction, Correction::Recovered { .. }));
            assert_ne!(correction, Correction::Reanchored);
        }
        let off = localizer.estimate().pose.distance(&truth);
        assert!(off < 0.45, "{ms} ms: {off} m off");
    }
    assert!(localizer.estimate().pose.distance(&stuck) < 0.45, "{recovered} recoveries");
}

#[test]
fn the_camera_covariance_maps_to_the_base() {
    let covariance = planar_covariance(&(Matrix6::identity() * 1e-4), &base_from_camera());
    assert!((covariance[(2, 2)] - 1e-4).abs() < 1e-12);
    // The lever of 0.45 m adds the camera's rotation error to the position.
    assert!(covariance[(0, 0)] > 1.15e-4 && covariance[(0, 0)] < 1.25e-4, "{covariance}");
}

#[test]
fn a_kidnapped_robot_recovers_at_the_recognised_place() {
    let mut localizer = localizer();
    let carried_by = Pose2::new(2.0, -1.0, 1.5);
    for ms in (0..=4000).step_by(20) {
        localizer.predict(&odometry(ms));
        // No place is recognised in the first second after the kidnapping.
        if ms % 60 == 0 && !(2000..3000).contains(&ms) {
            let shift = if ms < 2000 { Pose2::IDENTITY } else { carried_by };
            let recognised = ms == 3000;
            let pose = VisualPose { recognised, ..visual(ms, shift * odometry(ms).pose) };
            let correction = localizer.correct_visual(&pose);
            assert_eq!(
                matches!(correction, Correction::Recovered { .. }),
                recognised,
                "{ms} ms: {correction:?}"
            );
        }
    }
    assert!(gap(localizer.estimate().pose, carried_by * odometry(4000).pose) < 0.05);
}

#[test]
fn each_visual_map_keeps_its_own_anchor() {
    let mut localizer = localizer();
    for ms in (0..=4000).step_by(20) {
        localizer.predict(&odometry(ms));
        if ms % 60 == 0 {
            let second = (1500..2700).contains(&ms);
            let shift = if second { Pose2::new(7.0, 5.0, 2.0) } else { Pose2::IDENTITY };
            let pose = VisualPose { map: u32::from(second), ..visual(ms, shift * odometry(ms).pose) };
            let correction = localizer.correct_visual(&pose);
            assert_eq!(correction == Correction::Anchored, ms == 0 || ms == 1500, "{ms} ms: {correction:?}");
        }
    }
    assert!(gap(localizer.estimate().pose, odometry(4000).pose) < 1e-6);
}

#[test]
fn scans_do_not_make_a_pose_more_certain_than_the_map() {
    let after_matches = |heading_deg: f64| {
        let mut localizer = Localizer::new(LocalizerConfig::default(), Pose3::identity()).unwrap();
        let mut odometry = odometry(0);
        localizer.predict(&odometry);
        // A turn by an uncertain gyro: the odometry's heading has a standard deviation of 2 deg.
        (odometry.stamp, odometry.covariance[(2, 2)]) = (at(20), 2_f64.to_radians().powi(2));
        localizer.predict(&odometry);
        let heading = heading_deg.to_radians();
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, heading * heading));
        let map = PoseUncertainty { covariance, ..PoseUncertainty::default() };
        for _ in 0..50 {
            let scan = ScanPose { map, ..matched(at(20), odometry.pose, Matrix3::zeros()) };
            assert!(localizer.correct_scan(&scan).is_applied());
        }
        localizer.estimate().heading_sigma().to_degrees()
    };
    assert!((after_matches(1.0) - 1.0).abs() < 1e-6, "{}", after_matches(1.0));
    let certain = LocalizerConfig::default().min_heading_sigma_deg;
    assert!((after_matches(0.0) - certain).abs() < 1e-6, "{}", after_matches(0.0));
    assert!(after_matches(5.0) <= 2.0, "a worse map takes no certainty away");
}

/// Scale error of the turns in the tests below, and its standard deviation, ratio.
const SCALE_ERROR: f64 = 0.005;

/// A turn on the spot of `turns` revolutions by a gyro with [`SCALE_ERROR`], with a scan match at every 0.1 rad against the map that is drawn
/// on the way: walls 2 m away, seen 35 deg to both sides. Returns the error of the heading, and its standard deviation by the scale, deg.
fn turn_with_scale_error(turns: f64) -> (f64, f64) {
    let mut localizer = Localizer::new(LocalizerConfig::default(), Pose3::identity()).unwrap();
    localizer.set_turn_scale_sigma(SCALE_ERROR);
    // The same tiles hold the uncertainty of the map, and its true displacement.
    let (mut map, mut displacement) = (MapUncertainty::default(), MapUncertainty::default());
    let mut result = (0.0, 0.0);
    for step in 0..=(turns * std::f64::consts::TAU / 0.1).round() as i64 {
        let (turned, stamp) = (0.1 * step as f64, at(200 * step));
        let truth = Pose2::new(0.0, 0.0, turned);
        let odometry = Pose2::new(0.0, 0.0, turned * (1.0 + SCALE_ERROR));
        let covariance = Matrix3::zeros();
        localizer.predict(&Odometry { stamp, pose: odometry, twist: Twist2::ZERO, covariance });
        let hits = || {
            let wall = |i| Pose2::new(0.0, 0.0, 0.1 * f64::from(i)).transform(Vector2::new(2.0, 0.0));
            (-6..=6).map(wall).map(|hit| truth.transform(hit))
        };
        let seen = truth * Pose2::exp(displacement.at(truth, hits()).unwrap_or_default().scale_error);
        let scan = ScanPose {
            map: map.at(truth, hits()).unwrap_or_default(),
            ..matched(stamp, seen, Matrix3::zeros())
        };
        assert!(localizer.correct_scan(&scan).is_applied());
        let (pose, uncertainty) =
            (localizer.pose_at(stamp).unwrap(), localizer.uncertainty_at(stamp).unwrap());
        map.note(truth, &uncertainty, hits());
        let error = PoseUncertainty { scale_error: (truth.inverse() * pose).log(), covariance };
        displacement.note(truth, &error, hits());
        result = (error.scale_error.z.to_degrees(), uncertainty.scale_error.z.to_degrees());
    }
    result
}

#[test]
fn a_map_drawn_during_a_turn_has_the_error_of_the_turn() {
    for turns in [0.1, 0.25, 0.5, 0.75, 1.1] {
        let (error, sigma) = turn_with_scale_error(turns);
        assert!((error - sigma).abs() < 0.05 * sigma, "{turns} turns: {error} deg, sigma {sigma} deg");
    }
}

#[test]
fn the_first_part_of_the_map_reduces_the_error_of_a_turn() {
    let ((_, before), (_, after)) = (turn_with_scale_error(0.75), turn_with_scale_error(1.1));
    assert!(before > 0.3, "{before} deg");
    assert!(after < 0.7 * before, "{before} deg before the first walls are seen again, {after} deg after");
}
