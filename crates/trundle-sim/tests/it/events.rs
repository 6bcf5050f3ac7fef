//! Order and determinism of the simulator's events.

use super::{almost_blind, hall};
use trundle_core::{Pose2, RobotBody, SensorEvent, Stamp, Twist2};
use trundle_sim::{LaserConfig, Scene, SimConfig, Simulator, World};

fn rank(event: &SensorEvent) -> u8 {
    match event {
        SensorEvent::Wheels(_) => 0,
        SensorEvent::Gyro(_) => 1,
        SensorEvent::Touch(_) => 2,
        SensorEvent::Cliff(_) => 3,
        SensorEvent::Truth { .. } => 4,
        SensorEvent::Scan(_) => 5,
        SensorEvent::Rgbd(_) => 6,
        other => panic!("an event without a rank: {other:?}"),
    }
}

fn events_until(robot: &mut Simulator, end: f64) -> Vec<SensorEvent> {
    let mut events = Vec::new();
    loop {
        let event = robot.next_event().unwrap().unwrap();
        if event.stamp().as_secs() > end {
            return events;
        }
        events.push(event);
    }
}

#[test]
fn events_come_by_stamp_and_at_equal_stamps_in_the_fixed_order() {
    // Without a floor, every cliff sensor measures a cliff.
    let mut scene = hall(Pose2::new(2.5, 0.0, 0.0));
    scene.world = World::new(scene.world.solids()[..4].to_vec(), 1).unwrap();
    let laser = Some(LaserConfig::default());
    let mut config = almost_blind();
    config.camera_rate_hz = 15.0;
    config.laser = laser;
    let mut robot = Simulator::new(scene, config, 1).unwrap();
    robot.command(Twist2::new(0.5, 0.0)).unwrap();
    let events = events_until(&mut robot, 2.0);
    assert_eq!(events[0].stamp(), Stamp::default());
    for pair in events.windows(2) {
        let key = |event: &SensorEvent| (event.stamp(), rank(event));
        assert!(key(&pair[0]) < key(&pair[1]), "{:?} then {:?}", key(&pair[0]), key(&pair[1]));
    }
    let count = |r: u8| events.iter().filter(|event| rank(event) == r).count();
    assert_eq!((count(0), count(1), count(2), count(3)), (101, 101, 1, 1));
    assert_eq!((count(5), count(6)), (21, 31));
    assert!(count(4) >= 120, "truth at every wheel reading and every image: {}", count(4));
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_one_thread_and_on_two() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = Scene::by_name("obstacles", 11).unwrap();
            let mut robot = Simulator::new(scene, SimConfig::default(), 11).unwrap();
            robot.command(Twist2::new(0.3, 0.4)).unwrap();
            events_until(&mut robot, 0.3)
        })
    };
    let (one, two) = (run(1), run(2));
    assert!(one.iter().any(|event| rank(event) == 6));
    assert!(one == two, "events differ");
}

#[test]
fn another_seed_gives_other_noise() {
    let run = |seed| {
        let mut robot = Simulator::new(hall(Pose2::IDENTITY), almost_blind(), seed).unwrap();
        robot.command(Twist2::new(0.3, 0.4)).unwrap();
        events_until(&mut robot, 1.0)
    };
    assert!(run(1) == run(1) && run(1) != run(2));
}
