//! The robot drives onto its station in closed loop with noise; the laser in place of the camera reduces a run to a few seconds.

use super::*;
use crate::laser_run::LaserRun;
use trundle_core::{Vector2, Vector3};
use trundle_runtime::{Mission, RangeSource, ReasonKind, RobotConfig, Task};
use trundle_sim::{Cuboid, Finish, Paint, Shape, Solid, World};

/// A dock without a viewer, with its whole run.
struct Dock {
    trial: DockTrial,
    run: LaserRun,
}

impl std::ops::Deref for Dock {
    type Target = DockTrial;

    fn deref(&self) -> &DockTrial {
        &self.trial
    }
}

fn dock(plan: DockPlan) -> Result<Dock, AppError> {
    super::dock(plan, None).map(|(trial, run)| Dock { trial, run })
}

fn room(start: Pose2) -> Scene {
    Scene { start, ..Scene::by_name("room", 1).unwrap() }
}

fn plan(scene: Scene, seed: u64) -> DockPlan {
    let mut robot = RobotConfig::default();
    robot.sight = RangeSource::Laser;
    let body = body_of(&robot).unwrap();
    DockPlan { scene, robot, body, mission: docking_alone().unwrap(), seed }
}

/// Checks that a run ended on the contacts and touched only the station.
fn assert_docked(trial: &Dock) {
    let (lateral, heading) = (trial.lateral_error(), trial.heading_error().to_degrees());
    eprintln!("{} after {:.0} s, {:.1} mm, {heading:.2} deg", trial.state, trial.time, lateral * 1e3);
    assert!(trial.is_docked(), "{}", trial.state);
    assert_touched_only_the_station(trial);
    assert!(lateral.abs() < 0.01 && heading.abs() < 3.0, "{lateral} m, {heading} deg");
}

/// Checks the place of each contact: an attempt that misses the plates ends at the front of the station.
fn assert_touched_only_the_station(trial: &Dock) {
    for pair in trial.run.moments.windows(2).filter(|pair| pair[1].contacts > pair[0].contacts) {
        let at = station().inverse() * pair[1].pose;
        assert!(at.x < 0.2 && at.y.abs() < 0.13, "contact away from the station: {at:?}");
    }
}

/// Kinds of the reason for which a run ended without a dock.
fn kinds(trial: &Dock) -> Vec<ReasonKind> {
    assert!(!trial.is_docked());
    trial.state.reason().unwrap().kinds()
}

#[test]
fn it_finds_its_station_and_docks_from_several_starts() {
    let starts = [(0.0, 0.0, 0.0), (1.5, 2.0, -2.0), (2.3, -1.5, 3.0), (-2.4, -1.0, -2.2)];
    for (seed, (x, y, theta)) in (1..).zip(starts) {
        let scene = room(Pose2::new(x, y, theta)).with_station(station()).unwrap();
        assert_docked(&dock(plan(scene, seed)).unwrap());
    }
}

#[test]
fn the_same_seed_gives_the_same_dock() {
    let run = || {
        let scene = room(Pose2::new(1.0, 0.6, 0.5)).with_station(station()).unwrap();
        dock(plan(scene, 3)).unwrap()
    };
    let (first, second) = (run(), run());
    assert_docked(&first);
    assert_eq!((first.station_from_base, first.time), (second.station_from_base, second.time));
}

#[test]
fn a_robot_that_starts_on_its_station_backs_off_first_and_finds_back() {
    let start = station() * Pose2::new(0.18, 0.0, PI);
    let scene = room(start).with_station(station()).unwrap();
    let tasks = vec![Task::go(Pose2::new(-1.5, 0.5, 0.0)), Task::Dock];
    let trial = dock(DockPlan { mission: Mission::new(tasks).unwrap(), ..plan(scene, 5) }).unwrap();
    assert_docked(&trial);
    let ends: Vec<_> = trial.run.robot.tasks_ended().iter().map(|record| record.end.to_string()).collect();
    assert_eq!(ends, ["done", "done"]);
    let is_near = |pose: Pose2| pose.distance(&start) < 0.3;
    let turns = |moment: &&crate::laser_run::Moment| moment.twist.omega.abs() > 0.13;
    let first_turn = trial.run.moments.iter().find(turns).unwrap();
    assert!(!is_near(first_turn.pose), "it turns on the station: {:?}", first_turn.pose);
    assert!(trial.time < 120.0, "it searches what it knows: {} s", trial.time);
}

#[test]
fn without_a_station_the_reason_is_missing_light() {
    let trial = dock(plan(room(Pose2::IDENTITY), 1)).unwrap();
    assert_eq!(kinds(&trial), [ReasonKind::TasksFailed, ReasonKind::NoStationLight]);
    assert_eq!(trial.contacts, 0);
    assert!(trial.state.to_string().contains("no light of a charging station was seen"), "{}", trial.state);
}

#[test]
fn plates_that_do_not_charge_are_tried_three_times() {
    let scene = room(Pose2::new(1.5, 0.2, 0.0)).with_station(station()).unwrap();
    let mut plan = plan(scene, 2);
    plan.body.station.charges = false;
    let trial = dock(plan).unwrap();
    assert_eq!(kinds(&trial), [ReasonKind::TasksFailed, ReasonKind::NoCharging]);
    assert!(trial.state.to_string().contains("after 3 attempts"), "{}", trial.state);
    // The robot pushes only the station, and only slowly.
    assert_touched_only_the_station(&trial);
    assert!((1..=3).contains(&trial.contacts), "{} contacts", trial.contacts);
    let fastest =
        trial.run.moments.iter().filter(|m| m.clearance < 0.05).map(|m| m.twist.v.abs()).fold(0.0, f64::max);
    assert!(fastest <= 0.1, "{fastest} m/s near the station");
}

/// The room with a box of 0.5 x 0.3 x 0.5 m, its middle this far in front of the station, m.
fn blocked(start: Pose2, distance: f64) -> Scene {
    let scene = room(start);
    let middle = station().transform(Vector2::new(distance, 0.0));
    let center = Vector3::new(middle.x, middle.y, 0.25);
    let shape = Shape::Cuboid(Cuboid { center, size: Vector3::new(0.3, 0.5, 0.5), yaw: 0.0 });
    let solid = Solid { shape, finish: Finish::all(Paint::Flat { color: [120; 3] }) };
    let solids = scene.world.solids().iter().cloned().chain([solid]).collect();
    Scene { world: World::new(solids, 1).unwrap(), ..scene }.with_station(station()).unwrap()
}

#[test]
fn a_station_behind_a_box_is_given_up_with_a_reason_and_nothing_is_touched() {
    let trial = dock(plan(blocked(Pose2::new(1.2, 1.8, 0.0), 0.45), 4)).unwrap();
    let kinds = kinds(&trial);
    eprintln!("{} after {:.0} s", trial.state, trial.time);
    assert_eq!((kinds[0], trial.contacts), (ReasonKind::TasksFailed, 0), "{}", trial.state);
    assert!(kinds.len() > 1 && !kinds.contains(&ReasonKind::Unknown), "{kinds:?}");
}

#[test]
fn starts_differ_and_have_room() {
    let starts: Vec<Pose2> = (1..=200).map(start_of).collect();
    assert!(starts.iter().all(|start| start.distance(&station()) >= MIN_START_DISTANCE_M));
    assert!(
        starts.iter().all(|start| start.x.abs() <= START_HALF_SIDE_M && start.y.abs() <= START_HALF_SIDE_M)
    );
    let pairs = starts.iter().enumerate().flat_map(|(i, a)| starts[..i].iter().map(move |b| a.distance(b)));
    assert!(pairs.fold(f64::INFINITY, f64::min) > 1e-3);
}

#[test]
fn the_verdict_counts_the_docks() {
    let none = DocksOutcome { trials: Vec::new() };
    assert!(!none.is_success() && none.verdict().starts_with("0 of 0 docks"));
    let start = Pose2::new(1.6, 0.5, 0.0);
    let outcome = |charges| {
        let mut plan = plan(room(start).with_station(station()).unwrap(), 6);
        plan.body.station.charges = charges;
        DocksOutcome { trials: vec![(start, dock(plan).unwrap().trial)] }
    };
    let (good, bad) = (outcome(true), outcome(false));
    assert!(good.is_success() && good.verdict().starts_with("1 of 1 docks"), "{}", good.verdict());
    assert!(!bad.is_success() && bad.verdict().starts_with("0 of 1 docks"), "{}", bad.verdict());
    assert_eq!(good.table()[1][1], "docked");
}
