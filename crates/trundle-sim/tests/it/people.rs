//! Simulated people and the robot.

use super::{almost_blind, hall};
use trundle_core::{Pose2, RobotBody, Scan, SensorEvent, Twist2, Vector2};
use trundle_sim::{LaserConfig, Person, Scene, SimConfig, Simulator};

fn with_people(start: Pose2, people: Vec<Person>) -> Scene {
    Scene { people, ..hall(start) }
}

fn walker(waypoints: &[[f64; 2]]) -> Person {
    Person { waypoints: waypoints.to_vec(), speed: 1.0, ..Person::default() }
}

fn quiet() -> SimConfig {
    let mut config = almost_blind().without_noise();
    config.has_camera = false;
    config
}

/// Runs for `seconds`; the robot and the people never overlap.
fn run(robot: &mut Simulator, seconds: f64, mut each: impl FnMut(&Simulator)) {
    let end = robot.stamp().after(seconds);
    while robot.stamp() < end {
        robot.next_event().unwrap();
        assert!(robot.clearance() > 0.0, "{} m at {}", robot.clearance(), robot.stamp());
        each(robot);
    }
}

#[test]
fn a_person_waits_for_a_robot_in_the_way_and_goes_on_when_it_left() {
    let scene = with_people(Pose2::new(0.0, 0.0, 1.57), vec![walker(&[[-2.0, 0.0], [2.0, 0.0]])]);
    let mut robot = Simulator::new(scene, quiet(), 1).unwrap();
    let mut farthest = -2.0_f64;
    run(&mut robot, 6.0, |robot| farthest = farthest.max(robot.people()[0].x));
    assert!((-1.3..-0.6).contains(&farthest), "{farthest}");
    robot.command(Twist2::new(0.4, 0.0)).unwrap();
    run(&mut robot, 4.0, |_| {});
    robot.command(Twist2::ZERO).unwrap();
    run(&mut robot, 4.0, |robot| farthest = farthest.max(robot.people()[0].x));
    assert!((farthest - 2.0).abs() < 0.01, "{farthest}");
    assert_eq!(robot.contacts(), 0);
}

#[test]
fn a_robot_that_drives_into_a_person_is_stopped_by_the_legs() {
    let scene = with_people(Pose2::IDENTITY, vec![walker(&[[1.5, 0.1]])]);
    let mut robot = Simulator::new(scene, quiet(), 1).unwrap();
    robot.command(Twist2::new(0.5, 0.0)).unwrap();
    run(&mut robot, 5.0, |_| {});
    assert_eq!(robot.contacts(), 1);
    // The person faces along x: a leg (5.5 cm) is 0.1 m from (1.5, 0.1), at (1.5, 0).
    let reach = robot.true_pose().distance(&Pose2::new(1.5, 0.0, 0.0));
    assert!((reach - 0.1755 - 0.065).abs() < 2e-3, "the knee is the thickest part below 0.6 m: {reach}");
}

#[test]
fn no_way_of_driving_among_people_overlaps_them() {
    let people = vec![
        walker(&[[-2.0, -1.0], [2.0, 1.0], [2.0, -1.0]]),
        Person { around: true, speed: 1.6, ..walker(&[[0.0, 2.0], [1.0, 2.0], [0.5, -2.0]]) },
        Person { pause: 1.0, ..walker(&[[-1.5, 2.0], [-1.5, -2.0]]) },
    ];
    let mut robot = Simulator::new(with_people(Pose2::IDENTITY, people), quiet(), 1).unwrap();
    for i in 0..60 {
        let v = if i % 4 == 3 { -0.4 } else { 0.6 };
        robot.command(Twist2::new(v, f64::from(i % 7) - 3.0)).unwrap();
        run(&mut robot, 1.0, |_| {});
    }
    assert!(robot.contacts() > 2, "{}", robot.contacts());
}

fn next_scan(robot: &mut Simulator) -> (Scan, Pose2) {
    loop {
        if let Some(SensorEvent::Scan(scan)) = robot.next_event().unwrap() {
            return (scan, robot.people()[0]);
        }
    }
}

#[test]
fn the_laser_sees_two_legs_that_swing() {
    let mut config = LaserConfig::default();
    config.beams = 3600;
    let laser = Some(config);
    let scene = with_people(Pose2::IDENTITY, vec![walker(&[[1.5, -2.0], [1.5, 2.0]])]);
    let mut sim = quiet();
    sim.laser = laser;
    let mut robot = Simulator::new(scene, sim, 1).unwrap();
    let (mut widest, mut narrowest) = (0.0_f64, f64::INFINITY);
    for _ in 0..30 {
        let (scan, person) = next_scan(&mut robot);
        let at_person = |p: &Vector2| (p - person.position()).norm() < 0.6;
        let points: Vec<Vector2> = scan.hits().filter(at_person).collect();
        assert!(points.len() > 20, "{}", points.len());
        // Every point is on a shin: on a circle of 5.5 cm radius, 10 cm from the path.
        for p in &points {
            let side = (p - person.position()).dot(&Vector2::x()).abs();
            assert!((0.045 - 1e-6..0.155 + 1e-6).contains(&side), "{side}");
        }
        let along = points.iter().map(|p| p.y);
        let width = along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min);
        (widest, narrowest) = (widest.max(width), narrowest.min(width));
    }
    assert!(widest > 0.6 && narrowest < 0.3, "{widest} {narrowest}");
}

#[test]
fn the_same_walk_every_time() {
    let walk = || {
        let people = vec![walker(&[[-2.0, 0.3], [2.0, 0.3], [0.0, 2.0]])];
        let mut robot = Simulator::new(with_people(Pose2::IDENTITY, people), quiet(), 1).unwrap();
        robot.command(Twist2::new(0.2, 0.7)).unwrap();
        let mut poses = Vec::new();
        run(&mut robot, 8.0, |robot| poses.push(robot.people()[0]));
        poses
    };
    assert!(walk() == walk());
}

#[test]
fn people_in_walls_and_robots_in_people_are_refused_by_name() {
    let refused = |start: Pose2, person: Person| {
        Simulator::new(with_people(start, vec![person]), quiet(), 1).unwrap_err().to_string()
    };
    let message = refused(Pose2::IDENTITY, walker(&[[1.0, 0.0], [2.9, 0.0]]));
    assert!(
        message.contains("way of person 0 from way-point 0 to 1 is through something at (2.8"),
        "{message}"
    );
    let message = refused(Pose2::IDENTITY, walker(&[[0.1, 0.0]]));
    assert!(message.contains("start of scene 'hall' at (0.000, 0.000) m"), "{message}");
    let message = refused(Pose2::IDENTITY, Person { speed: f64::NAN, ..walker(&[[2.0, 0.0]]) });
    assert!(message.contains("speed of a person 0 is NaN"), "{message}");
}
