//! Log events: one for each change of state, none without cause.

use crate::robot::{Base, robot, wall};
use std::fmt::Write;
use std::sync::{Arc, Mutex};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};
use trundle_core::{Pose2, SensorEvent, Stamp, Touch, WheelTicks};
use trundle_runtime::{DriveState, LazyImage, Reason, Robot, TransitionReason};

/// Keeps level and message of each event.
#[derive(Debug, Clone, Default)]
struct Lines(Arc<Mutex<Vec<(Level, String)>>>);

struct Message<'a>(&'a mut String);

impl Visit for Message<'_> {
    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "message" {
            write!(self.0, "{value:?}").unwrap();
        }
    }
}

impl Subscriber for Lines {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with("trundle_runtime")
    }
    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }
    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn event(&self, event: &Event<'_>) {
        let mut text = String::new();
        event.record(&mut Message(&mut text));
        self.0.lock().unwrap().push((*event.metadata().level(), text));
    }
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// The events of `work`, at `level` alone.
fn events_of(level: Level, work: impl FnOnce()) -> Vec<String> {
    // Beside a single subscriber a thread that has none may switch an event off for all threads.
    let _ = tracing::subscriber::set_global_default(Lines::default());
    let lines = Lines::default();
    tracing::subscriber::with_default(lines.clone(), work);
    let lines = lines.0.lock().unwrap().clone();
    lines.into_iter().filter(|(at, _)| *at == level).map(|(_, text)| text).collect()
}

/// Drives towards a wall for `seconds` s, with images until `until`, s.
fn drive(robot: &mut Robot, seconds: f64, until: f64) {
    let mut base = Base::default();
    for i in 0..(seconds * 50.0) as i64 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        robot.step(&gyro);
        base.command(robot.step(&wheels).twist);
        if i % 5 == 0 && stamp.as_secs() < until {
            robot.step(&wall(stamp, base.to_wall()));
        }
    }
}

#[test]
fn each_change_of_state_is_one_event_with_time_and_reason() {
    let lines = events_of(Level::INFO, || drive(&mut robot(Pose2::new(1.5, 0.0, 0.0)), 5.0, 3.0));
    let changes: Vec<&String> = lines.iter().filter(|line| line.contains(" -> ")).collect();
    assert!(changes[0].ends_with("idle -> initializing: a goal is given"), "{changes:?}");
    assert!(changes.iter().any(|line| line.ends_with("-> driving: a path is found")), "{changes:?}");
    let last = changes.last().unwrap();
    assert!(last.contains("driving -> waiting: the newest image") && last.contains(" s: "), "{last}");
    assert!(changes.len() < 8, "a reason whose numbers alone change is not a new event: {changes:?}");
}

#[test]
fn without_a_change_there_is_no_event() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    drive(&mut robot, 0.5, 0.0);
    let lines = events_of(Level::INFO, || {
        for i in 25..50 {
            robot.step(&SensorEvent::Wheels(WheelTicks {
                stamp: Stamp::from_nanos(i * 20_000_000),
                left: 0,
                right: 0,
            }));
        }
    });
    assert!(lines.is_empty(), "{lines:?}");
}

#[test]
fn a_stop_for_good_is_logged_with_its_reason() {
    let lines = events_of(Level::INFO, || {
        let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
        drive(&mut robot, 0.1, 0.0);
        let stamp = Stamp::from_nanos(100_000_000);
        for pressed in [true, false, true, false, true] {
            robot.step(&SensorEvent::Touch(Touch { stamp, pressed }));
        }
    });
    assert!(lines.iter().any(|line| line.contains("-> stopped: 3 bumper contacts")), "{lines:?}");
}

#[test]
fn each_dropped_image_is_logged_with_its_cause() {
    let image = |ms: i64| match wall(Stamp::from_nanos(ms * 1_000_000), 3.0) {
        SensorEvent::Rgbd(image) => LazyImage::from(image),
        other => panic!("{other:?}"),
    };
    let lines = events_of(Level::DEBUG, || {
        let mut robot = robot(Pose2::new(1.0, 0.0, 0.0)).with_background_jobs();
        robot.queue_image(image(0));
        assert!(robot.next_job().is_none());
        robot.step(&SensorEvent::Wheels(WheelTicks { stamp: Stamp::default(), left: 0, right: 0 }));
        [100, 200, 300].into_iter().for_each(|ms| _ = robot.queue_image(image(ms)));
        robot.drop_queued_image();
    });
    let expected = [
        "image of 0.000 s dropped: no wheel reading came before it",
        "image of 0.100 s dropped: a newer image replaces it",
        "image of 0.200 s dropped: a newer image replaces it",
        "image of 0.300 s dropped: the run is over",
    ];
    assert_eq!(lines, expected);
}

#[test]
fn a_state_with_a_reason_of_its_own_shows_that_and_another_the_reason_for_the_change() {
    let transition = Some(TransitionReason::PlanFound);
    assert_eq!(DriveState::Driving.explained(transition), "driving: a path is found");
    assert_eq!(DriveState::Driving.explained(None), "driving");
    let waiting = DriveState::Waiting { reason: Reason::MovingObstacle };
    assert_eq!(waiting.explained(transition), waiting.to_string());
}
