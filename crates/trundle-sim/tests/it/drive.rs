use super::{almost_blind, block, hall};
use trundle_core::{DifferentialDrive, Pose2, RobotBody, SensorEvent, Twist2, WheelTicks};
use trundle_sim::{Scene, SimConfig, SimError, Simulator, World};

/// Wheels and gyro, integrated as an odometry would.
#[derive(Default)]
struct Listener {
    last: Option<WheelTicks>,
    odom: Pose2,
    gyro_turn: f64,
    touches: Vec<bool>,
}

impl Listener {
    /// Drives with `twist` for `seconds` and listens.
    fn drive(&mut self, robot: &mut Simulator, twist: Twist2, seconds: f64) {
        robot.command(twist).unwrap();
        let end = robot.stamp().after(seconds);
        while robot.stamp() < end {
            match robot.next_event().unwrap().unwrap() {
                SensorEvent::Wheels(ticks) => self.roll(ticks),
                SensorEvent::Gyro(gyro) => self.gyro_turn += gyro.omega * 0.02,
                SensorEvent::Touch(touch) => self.touches.push(touch.pressed),
                _ => {}
            }
            assert!(robot.clearance() >= 0.0, "{} m", robot.clearance());
        }
    }

    fn roll(&mut self, ticks: WheelTicks) {
        if let Some(last) = self.last.replace(ticks) {
            let drive = DifferentialDrive::KOBUKI;
            let way =
                |now: u16, before: u16| f64::from(now.wrapping_sub(before) as i16) * drive.metres_per_tick();
            let twist = drive.twist(way(ticks.left, last.left), way(ticks.right, last.right));
            self.odom = self.odom.advance(twist, 1.0);
        }
    }
}

/// A square of 1 m: what speeds up also slows down, so each leg is speed times time.
fn drive_square(robot: &mut Simulator) -> Listener {
    let mut listener = Listener::default();
    for _ in 0..4 {
        listener.drive(robot, Twist2::new(0.4, 0.0), 2.5);
        listener.drive(robot, Twist2::ZERO, 1.0);
        listener.drive(robot, Twist2::new(0.0, std::f64::consts::FRAC_PI_4), 2.0);
        listener.drive(robot, Twist2::ZERO, 1.0);
    }
    listener
}

#[test]
fn without_noise_a_square_closes_and_odometry_agrees() {
    let start = Pose2::new(-0.5, -0.5, 0.3);
    let mut robot = Simulator::new(hall(start), almost_blind().without_noise(), 1).unwrap();
    let listener = drive_square(&mut robot);
    let end = start.inverse() * robot.true_pose();
    assert!(end.position().norm() < 1e-3 && end.theta.abs() < 1e-3, "{end:?}");
    assert!((robot.path_length() - 4.0).abs() < 1e-3, "{}", robot.path_length());
    let gap = listener.odom.inverse() * end;
    assert!(gap.position().norm() < 2e-3 && gap.theta.abs() < 2e-3, "{gap:?}");
    assert!((listener.gyro_turn - std::f64::consts::TAU).abs() < 1e-3, "{}", listener.gyro_turn);
}

#[test]
fn with_noise_odometry_drifts_but_not_much() {
    let start = Pose2::new(-0.5, -0.5, 0.0);
    let mut worst = 0.0_f64;
    for seed in 0..4 {
        let mut robot = Simulator::new(hall(start), almost_blind(), seed).unwrap();
        let listener = drive_square(&mut robot);
        let gap = listener.odom.inverse() * start.inverse() * robot.true_pose();
        assert!(gap.position().norm() > 1e-4 && gap.position().norm() < 0.25, "{gap:?}");
        worst = worst.max(gap.position().norm());
    }
    assert!(worst > 0.01, "{worst}");
}

#[test]
fn a_wall_stops_the_robot_and_backing_off_frees_it() {
    let mut robot = Simulator::new(hall(Pose2::new(2.0, 0.5, 0.2)), almost_blind(), 5).unwrap();
    let mut listener = Listener::default();
    listener.drive(&mut robot, Twist2::new(0.5, 0.0), 4.0);
    assert_eq!((robot.contacts(), listener.touches.as_slice()), (1, [true].as_slice()));
    assert!((robot.true_pose().x - (3.0 - 0.1755)).abs() < 1e-3);
    listener.drive(&mut robot, Twist2::new(-0.3, 0.0), 2.0);
    assert_eq!((robot.contacts(), listener.touches.as_slice()), (1, [true, false].as_slice()));
    assert!(robot.clearance() > 0.3);
    listener.drive(&mut robot, Twist2::new(0.5, 0.0), 4.0);
    assert_eq!(robot.contacts(), 2);
}

#[test]
fn no_way_of_driving_gets_into_a_box() {
    let mut scene = hall(Pose2::IDENTITY);
    let mut solids = scene.world.solids().to_vec();
    solids.push(block([0.8, 0.3, 0.2], [0.5, 0.5, 0.4], 0.4));
    solids.push(block([-0.4, -0.9, 0.55], [0.8, 0.6, 0.05], 0.1));
    scene.world = World::new(solids, 1).unwrap();
    let mut robot = Simulator::new(scene, almost_blind(), 2).unwrap();
    let mut listener = Listener::default();
    for i in 0..40 {
        let v = if i % 4 == 3 { -0.4 } else { 0.6 };
        listener.drive(&mut robot, Twist2::new(v, f64::from(i % 7) - 3.0), 1.0);
    }
    assert!(robot.contacts() > 2);
}

#[test]
fn a_command_that_is_no_number_stops_the_robot_and_is_reported() {
    let mut robot = Simulator::new(hall(Pose2::IDENTITY), almost_blind(), 1).unwrap();
    Listener::default().drive(&mut robot, Twist2::new(0.4, 0.0), 1.0);
    let error = robot.command(Twist2::new(f64::NAN, 0.1)).unwrap_err();
    assert!(matches!(error, SimError::CommandNotFinite { omega: 0.1, .. }), "{error}");
    assert_eq!(robot.refused_commands(), 1);
    while robot.stamp().as_secs() < 3.0 {
        robot.next_event().unwrap();
    }
    let rest = robot.true_pose();
    while robot.stamp().as_secs() < 4.0 {
        robot.next_event().unwrap();
    }
    assert!(rest.distance(&robot.true_pose()) < 1e-6);
}

#[test]
fn bad_starts_and_configurations_are_refused_with_their_numbers() {
    let refused =
        |start: Pose2, config: SimConfig| Simulator::new(hall(start), config, 1).unwrap_err().to_string();
    let in_wall = refused(Pose2::new(2.9, 0.0, 0.0), almost_blind());
    assert!(in_wall.contains("'hall' at (2.900, 0.000) m is 0.075 m inside"), "{in_wall}");
    let nowhere = refused(Pose2 { x: f64::NAN, ..Pose2::IDENTITY }, almost_blind());
    assert!(nowhere.contains("pose x is NaN m"), "{nowhere}");
    let too_fast = refused(Pose2::IDENTITY, SimConfig { camera_rate_hz: 0.0, ..almost_blind() });
    assert!(too_fast.contains("camera_rate_hz is 0 Hz"), "{too_fast}");
    assert!(
        Scene::by_name("moon", 1).unwrap_err().to_string().contains("scene is moon, expected one of demo")
    );
}
