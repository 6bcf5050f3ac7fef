//! The charging station's pose by contact: ahead of the front, facing the robot.

use super::*;
use crate::config::RobotConfig;

fn station() -> ChargingStation {
    let robot = RobotConfig::default();
    ChargingStation::new(robot.station, &robot.footprint().unwrap()).unwrap()
}

#[test]
fn a_docked_robot_touches_the_station_with_its_front_and_faces_it() {
    for theta in [0.0, 1.2, -2.9] {
        let (mut station, pose) = (station(), Pose2::new(2.0, -1.0, theta));
        station.add_contact(pose);
        let found = station.estimate().unwrap();
        let by_robot = pose.inverse() * found.pose;
        assert!((by_robot.x - 0.1755).abs() < 0.02 && by_robot.y.abs() < 0.02, "{by_robot:?}");
        assert!((by_robot.theta.abs() - PI).abs() < 0.05, "its front faces the robot: {by_robot:?}");
        assert!(found.lateral_sigma(0.1755) < 0.05 && found.heading_sigma() < 0.2, "{found:?}");
    }
}

#[test]
fn a_dropped_station_is_unknown_and_a_restored_one_is_where_it_was() {
    let mut first = station();
    assert!(first.estimate().is_none());
    first.add_contact(Pose2::new(2.0, -1.0, 0.7));
    let saved = first.estimate().unwrap();
    first.forget();
    assert!(first.estimate().is_none());
    let mut second = station();
    second.restore(&saved);
    let restored = second.estimate().unwrap();
    assert!(restored.pose.distance(&saved.pose) < 0.02, "{restored:?} {saved:?}");
    assert!((restored.heading_sigma() - saved.heading_sigma()).abs() < 0.3 * saved.heading_sigma());
}
