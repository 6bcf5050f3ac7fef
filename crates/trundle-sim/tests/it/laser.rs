//! The laser scanner against closed forms.

use super::{almost_blind, hall};
use trundle_core::{Beam, Hypotenuse, Pose2, RobotBody, Scan, SensorEvent, Twist2};
use trundle_sim::{LaserConfig, Scene, SimConfig, Simulator};

fn config(laser: LaserConfig) -> SimConfig {
    let mut config = almost_blind();
    config.laser = Some(laser);
    config.has_camera = false;
    config
}

fn scans(robot: &mut Simulator, n: usize) -> Vec<Scan> {
    let mut scans = Vec::new();
    while scans.len() < n {
        if let Some(SensorEvent::Scan(scan)) = robot.next_event().unwrap() {
            scans.push(scan);
        }
    }
    scans
}

#[test]
fn ranges_in_a_square_hall_are_the_closed_form() {
    let start = Pose2::new(0.7, -1.1, 0.6);
    let mut laser = LaserConfig::default();
    laser.x = 0.1;
    laser.y = -0.05;
    laser.yaw = 0.4;
    laser.field_of_view = 4.0;
    laser.beams = 777;
    laser.range_min = 0.0;
    let mut robot = Simulator::new(hall(start), config(laser), 1).unwrap();
    let scan = &scans(&mut robot, 1)[0];
    assert_eq!(scan.beams().len(), 777);
    assert!((scan.angle_min() - (0.4 - 2.0)).abs() < 1e-12 && (scan.angle(776) - 2.4).abs() < 1e-9);
    let origin = start.transform(scan.origin());
    for (i, beam) in scan.beams().iter().enumerate() {
        let angle = start.theta + scan.angle(i);
        let to_wall = |p: f64, d: f64| (3.0 * d.signum() - p) / d;
        let expected = to_wall(origin.x, angle.cos()).min(to_wall(origin.y, angle.sin()));
        let Beam::Hit { range } = beam else { panic!("{beam:?}") };
        assert!((range - expected).abs() < 1e-9, "{range} {expected}");
    }
}

#[test]
fn beyond_its_range_it_is_silent_and_too_near_it_is_blind() {
    let mut laser = LaserConfig::default();
    laser.range_min = 2.0;
    laser.range_max = 3.2;
    let mut robot = Simulator::new(hall(Pose2::new(1.5, 0.0, 0.0)), config(laser.clone()), 1).unwrap();
    let scan = &scans(&mut robot, 1)[0];
    // Beam 180 hits at 1.5 m ahead, beam 0 at 4.5 m behind, beam 90 at 3 m to the right.
    assert_eq!(scan.beams()[180], Beam::Unseen);
    assert_eq!(scan.beams()[0], Beam::Free { range: 3.2 });
    assert!(matches!(scan.beams()[90], Beam::Hit { range } if (range - 3.0).abs() < 1e-9));
    let mut shy = laser;
    shy.silence_is_free = false;
    let mut robot = Simulator::new(hall(Pose2::new(1.5, 0.0, 0.0)), config(shy), 1).unwrap();
    assert_eq!(scans(&mut robot, 1)[0].beams()[0], Beam::Unseen);
}

#[test]
fn noise_drop_outs_and_grazing_losses_are_as_configured() {
    let mut laser = LaserConfig::default();
    laser.noise = 0.01;
    laser.noise_part = 0.005;
    laser.quantum = 0.001;
    laser.drop_out = 0.1;
    laser.max_incidence = 40_f64.to_radians();
    laser.silence_is_free = true;
    let mut robot = Simulator::new(hall(Pose2::IDENTITY), config(laser), 3).unwrap();
    let (mut square, mut hits, mut lost, mut dropped) = (0.0, 0, 0, 0);
    for scan in scans(&mut robot, 60) {
        for (i, beam) in scan.beams().iter().enumerate() {
            let angle = scan.angle(i);
            let expected = 3.0 / angle.cos().abs().max(angle.sin().abs());
            let incidence = (3.0 / expected).acos().to_degrees();
            match beam {
                Beam::Hit { range } => {
                    assert!(incidence < 40.01);
                    assert!(((range / 0.001).round() * 0.001 - range).abs() < 1e-9);
                    square += ((range - expected) / 0.01_f64.hypotenuse(0.005 * expected)).powi(2);
                    hits += 1;
                }
                Beam::Free { .. } => {
                    assert!(incidence > 39.99);
                    lost += 1;
                }
                Beam::Unseen => dropped += 1,
            }
        }
    }
    let deviation = (square / f64::from(hits)).sqrt();
    assert!((deviation - 1.0).abs() < 0.03, "{deviation}");
    let share = f64::from(dropped) / 21_600.0;
    assert!((share - 0.1).abs() < 0.01 && lost > 1000, "{share} {lost}");
}

#[test]
fn a_sweeping_laser_is_bent_by_a_turn_and_a_still_one_is_not() {
    let scan_while_turning = |sweeps: bool| {
        let mut laser = LaserConfig::default();
        laser.sweeps = sweeps;
        let mut robot_config = config(laser);
        robot_config.kobuki = almost_blind().kobuki.without_noise();
        let mut robot = Simulator::new(hall(Pose2::IDENTITY), robot_config, 1).unwrap();
        robot.command(Twist2::new(0.0, 1.0)).unwrap();
        let scan = scans(&mut robot, 16).pop().unwrap();
        (scan, robot.true_pose().theta)
    };
    for sweeps in [false, true] {
        let (scan, heading) = scan_while_turning(sweeps);
        for (i, beam) in scan.beams().iter().enumerate() {
            // Beam i is measured (359 - i) / 360 of a turn, 0.1 s, earlier, when the robot had turned less.
            let age = if sweeps { (359 - i) as f64 / 360.0 * 0.1 } else { 0.0 };
            let angle = heading - age + scan.angle(i);
            let expected = 3.0 / angle.cos().abs().max(angle.sin().abs());
            let Beam::Hit { range } = beam else { panic!("{beam:?}") };
            assert!((range - expected).abs() < 1e-4, "{range} {expected} at {i}, {sweeps}");
        }
    }
}

#[test]
fn scans_are_the_same_on_one_thread_and_on_two() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = Scene::by_name("obstacles", 5).unwrap();
            let mut robot = Simulator::new(scene, config(LaserConfig::ust_10lx()), 5).unwrap();
            robot.command(Twist2::new(0.3, 0.5)).unwrap();
            scans(&mut robot, 20)
        })
    };
    assert!(run(1) == run(2));
}
