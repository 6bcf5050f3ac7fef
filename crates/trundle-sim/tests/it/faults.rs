//! Faults of the simulated sensors.

use super::{block, hall};
use trundle_core::{PinholeCamera, Pose2, RgbdImage, RobotBody, SensorEvent, Stamp, Twist2};
use trundle_sim::{
    Fault, FaultKind, FaultSchedule, LaserConfig, SimConfig, SimError, Simulator, WheelSide, World,
};

/// A robot without noise, with a small camera at 10 Hz, to which `kind` happens from 1 s to 2 s.
fn broken(kind: FaultKind) -> Simulator {
    broken_at(Pose2::new(-2.0, 0.0, 0.0), kind).unwrap()
}

fn broken_at(start: Pose2, kind: FaultKind) -> Result<Simulator, SimError> {
    let fault = Fault { from_s: 1.0, to_s: 2.0, kind };
    let mut config = SimConfig::default();
    config.camera = PinholeCamera::from_field_of_view((32, 24), (1.2, 0.9)).unwrap();
    config.camera_rate_hz = 10.0;
    config.laser = Some(LaserConfig::default());
    config.faults = FaultSchedule { faults: vec![fault] };
    Simulator::new(hall(start), config.without_noise(), 1)
}

/// Events in three seconds of driving ahead.
fn events(mut robot: Simulator) -> (Vec<SensorEvent>, Simulator) {
    robot.command(Twist2::new(0.3, 0.2)).unwrap();
    let mut events = Vec::new();
    while robot.stamp().as_secs() <= 3.0 {
        events.push(robot.next_event().unwrap().unwrap());
    }
    (events, robot)
}

fn images(events: &[SensorEvent]) -> Vec<&RgbdImage> {
    let images = events.iter().filter_map(|event| match event {
        SensorEvent::Rgbd(image) => Some(image),
        _ => None,
    });
    images.collect()
}

fn is_during(stamp: Stamp) -> bool {
    (1.0..2.0).contains(&stamp.as_secs())
}

fn is_black(image: &RgbdImage) -> bool {
    image.color().data().iter().all(|c| *c == [0; 3])
}

fn has_depth(image: &RgbdImage) -> bool {
    image.depth().data().iter().any(|d| *d > 0.0)
}

/// Everything but images.
fn rest(events: &[SensorEvent]) -> Vec<&SensorEvent> {
    events.iter().filter(|event| !matches!(event, SensorEvent::Rgbd(_))).collect()
}

/// A fault that does not matter here: the undisturbed run.
fn whole() -> Vec<SensorEvent> {
    events(broken(FaultKind::OdometryJumps { left_ticks: 0, right_ticks: 0 })).0
}

#[test]
fn a_black_camera_gives_black_images_and_the_rest_goes_on() {
    let (events, _) = events(broken(FaultKind::CameraBlack));
    assert_eq!(images(&events).len(), 31);
    for image in images(&events) {
        assert_eq!(is_black(image), is_during(image.stamp()), "{}", image.stamp());
        assert_eq!(has_depth(image), !is_during(image.stamp()), "{}", image.stamp());
    }
    assert!(rest(&events) == rest(&whole()));
}

#[test]
fn a_camera_without_depth_still_has_colour() {
    let (events, _) = events(broken(FaultKind::DepthGone));
    for image in images(&events) {
        assert!(!is_black(image));
        assert_eq!(has_depth(image), !is_during(image.stamp()), "{}", image.stamp());
    }
}

#[test]
fn in_the_dark_there_is_depth_and_no_colour() {
    let (events, _) = events(broken(FaultKind::LightsOut));
    for image in images(&events) {
        assert_eq!(is_black(image), is_during(image.stamp()), "{}", image.stamp());
        assert!(has_depth(image));
    }
}

#[test]
fn a_frozen_camera_repeats_its_last_image_with_new_stamps() {
    let (events, _) = events(broken(FaultKind::CameraFrozen));
    let images = images(&events);
    assert_eq!(images.len(), 31);
    for pair in images.windows(2) {
        let same = pair[0].color() == pair[1].color() && pair[0].depth() == pair[1].depth();
        assert_eq!(same, is_during(pair[1].stamp()), "{}", pair[1].stamp());
        assert!(pair[0].stamp() < pair[1].stamp());
    }
}

#[test]
fn dropped_images_do_not_come_and_the_truth_stays() {
    let (events, _) = events(broken(FaultKind::CameraDropped { probability: 1.0 }));
    assert_eq!(images(&events).len(), 21);
    assert!(images(&events).iter().all(|image| !is_during(image.stamp())));
    assert!(rest(&events) == rest(&whole()));
    let (events, _) = self::events(broken(FaultKind::CameraDropped { probability: 0.5 }));
    assert!((22..=30).contains(&images(&events).len()));
}

#[test]
fn late_images_come_late_with_the_stamp_of_their_taking() {
    let (events, _) = events(broken(FaultKind::CameraLate { delay_s: 0.25 }));
    let mut newest = Stamp::default();
    for event in &events {
        if let SensorEvent::Rgbd(image) = event {
            let late = newest - image.stamp();
            let expected = if is_during(image.stamp()) { 0.25 } else { 0.0 };
            assert!((late - expected).abs() < 0.011, "{late} at {}", image.stamp());
        } else {
            assert!(event.stamp() >= newest, "everything else keeps the order");
            newest = event.stamp();
        }
    }
    let (mut late, whole) = (images(&events), whole());
    late.sort_by_key(|image| image.stamp());
    assert!(late == images(&whole), "the pictures are the same");
}

#[test]
fn a_slipping_wheel_turns_the_robot_but_not_its_odometry() {
    let (events, robot) = events(broken(FaultKind::WheelSlips { side: WheelSide::Left, factor: 0.5 }));
    let whole = whole();
    let wheels = |events: &[SensorEvent]| {
        events.iter().filter(|e| matches!(e, SensorEvent::Wheels(_))).cloned().collect::<Vec<_>>()
    };
    assert!(wheels(&events) == wheels(&whole));
    let Some(SensorEvent::Truth { pose, .. }) =
        whole.iter().rfind(|event| matches!(event, SensorEvent::Truth { .. }))
    else {
        panic!("no truth")
    };
    // The left wheel (0.3 - 0.2 * 0.115 m/s) moves the body by half its distance for a second.
    let turned = 0.5 * (0.3 - 0.2 * 0.115) / 0.230;
    let more = robot.true_pose().theta - pose.theta;
    assert!((more - turned).abs() < 1e-2, "{more} {turned}");
}

#[test]
fn a_stuck_gyro_repeats_itself() {
    let mut robot = broken(FaultKind::GyroStuck);
    let (mut during, mut after) = (Vec::new(), 0.0);
    while robot.stamp().as_secs() <= 2.9 {
        let t = robot.stamp().as_secs();
        robot.command(Twist2::new(0.0, if t < 1.2 { 0.5 } else { -0.5 })).unwrap();
        if let Some(SensorEvent::Gyro(gyro)) = robot.next_event().unwrap() {
            if is_during(gyro.stamp) {
                during.push(gyro.omega);
            }
            after = gyro.omega;
        }
    }
    assert!(during.len() == 50 && during.iter().all(|omega| (omega - 0.5).abs() < 1e-3), "{during:?}");
    assert!((after + 0.5).abs() < 1e-3, "{after}");
}

#[test]
fn stuck_encoders_repeat_themselves_while_the_robot_drives() {
    let (events, robot) = events(broken(FaultKind::EncodersStuck));
    let counters = |events: &[SensorEvent]| -> Vec<(Stamp, u16, u16)> {
        let counters = events.iter().filter_map(|event| match event {
            SensorEvent::Wheels(ticks) => Some((ticks.stamp, ticks.left, ticks.right)),
            _ => None,
        });
        counters.collect()
    };
    let (stuck, whole) = (counters(&events), counters(&whole()));
    let last = stuck.iter().rfind(|(stamp, ..)| stamp.as_secs() < 1.0).unwrap();
    for (reported, true_ticks) in stuck.iter().zip(&whole) {
        let expected = if is_during(reported.0) { (reported.0, last.1, last.2) } else { *true_ticks };
        assert_eq!(*reported, expected);
    }
    assert_ne!((last.1, last.2), (whole[100].1, whole[100].2));
    assert!(robot.true_pose().x > -1.5, "the robot drives on");
}

#[test]
fn odometry_jumps_by_ticks_and_the_robot_does_not() {
    let (events, _) = events(broken(FaultKind::OdometryJumps { left_ticks: 300, right_ticks: -70 }));
    let mut difference = Vec::new();
    for (a, b) in events.iter().zip(&whole()) {
        match (a, b) {
            (SensorEvent::Wheels(a), SensorEvent::Wheels(b)) => {
                difference.push((a.left.wrapping_sub(b.left), a.right.wrapping_sub(b.right)));
            }
            _ => assert!(a == b),
        }
    }
    assert_eq!(difference[..50], [(0, 0); 50]);
    assert_eq!(difference[50..], vec![(300, 0_u16.wrapping_sub(70)); difference.len() - 50]);
}

#[test]
fn a_kidnapped_robot_is_elsewhere_and_its_wheels_do_not_know() {
    let (events, robot) = events(broken(FaultKind::Kidnapped { x: 1.0, y: -2.0, heading_deg: 180.0 }));
    let mut last = None;
    let mut jumps = Vec::new();
    for event in &events {
        if let SensorEvent::Truth { stamp, pose } = event {
            if last.is_some_and(|last: Pose2| last.distance(pose) > 0.1) {
                jumps.push((*stamp, *pose));
            }
            last = Some(*pose);
        }
    }
    assert_eq!((jumps.len(), jumps[0].0), (1, Stamp::from_nanos(1_000_000_000)));
    assert!(jumps[0].1.distance(&Pose2::new(1.0, -2.0, 0.0)) < 1e-3, "{jumps:?}");
    assert!((robot.path_length() - 0.3 * 2.9).abs() < 0.05, "{}", robot.path_length());
    for (a, b) in events.iter().zip(&whole()) {
        match (a, b) {
            (SensorEvent::Wheels(a), SensorEvent::Wheels(b)) => assert_eq!(a, b),
            (SensorEvent::Gyro(a), SensorEvent::Gyro(b)) => assert!((a.omega - b.omega).abs() < 1e-9),
            _ => {}
        }
    }
}

#[test]
fn kidnapping_into_a_wall_is_refused() {
    let put = FaultKind::Kidnapped { x: 2.9, y: 0.0, heading_deg: 0.0 };
    let error = broken_at(Pose2::IDENTITY, put).unwrap_err().to_string();
    assert!(
        error.contains("kidnapping at 1 s to (2.900, 0.000) m of scene 'hall' is 0.075 m inside"),
        "{error}"
    );
}

#[test]
fn a_stuck_bumper_says_what_it_is_stuck_at() {
    let touches = |start: Pose2, kind: FaultKind| {
        let (events, robot) = events(broken_at(start, kind).unwrap());
        let touch = |event: &SensorEvent| match event {
            SensorEvent::Touch(touch) => Some((touch.stamp.as_secs(), touch.pressed)),
            _ => None,
        };
        (events.iter().filter_map(touch).collect::<Vec<_>>(), robot.contacts())
    };
    let free = touches(Pose2::new(-2.0, 0.0, 0.0), FaultKind::BumperStuck { pressed: true });
    assert_eq!(free, (vec![(1.0, true), (2.0, false)], 0));
    // The robot reaches the wall after 1.3 s, and is still in contact when the bumper works again.
    let wall = touches(Pose2::new(2.5, 0.0, 0.0), FaultKind::BumperStuck { pressed: false });
    assert_eq!(wall, (vec![(2.0, true)], 1));
}

#[test]
fn a_laser_that_is_gone_sends_no_scans() {
    let (events, _) = events(broken(FaultKind::LaserGone));
    let scans: Vec<Stamp> =
        events.iter().filter(|e| matches!(e, SensorEvent::Scan(_))).map(SensorEvent::stamp).collect();
    assert!(scans.len() == 21 && !scans.iter().any(|stamp| is_during(*stamp)), "{scans:?}");
}

#[test]
fn faults_are_the_same_on_one_thread_and_on_two() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| events(broken(FaultKind::CameraDropped { probability: 0.5 })).0)
    };
    assert!(run(1) == run(2));
}

#[test]
fn a_robot_that_is_put_beside_a_box_can_still_not_get_into_it() {
    let put = FaultKind::Kidnapped { x: 1.0, y: 1.0, heading_deg: 0.0 };
    let mut scene = hall(Pose2::IDENTITY);
    let mut solids = scene.world.solids().to_vec();
    solids.push(block([1.5, 1.0, 0.2], [0.4, 0.4, 0.4], 0.0));
    scene.world = World::new(solids, 1).unwrap();
    let faults = FaultSchedule { faults: vec![Fault { from_s: 0.5, to_s: 1.0, kind: put }] };
    let mut config = SimConfig::default();
    config.has_camera = false;
    config.faults = faults;
    let mut robot = Simulator::new(scene, config, 1).unwrap();
    robot.command(Twist2::new(0.5, 0.0)).unwrap();
    while robot.stamp().as_secs() < 3.0 {
        robot.next_event().unwrap();
        assert!(robot.clearance() > 0.0);
    }
    assert!(robot.contacts() == 1 && (robot.true_pose().x - (1.3 - 0.1755)).abs() < 2e-3);
}
