//! Laws of the estimator.

use super::*;
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_core::{DockBeams, DockInfrared, Pose2, difference_of_angles};

/// Light of the default geometry with sharp edges, as an independent closed form.
fn light(station_from_base: Pose2) -> DockInfrared {
    let at = |bearing_deg: f64| {
        let (s, c) = bearing_deg.to_radians().sin_cos();
        let receiver = station_from_base * Pose2::new(0.15 * c, 0.15 * s, bearing_deg.to_radians());
        let (range, bearing) = (receiver.position().norm(), receiver.y.atan2(receiver.x).to_degrees());
        let off = difference_of_angles((-receiver.y).atan2(-receiver.x), receiver.theta).to_degrees();
        let is_seen = off.abs() < 60.0 && bearing.abs() < 60.0 && range < 3.0;
        let near = range < 1.0;
        let sector = if !is_seen {
            9
        } else if bearing > 10.0 {
            0
        } else if bearing < -10.0 {
            2
        } else {
            1
        };
        DockBeams {
            near_left: near && sector == 0,
            near_center: near && sector == 1,
            near_right: near && sector == 2,
            far_left: !near && sector == 0,
            far_center: !near && sector == 1,
            far_right: !near && sector == 2,
        }
    };
    DockInfrared { left: at(60.0), center: at(0.0), right: at(-60.0) }
}

/// The estimate after a path of poses in the station's frame; `station` is the station's pose in the map.
fn after(station: Pose2, seed: u64, path: &[Pose2]) -> Option<StationEstimate> {
    let mut estimator = StationEstimator::new(StationLightConfig::default(), seed).unwrap();
    for pose in path {
        estimator.add_light(station * *pose, &light(*pose));
    }
    estimator.estimate()
}

/// A turn on the spot.
fn spin(x: f64, y: f64) -> Vec<Pose2> {
    (0..380).map(|deg| Pose2::new(x, y, f64::from(deg).to_radians())).collect()
}

/// A path across the axis at a distance and back, then a turn nearer to the station.
fn survey() -> Vec<Pose2> {
    let across = |x: f64, heading: f64| {
        (-35..=35).map(move |i| Pose2::new(x, 0.01 * f64::from(i) * heading.signum(), heading))
    };
    let sweep = (0..200).map(|i| Pose2::new(0.6, 0.0, PI + 1.2 * (0.0314 * f64::from(i)).sin()));
    spin(1.5, 0.4)
        .into_iter()
        .chain(across(1.1, FRAC_PI_2))
        .chain(across(1.0, -FRAC_PI_2))
        .chain(sweep)
        .collect()
}

#[test]
fn without_light_there_is_no_estimate() {
    assert_eq!(after(Pose2::IDENTITY, 1, &spin(5.0, 0.0)), None, "out of range");
    assert_eq!(after(Pose2::IDENTITY, 1, &spin(-1.0, 0.0)), None, "behind it");
}

#[test]
fn a_turn_on_the_spot_gives_the_bearing_and_the_field() {
    let station = Pose2::new(2.0, -1.0, 0.7);
    for (x, y) in [(1.8, 0.0), (1.5, 0.8), (2.2, -0.9), (0.7, 0.1)] {
        let estimate = after(station, 3, &spin(x, y)).unwrap();
        let robot = station.transform(trundle_core::Vector2::new(x, y));
        let bearing = |pose: Pose2| (pose.y - robot.y).atan2(pose.x - robot.x);
        let error = difference_of_angles(bearing(estimate.pose), bearing(station)).to_degrees();
        assert!(error.abs() < 12.0, "({x}, {y}): {error} deg");
        assert!(estimate.pose.distance(&station) < 1.0, "({x}, {y}): {:?}", estimate.pose);
    }
}

#[test]
fn crossing_the_axis_at_two_distances_gives_the_axis() {
    for (seed, station) in
        [(1, Pose2::IDENTITY), (2, Pose2::new(-3.0, 2.0, 2.5)), (3, Pose2::new(1.0, 4.0, -1.2))]
    {
        let estimate = after(station, seed, &survey()).unwrap();
        let error = station.inverse() * estimate.pose;
        // Pose of a docked robot on the estimated axis.
        let docked = error * Pose2::new(0.18, 0.0, PI);
        let heading = difference_of_angles(docked.theta, PI).to_degrees();
        assert!(docked.y.abs() < 0.012 && heading.abs() < 1.5, "seed {seed}: {} m, {heading} deg", docked.y);
        assert!(error.x.abs() < 0.08, "seed {seed}: {} m along the axis", error.x);
        assert!(
            estimate.lateral_sigma(0.18) < 0.02,
            "seed {seed}: it is sure: {}",
            estimate.lateral_sigma(0.18)
        );
    }
}

#[test]
fn the_reported_uncertainty_is_the_true_one() {
    // The first turn does not determine the distance; the survey does.
    let rough = after(Pose2::IDENTITY, 5, &spin(2.0, 0.6)).unwrap();
    let fine = after(Pose2::IDENTITY, 5, &survey()).unwrap();
    assert!(rough.distance_sigma() > 3.0 * fine.distance_sigma());
    assert!(rough.heading_sigma() > 3.0 * fine.heading_sigma());
    assert!(rough.pose.position().norm() < 4.0 * (rough.distance_sigma() + rough.lateral_sigma(0.0)));
}

#[test]
fn the_same_readings_give_the_same_estimate_and_a_standing_robot_adds_nothing() {
    assert_eq!(after(Pose2::IDENTITY, 5, &survey()), after(Pose2::IDENTITY, 5, &survey()));
    let mut path = survey();
    let last = *path.last().unwrap();
    path.extend(vec![last; 500]);
    assert_eq!(after(Pose2::IDENTITY, 5, &path), after(Pose2::IDENTITY, 5, &survey()));
}

#[test]
fn contact_gives_the_pose_whatever_was_believed() {
    let (wrong, station) = (Pose2::new(5.0, 5.0, 0.0), Pose2::new(1.0, 2.0, 0.5));
    let mut estimator = StationEstimator::new(StationLightConfig::default(), 1).unwrap();
    survey().iter().for_each(|pose| estimator.add_light(wrong * *pose, &light(*pose)));
    estimator.add_contact(station);
    let estimate = estimator.estimate().unwrap();
    assert!(estimate.pose.distance(&station) < 0.002 && estimate.lateral_sigma(0.0) < 0.01);
    let mut resumed = StationEstimator::new(StationLightConfig::default(), 9).unwrap();
    resumed.restore(&estimate);
    assert!(resumed.estimate().unwrap().pose.distance(&station) < 0.003);
    resumed.forget();
    assert_eq!(resumed.estimate(), None);
}

#[test]
fn a_station_that_was_moved_is_found_again() {
    let (old, new) = (Pose2::IDENTITY, Pose2::new(0.0, 2.5, 0.0));
    let mut estimator = StationEstimator::new(StationLightConfig::default(), 1).unwrap();
    survey().iter().for_each(|pose| estimator.add_light(old * *pose, &light(*pose)));
    survey().iter().for_each(|pose| estimator.add_light(new * *pose, &light(*pose)));
    let estimate = estimator.estimate().unwrap();
    assert!(estimate.pose.distance(&new) < 0.1, "{:?}", estimate.pose);
}

#[test]
fn each_number_of_the_light_is_checked_by_name() {
    let config = StationLightConfig { near_range: f64::NAN, ..StationLightConfig::default() };
    assert_eq!(StationEstimator::new(config, 1).unwrap_err().field, "station.near_range");
}
