//! Tests of reasons: text and kind of each, and their form in files.

use super::*;
use crate::mission::{TaskEnd, dock_failure::DockFailure};
use trundle_control::MotionHold;
use trundle_core::{Invalid, Pose2};
use trundle_docking::PositionerReason;

/// A reason of each variant of `Reason`, `StopReason` and `NoPath`, with its kind and a part of its text.
fn samples() -> Vec<(Reason, ReasonKind, &'static str)> {
    let at = Vector2::new(1.0, -2.0);
    let no_path = |cause| Reason::NoPath { cause, unseen: None };
    let invalid = Invalid::new("goal.x", f64::NAN, "m", "a finite number");
    vec![
        (
            Reason::Safety(StopReason::ObstacleAhead { distance: 0.1, at }),
            ReasonKind::Obstacle,
            "0.10 m to contact",
        ),
        (
            Reason::Safety(StopReason::ObstacleBeside { angle: 0.1, at }),
            ReasonKind::Obstacle,
            "no room to turn",
        ),
        (Reason::Safety(StopReason::Touched), ReasonKind::Contact, "bumper"),
        (Reason::Safety(StopReason::Cliff), ReasonKind::Cliff, "no floor"),
        (Reason::Safety(StopReason::NoImage), ReasonKind::ImageMissing, "no image"),
        (Reason::Safety(StopReason::NothingSeen), ReasonKind::ImageMissing, "no image"),
        (Reason::Safety(StopReason::StaleImage { age: 1.5 }), ReasonKind::ImageMissing, "1.50 s old"),
        (Reason::Safety(StopReason::NothingTellsMotion), ReasonKind::MotionUnknown, "do not count"),
        (Reason::Safety(StopReason::NoWheels), ReasonKind::WheelsMissing, "no wheel reading"),
        (Reason::Safety(StopReason::StaleWheels { age: 0.5 }), ReasonKind::WheelsMissing, "0.50 s old"),
        (Reason::Safety(StopReason::NotFinite), ReasonKind::CommandInvalid, "not a number"),
        (Reason::Safety(StopReason::Held(MotionHold::WheelDrop)), ReasonKind::WheelDrop, "wheel"),
        (Reason::Safety(StopReason::Held(MotionHold::Paused)), ReasonKind::Paused, "paused"),
        (
            Reason::Safety(StopReason::Held(MotionHold::GoalLinkLost)),
            ReasonKind::GoalLinkLost,
            "start the program anew",
        ),
        (Reason::StoppingToReplan, ReasonKind::StoppingToReplan, "plan again"),
        (Reason::MovingObstacle, ReasonKind::MovingObstacle, "moving obstacle blocks"),
        (Reason::PathOutOfView, ReasonKind::PathOutOfView, "leaves the camera's view"),
        (Reason::UnseenFloor { at }, ReasonKind::UnseenFloor, "(1.00, -2.00) m"),
        (
            no_path(NoPath::Blocked { nearest: at }),
            ReasonKind::PathBlocked,
            "nearest reachable point is (1.00, -2.00) m",
        ),
        (
            Reason::NoPath { cause: NoPath::Blocked { nearest: at }, unseen: Some(at) },
            ReasonKind::PathBlocked,
            "; the floor at (1.00, -2.00) m could not be observed",
        ),
        (
            no_path(NoPath::StartInObstacle { missing: 0.02 }),
            ReasonKind::TooLittleRoom,
            "the footprint overlaps an obstacle by 0.020 m at the start",
        ),
        (no_path(NoPath::GoalInObstacle { missing: 0.02 }), ReasonKind::TooLittleRoom, "at the goal"),
        (
            no_path(NoPath::GoalInZone { zone: "zone 'stairs'".to_owned() }),
            ReasonKind::NoGoZone,
            "no-go zone 'stairs'",
        ),
        (no_path(NoPath::StartOutside), ReasonKind::OffTheMap, "the robot is off the map"),
        (no_path(NoPath::GoalOutside), ReasonKind::OffTheMap, "the goal is off the map"),
        (no_path(NoPath::Refused(invalid)), ReasonKind::PlanRefused, "goal.x"),
        (Reason::PoseUnknown, ReasonKind::PoseUnknown, "pose is unknown"),
        (Reason::PoseUncertain { sigma: 0.75 }, ReasonKind::PoseUncertain, "standard deviation 0.75 m"),
        (Reason::WheelsUnresponsive { sigma: 0.75 }, ReasonKind::WheelsUnresponsive, "0.75 m: the encoders"),
        (Reason::RepeatedContact { contacts: 3 }, ReasonKind::RepeatedContact, "3 bumper contacts"),
        (Reason::NoSightOnPath, ReasonKind::NoSightOnPath, "view is lost"),
        (
            Reason::NoProgress { time: 30.4, state: "planning", cause: None },
            ReasonKind::NoProgress,
            "no progress for 30 s: planning",
        ),
        (Reason::FinalApproach(ApproachFailure::NoGoal), ReasonKind::FinalApproach, "no goal"),
        (
            Reason::FinalApproach(ApproachFailure::Timeout { limit: 120.0 }),
            ReasonKind::FinalApproach,
            "120 s",
        ),
        (
            Reason::FinalApproach(ApproachFailure::Positioner(PositionerReason::NoWay(None))),
            ReasonKind::FinalApproach,
            "no turns and straight moves",
        ),
        (Reason::Docking(DockFailure::NoLight), ReasonKind::NoStationLight, "no light of a charging station"),
        (
            Reason::Docking(DockFailure::NoCharging { attempts: 2 }),
            ReasonKind::NoCharging,
            "after 2 attempts",
        ),
        (Reason::Interrupted, ReasonKind::Interrupted, "the user"),
    ]
}

/// A mission with two failed tasks: nested reasons.
fn nested() -> Reason {
    let stale = Reason::Safety(StopReason::StaleImage { age: 2.0 });
    let stalled = Reason::NoProgress { time: 60.0, state: "waiting", cause: Some(Box::new(stale)) };
    let failure = |index, task, reason| TaskFailure { index, task, reason };
    Reason::TasksFailed(vec![
        failure(0, Task::go(Pose2::new(1.0, 0.0, 0.0)), stalled),
        failure(2, Task::Return, Reason::PoseUnknown),
    ])
}

#[test]
fn each_reason_has_a_kind_and_a_text_in_words() {
    for (reason, kind, part) in samples() {
        assert_eq!(reason.kind(), kind, "{reason}");
        assert_eq!(reason.kinds(), [kind], "{reason}");
        assert!(reason.to_string().contains(part), "'{reason}' holds no '{part}'");
    }
}

#[test]
fn reasons_behind_a_reason_are_found_outermost_first() {
    let kinds =
        [ReasonKind::TasksFailed, ReasonKind::NoProgress, ReasonKind::ImageMissing, ReasonKind::PoseUnknown];
    assert_eq!(nested().kinds(), kinds);
    assert!(kinds.into_iter().all(|kind| nested().is_due_to(kind)));
    assert!(!nested().is_due_to(ReasonKind::PathBlocked));
    assert_eq!(
        nested().to_string(),
        "task 1 (go to (1.00 m, 0.00 m, 0 deg)): no progress for 60 s: the newest image or scan that shows something is \
         2.00 s old; task 3 (return to the start): the pose is unknown: the robot was moved, or the map shows \
         another place"
    );
}

#[test]
fn a_file_keeps_text_and_kinds_of_each_reason() {
    for reason in samples().into_iter().map(|(reason, ..)| reason).chain([nested()]) {
        let end = TaskEnd::GivenUp { reason: reason.clone() };
        let text = serde_json::to_string(&end).unwrap();
        let TaskEnd::GivenUp { reason: read } = serde_json::from_str(&text).unwrap() else {
            panic!("{text}")
        };
        assert_eq!((read.to_string(), read.kinds()), (reason.to_string(), reason.kinds()));
        let again = serde_json::to_string(&TaskEnd::GivenUp { reason: read }).unwrap();
        assert_eq!(again, text, "a second file is the first, byte for byte");
    }
}

#[test]
fn a_file_names_the_text_first_and_the_kinds_beside_it() {
    let end = TaskEnd::PutOff { reason: Reason::MovingObstacle };
    assert_eq!(
        serde_json::to_string(&end).unwrap(),
        r#"{"put_off":{"reason":"a moving obstacle blocks the path","kinds":["moving_obstacle"]}}"#
    );
}

#[test]
fn files_without_kinds_and_with_kinds_of_later_versions_are_read() {
    let read = |text| match serde_json::from_str(text).unwrap() {
        TaskEnd::GivenUp { reason } => reason,
        other => panic!("{other}"),
    };
    let old = read(r#"{"given_up":{"reason":"a closed door"}}"#);
    assert_eq!((old.to_string().as_str(), old.kind()), ("a closed door", ReasonKind::Unknown));
    assert!(old.kinds().is_empty());
    let later = read(r#"{"given_up":{"reason":"fog","kinds":["no_progress","fog_ahead"]}}"#);
    assert_eq!(later.kinds(), [ReasonKind::NoProgress, ReasonKind::Unknown]);
}
