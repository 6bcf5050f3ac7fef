//! The drive and its odometry against closed forms.

use super::{almost_blind, block, hall, shared_data};
use trundle_core::{DifferentialDrive, Footprint, Pose2, RobotBody, SensorEvent, Twist2, WheelTicks};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{
    CommandScript, Following, HeightBand, KobukiConfig, Scene, SimConfig, SimError, Simulator,
    WaypointFollower, World,
};

/// Wheels and gyro, integrated as an odometry would.
#[derive(Default)]
struct Listener {
    last: Option<WheelTicks>,
    odom: Pose2,
    gyro_turn: f64,
    touches: Vec<bool>,
    cliffs: Vec<bool>,
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
                SensorEvent::Cliff(cliff) => self.cliffs.push(cliff.over_edge),
                _ => {}
            }
            assert!(robot.clearance() >= 0.0, "{} m", robot.clearance());
        }
    }

    fn roll(&mut self, ticks: WheelTicks) {
        if let Some(last) = self.last.replace(ticks) {
            let drive = DifferentialDrive::KOBUKI;
            let distance =
                |now: u16, before: u16| f64::from(now.wrapping_sub(before) as i16) * drive.metres_per_tick();
            let twist = drive.twist(distance(ticks.left, last.left), distance(ticks.right, last.right));
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
    assert!(gap.position().norm() < 1e-3 && gap.theta.abs() < 1e-3, "{gap:?}");
    assert!((listener.gyro_turn - std::f64::consts::TAU).abs() < 1e-3, "{}", listener.gyro_turn);
}

#[test]
fn unequal_wheels_drive_the_arcs_of_their_radii() {
    let mut kobuki = KobukiConfig::default().without_noise();
    (kobuki.wheel_radius_error, kobuki.wheelbase_error) = (0.02, 0.02);
    let start = Pose2::new(-0.5, -0.5, 0.3);
    for seed in 0..3 {
        let mut config = almost_blind().without_noise();
        config.kobuki = kobuki.clone();
        let mut robot = Simulator::new(hall(start), config, seed).unwrap();
        let wheels = robot.true_wheels();
        let listener = drive_square(&mut robot);
        // Both wheels have equal ramps and lags: each leg is one arc at any speed.
        let arc = |left: f64, right: f64| {
            let (left, right) = (left * wheels.left_radius / 0.035, right * wheels.right_radius / 0.035);
            Twist2::new((left + right) / 2.0, (right - left) / wheels.wheelbase)
        };
        let quarter = std::f64::consts::FRAC_PI_2 * 0.230 / 2.0;
        let leg = |pose: Pose2| pose.advance(arc(1.0, 1.0), 1.0).advance(arc(-quarter, quarter), 1.0);
        let closed_form = leg(leg(leg(leg(start))));
        let gap = closed_form.inverse() * robot.true_pose();
        assert!(gap.position().norm() < 1e-3 && gap.theta.abs() < 1e-3, "{gap:?}");
        let drift = start.inverse() * robot.true_pose();
        assert!(drift.position().norm() > 0.01, "{drift:?}");
        assert!(listener.odom.position().norm() < 1e-3 && listener.odom.theta.abs() < 1e-3);
        assert!((wheels.left_radius - 0.035).abs() > 1e-5 && (wheels.wheelbase - 0.230).abs() > 1e-5);
    }
}

#[test]
fn saturation_keeps_the_curve() {
    let mut robot = Simulator::new(hall(Pose2::IDENTITY), almost_blind().without_noise(), 1).unwrap();
    let mut listener = Listener::default();
    listener.drive(&mut robot, Twist2::new(4.0, 8.0), 2.0);
    let before = robot.true_pose();
    listener.drive(&mut robot, Twist2::new(4.0, 8.0), 0.1);
    let tangent = (before.inverse() * robot.true_pose()).log();
    assert!((tangent.z / tangent.x - 2.0).abs() < 1e-6, "{tangent}");
    let right = tangent.x + tangent.z * 0.115;
    assert!((right / 0.1 - 0.70).abs() < 1e-6, "{right}");
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
fn a_long_body_off_its_wheels_touches_with_its_nose_and_its_tail() {
    let mut kobuki = KobukiConfig::default();
    kobuki.footprint = Some(vec![[0.5, 0.1], [0.5, -0.1], [-0.1, -0.15], [-0.1, 0.15]]);
    let mut config = almost_blind();
    config.kobuki = kobuki;
    let mut robot = Simulator::new(hall(Pose2::new(2.0, 0.0, 0.0)), config, 1).unwrap();
    let mut listener = Listener::default();
    listener.drive(&mut robot, Twist2::new(0.5, 0.0), 3.0);
    assert!((robot.true_pose().x - 2.5).abs() < 2e-3, "{:?}", robot.true_pose());
    // The robot cannot turn with its front at the wall; after backing off it turns until its rear touches.
    listener.drive(&mut robot, Twist2::new(0.0, 1.0), 1.0);
    assert!(robot.true_pose().theta.abs() < 0.05, "{:?}", robot.true_pose());
    listener.drive(&mut robot, Twist2::new(-0.3, 0.0), 1.0);
    listener.drive(&mut robot, Twist2::new(0.0, 1.0), 3.3);
    listener.drive(&mut robot, Twist2::new(-0.5, 0.0), 3.0);
    assert!((robot.true_pose().x - 2.87).abs() < 0.05, "{:?}", robot.true_pose());
    assert_eq!(listener.touches, [true, false, true]);
}

#[test]
fn an_edge_and_a_hole_in_the_floor_are_cliffs() {
    let mut scene = hall(Pose2::new(-2.0, 0.0, 0.0));
    // Floor up to x = 0, 3 cm lower up to x = 1, then a pit.
    let floors =
        [block([-2.0, 0.0, -0.05], [4.0, 8.0, 0.1], 0.0), block([0.5, 0.0, -0.08], [1.0, 8.0, 0.1], 0.0)];
    scene.world = World::new(floors.to_vec(), 1).unwrap();
    let mut robot = Simulator::new(scene, almost_blind().without_noise(), 1).unwrap();
    let mut listener = Listener::default();
    listener.drive(&mut robot, Twist2::new(0.5, 0.0), 5.0);
    assert!(robot.true_pose().x > 0.3 && listener.cliffs.is_empty(), "3 cm are not a cliff");
    listener.drive(&mut robot, Twist2::new(0.2, 0.0), 1.5);
    let front = robot.true_pose().x + 0.156;
    assert!(front < 1.0 || listener.cliffs == [true], "{front}");
    listener.drive(&mut robot, Twist2::new(0.2, 0.0), 1.5);
    assert_eq!(listener.cliffs, [true]);
    listener.drive(&mut robot, Twist2::new(-0.4, 0.0), 2.0);
    assert_eq!(listener.cliffs, [true, false]);
}

#[test]
fn a_base_that_times_out_stops_without_commands() {
    let mut kobuki = KobukiConfig::default().without_noise();
    kobuki.command_timeout = 0.6;
    let mut config = almost_blind();
    config.kobuki = kobuki;
    let mut robot = Simulator::new(hall(Pose2::IDENTITY), config, 1).unwrap();
    let mut listener = Listener::default();
    listener.drive(&mut robot, Twist2::new(0.3, 0.0), 2.0);
    // The ramps up and down are alike: speed times the time from command to time-out.
    assert!((robot.true_pose().x - 0.3 * 0.6).abs() < 1e-3, "{:?}", robot.true_pose());
}

#[test]
fn a_script_drives_by_the_clock() {
    let script = CommandScript::parse("0 0.4 0\n2.5 0 0\n4 0 0\n").unwrap();
    let mut robot = Simulator::new(hall(Pose2::IDENTITY), almost_blind().without_noise(), 1).unwrap();
    while robot.stamp().as_secs() < script.duration() {
        robot.command(script.at(robot.stamp().as_secs())).unwrap();
        robot.next_event().unwrap();
    }
    assert!((robot.true_pose().x - 1.0).abs() < 1e-3, "{:?}", robot.true_pose());
}

/// Drives until the follower is done; seconds.
fn follow(robot: &mut Simulator, follower: &mut WaypointFollower) -> f64 {
    while matches!(follower.state(), Following::Driving { .. }) {
        if let Some(SensorEvent::Truth { stamp, pose }) = robot.next_event().unwrap() {
            robot.command(follower.step(stamp, pose)).unwrap();
            assert!(stamp.as_secs() < 120.0, "{pose:?}");
        }
    }
    robot.stamp().as_secs()
}

#[test]
fn a_follower_gets_to_its_waypoints_on_wheels_that_slip() {
    let text = "1 0.5 90\n1 2 -135\n-1.5 -1.5 10\n-1.5 -1.4 100 # a small move\n";
    for seed in 0..4 {
        let mut robot = Simulator::new(hall(Pose2::new(-1.0, 0.0, 2.5)), almost_blind(), seed).unwrap();
        let mut follower = WaypointFollower::parse(text).unwrap();
        let seconds = follow(&mut robot, &mut follower);
        assert_eq!(follower.state(), Following::Arrived);
        robot.command(Twist2::ZERO).unwrap();
        while robot.stamp().as_secs() < seconds + 1.0 {
            robot.next_event().unwrap();
        }
        let gap = follower.waypoints()[3].inverse() * robot.true_pose();
        assert!(gap.position().norm() < 0.01 && gap.theta.abs() < 1_f64.to_radians(), "{gap:?}");
        assert_eq!(robot.contacts(), 0);
    }
}

#[test]
fn a_follower_says_that_it_is_blocked() {
    let mut robot = Simulator::new(hall(Pose2::new(2.0, 0.0, 0.0)), almost_blind(), 1).unwrap();
    let mut follower = WaypointFollower::parse("2.5 0 0\n3.5 0 0").unwrap();
    follow(&mut robot, &mut follower);
    assert_eq!(follower.state(), Following::Blocked { waypoint: 1 });
}

/// A scene from the shared house, the robot in the first free place of a coarse grid; `None` if the file is absent.
fn small_house() -> Option<Scene> {
    let mesh = gltf(&shared_data("scenes/small_house.glb")?, &GltfOptions::z_up()).unwrap().mesh;
    let world = World::with_meshes(Vec::new(), vec![mesh], 1).unwrap();
    let obstacles = world.obstacles(HeightBand::new(0.012, 0.6).unwrap());
    let places =
        (0..400).map(|i| Pose2::new(f64::from(i % 20) * 0.5 - 5.0, f64::from(i / 20) * 0.5 - 5.0, 0.0));
    let start = places.into_iter().find(|place| obstacles.clearance(&Footprint::KOBUKI, *place) > 0.3)?;
    Some(Scene { name: "small_house".into(), world, ..hall(start) })
}

#[test]
fn in_a_house_of_triangles_no_way_of_driving_gets_into_anything() {
    let Some(scene) = small_house() else { return };
    let mut config = SimConfig::default();
    config.has_camera = false;
    let mut robot = Simulator::new(scene, config, 3).unwrap();
    let mut listener = Listener::default();
    for i in 0..60 {
        let v = if i % 5 == 4 { -0.4 } else { 0.6 };
        listener.drive(&mut robot, Twist2::new(v, f64::from(i % 7) - 3.0), 1.0);
    }
    assert!(
        robot.contacts() > 2 && robot.path_length() > 5.0,
        "{} {}",
        robot.contacts(),
        robot.path_length()
    );
    assert!(listener.cliffs.is_empty(), "its floor is a floor");
}

#[test]
fn a_command_that_is_not_a_number_stops_the_robot_and_is_reported() {
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
    let mut sim = almost_blind();
    sim.camera_rate_hz = 0.0;
    let too_fast = refused(Pose2::IDENTITY, sim);
    assert!(too_fast.contains("camera_rate_hz is 0 Hz"), "{too_fast}");
    assert!(
        Scene::by_name("moon", 1).unwrap_err().to_string().contains("scene is moon, expected one of demo")
    );
}
