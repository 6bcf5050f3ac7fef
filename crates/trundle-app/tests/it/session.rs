//! The session: the conditions that end a run, and the commands that the body receives.

use crate::body::{GOAL, StillBody, interrupted, run, setup};
use trundle_app::AFTER_ARRIVAL_S;
use trundle_core::Twist2;
use trundle_runtime::{DriveState, Mission, Reason, ReasonKind, Task, TaskEnd};

#[test]
fn a_run_ends_with_its_events_and_each_wheel_reading_gets_one_command() {
    let mut body = StillBody::new(100);
    let run = run(&setup(), &mut body).unwrap();
    assert_eq!(body.commands, vec![Twist2::ZERO; 100], "without a camera the robot stands");
    assert!((run.log.elapsed() - 99.0 * 0.02).abs() < 1e-9);
    assert_eq!(run.log.state, DriveState::Initializing);
    assert_eq!((run.log.twists.len(), run.log.truths.len()), (100, 100));
    assert!(run.robot.tasks_ended().is_empty() && run.recording.error.is_none());
}

#[test]
fn a_run_ends_when_its_time_is_over() {
    let run = run(&setup().with_time_limit(1.0), &mut StillBody::new(1000)).unwrap();
    assert!((1.0..1.05).contains(&run.log.elapsed()), "{} s", run.log.elapsed());
}

#[test]
fn a_mission_that_fails_ends_the_run_half_a_second_later_with_a_typed_reason() {
    let run = run(&setup(), &mut StillBody::touched()).unwrap();
    let [record] = run.robot.tasks_ended() else { panic!("{:?}", run.robot.tasks_ended()) };
    let TaskEnd::GivenUp { reason } = &record.end else { panic!("{}", record.end) };
    assert_eq!(*reason, Reason::RepeatedContact { contacts: 3 });
    let DriveState::Stopped { reason } = &run.log.state else { panic!("{}", run.log.state) };
    assert_eq!(reason.kinds(), [ReasonKind::TasksFailed, ReasonKind::RepeatedContact]);
    let end = run.log.changes.last().unwrap().at;
    assert!((run.log.elapsed() - end - AFTER_ARRIVAL_S).abs() < 0.05, "{} s after", run.log.elapsed() - end);
    assert_eq!(run.log.contacts(), 3, "presses of the bumper, where truth is not known");
}

#[test]
fn the_user_ends_a_run_and_the_base_gets_a_stop() {
    let mut body = interrupted(90);
    let run = run(&setup(), &mut body).unwrap();
    assert_eq!(run.log.state, DriveState::Stopped { reason: Reason::Interrupted });
    assert_eq!(body.body.commands.len(), 30 + 1);
    assert_eq!(body.body.commands.last(), Some(&Twist2::ZERO));
}

#[test]
fn failures_of_the_body_end_the_run_with_its_words() {
    let error = |mut body: StillBody| run(&setup(), &mut body).err().unwrap().to_string();
    assert_eq!(error(StillBody { fails: true, ..StillBody::new(10) }), "the sensor bus is lost");
    assert_eq!(error(StillBody { refuses: true, ..StillBody::new(10) }), "the base is in charge mode");
}

#[test]
fn contacts_in_truth_count_before_the_bumper() {
    let body = StillBody { contacts: Some(2), ..StillBody::touched() };
    let run = run(&setup(), &mut { body }).unwrap();
    assert_eq!((run.log.contacts(), run.log.presses), (2, 3));
}

#[test]
fn a_goal_that_failed_comes_again_at_the_end_of_the_mission() {
    let mut setup = setup();
    setup.mission = Mission::new(vec![Task::go(GOAL), Task::Return]).unwrap();
    let run = run(&setup, &mut StillBody::touched()).unwrap();
    let [record] = run.robot.tasks_ended() else { panic!("{:?}", run.robot.tasks_ended()) };
    assert!(
        matches!(&record.end, TaskEnd::PutOff { reason } if reason.kind() == ReasonKind::RepeatedContact)
    );
    assert_eq!(run.robot.task(), Some(Task::go(GOAL)), "before the return");
}
