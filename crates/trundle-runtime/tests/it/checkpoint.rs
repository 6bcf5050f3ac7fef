//! Checkpoints: a file is read back whole or refused with the reason.

use std::collections::BTreeMap;
use trundle_core::{OccupancyGrid, Pose2, PoseBound, Stamp};
use trundle_runtime::{
    Checkpoint, CheckpointError, Mission, MissionState, Reason, ReasonKind, Robot, RobotConfig, Task,
    TaskEnd, TaskRecord,
};

/// A task that ended so.
fn record(index: usize, end: TaskEnd) -> TaskRecord {
    TaskRecord {
        index,
        task: Task::go(Pose2::new(0.1, 0.2, 0.3)),
        end,
        from: Stamp::from_nanos(5),
        to: Stamp::from_nanos(7),
        pose: Pose2::new(0.1, 0.21, 0.3),
        bound: Some(PoseBound { distance: 0.03, heading: 0.01 }),
        before_restart: false,
    }
}

/// A checkpoint of a small map with one task of each end.
fn checkpoint() -> Checkpoint {
    let left = Mission::new(vec![Task::go(Pose2::new(1.5, -2.0, 0.25)), Task::Return]).unwrap();
    let cause = Some(Box::new(Reason::MovingObstacle));
    let stalled = Reason::NoProgress { time: 75.0, state: "waiting", cause };
    let ended = vec![
        record(0, TaskEnd::Done),
        record(1, TaskEnd::PutOff { reason: stalled }),
        record(2, TaskEnd::GivenUp { reason: Reason::PoseUnknown }),
    ];
    Checkpoint {
        visual: vec![7; 40],
        visual_maps: BTreeMap::new(),
        grid: OccupancyGrid::from_ascii(0.05, "#.#\n?..\n").unwrap(),
        mission: MissionState { left, places: vec![1, 3], ended, by_operator: false },
        station: None,
        annotations: trundle_core::MapAnnotations::default(),
    }
}

#[test]
fn reasons_survive_with_text_and_kinds() {
    let read = Checkpoint::from_bytes(&checkpoint().to_bytes()).unwrap();
    let TaskEnd::PutOff { reason } = &read.mission.ended[1].end else { panic!("{:?}", read.mission.ended) };
    assert_eq!(reason.to_string(), "no progress for 75 s: a moving obstacle blocks the path");
    assert_eq!(reason.kinds(), [ReasonKind::NoProgress, ReasonKind::MovingObstacle]);
    let TaskEnd::GivenUp { reason } = &read.mission.ended[2].end else { panic!("{:?}", read.mission.ended) };
    assert!(reason.is_due_to(ReasonKind::PoseUnknown));
}

#[test]
fn a_checkpoint_that_is_read_and_written_again_is_the_same_file() {
    let bytes = checkpoint().to_bytes();
    let read = Checkpoint::from_bytes(&bytes).unwrap();
    assert_eq!(read.to_bytes(), bytes);
    assert_eq!(Checkpoint::from_bytes(&bytes).unwrap(), read);
}

#[test]
fn every_truncation_is_refused() {
    let bytes = checkpoint().to_bytes();
    for length in 0..bytes.len() {
        assert!(
            Checkpoint::from_bytes(&bytes[..length]).is_err(),
            "the first {length} of {} bytes",
            bytes.len()
        );
    }
}

#[test]
fn every_flipped_byte_is_refused() {
    let bytes = checkpoint().to_bytes();
    for at in 0..bytes.len() {
        let mut broken = bytes.clone();
        broken[at] ^= 0x40;
        assert!(Checkpoint::from_bytes(&broken).is_err(), "byte {at} of {}", bytes.len());
    }
}

#[test]
fn bytes_after_the_end_are_noticed() {
    let longer = [checkpoint().to_bytes(), vec![0]].concat();
    assert!(matches!(Checkpoint::from_bytes(&longer), Err(CheckpointError::Damaged { .. })));
}

#[test]
fn a_mission_whose_places_do_not_match_its_tasks_is_refused() {
    let mut wrong = checkpoint();
    wrong.mission.places.pop();
    let error = Checkpoint::from_bytes(&wrong.to_bytes()).unwrap_err();
    assert!(
        matches!(&error, CheckpointError::Invalid(invalid) if invalid.field == "places of tasks"),
        "{error}"
    );
}

#[test]
fn visual_maps_that_are_none_are_refused_when_the_robot_resumes() {
    let error = Robot::resume(RobotConfig::default(), &checkpoint()).unwrap_err();
    assert!(matches!(error, CheckpointError::Visual(_)), "{error}");
}

#[test]
fn a_robot_that_has_seen_nothing_yet_keeps_its_mission_through_a_restart() {
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    robot.begin(&Mission::new(vec![Task::Explore, Task::Return]).unwrap());
    let first = robot.checkpoint().unwrap();
    assert_eq!(first.mission.left.tasks(), [Task::Explore, Task::Return]);
    let mut resumed = Robot::resume(RobotConfig::default(), &first).unwrap();
    assert_eq!(resumed.checkpoint().unwrap().mission, first.mission, "the mission goes on");
}
