//! The robot in threads: its results, applied in the same order, give the same reports again.

use crate::robot::{robot, wall};
use std::time::Duration;
use trundle_core::{GyroRate, Pose2, RgbdImage, SensorEvent, Stamp, Twist2, WheelTicks};
use trundle_runtime::real_time::{
    Inbox, InboxItem, Input, LoopTimer, LoopTimerConfig, ThreadPlacement, WorkerThreads,
};
use trundle_runtime::{Job, LazyImage, Robot, Worker};

/// Inputs of the robot, in order.
#[derive(Debug, Clone)]
enum Fed {
    Event(SensorEvent),
    Image(RgbdImage),
    Answer(Worker),
}

fn events(seconds: i64) -> Vec<SensorEvent> {
    let at = |i: i64| {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let gyro = SensorEvent::Gyro(GyroRate { stamp, omega: 0.0 });
        let wheels = SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 });
        [Some(gyro), Some(wheels), (i % 2 == 0).then(|| wall(stamp, 3.0))].into_iter().flatten()
    };
    (0..seconds * 50).flat_map(at).collect()
}

/// Feeds `robot` at full speed, with its work in threads; returns the inputs and the commands.
fn live(robot: &mut Robot) -> (Vec<Fed>, Vec<Twist2>) {
    let mut inbox: Inbox<SensorEvent> = Inbox::new(100_000);
    let sender = inbox.sender();
    let worker_threads = WorkerThreads::start(ThreadPlacement::default(), move |answer| {
        _ = sender.put(InboxItem::Answer(answer))
    })
    .unwrap();
    for event in events(4) {
        let is_image = matches!(event, SensorEvent::Rgbd(_));
        inbox.sender().put(if is_image { InboxItem::Deferred(event) } else { InboxItem::Urgent(event) });
    }
    let loop_timer = LoopTimer::new(LoopTimerConfig::default());
    let (mut fed, mut twists) = (Vec::new(), Vec::new());
    while let Some(input) = inbox.next(&loop_timer, Duration::from_secs(1)) {
        let report = match input {
            Input::Event(SensorEvent::Rgbd(image)) => {
                fed.push(Fed::Image(image.clone()));
                robot.queue_image(LazyImage::from(image))
            }
            Input::Event(event) => {
                fed.push(Fed::Event(event.clone()));
                robot.step(&event)
            }
            Input::Answer(answer) => {
                fed.push(Fed::Answer(answer.worker()));
                robot.apply_answer(answer)
            }
        };
        twists.extend(report.twist);
        while let Some(job) = robot.next_job() {
            worker_threads.give(job);
        }
    }
    assert_eq!(worker_threads.finish().len(), Worker::ALL.len());
    (fed, twists)
}

/// Feeds the same inputs to `robot` again, with each job run at the place of its answer.
fn again(robot: &mut Robot, fed: Vec<Fed>) -> Vec<Twist2> {
    let (mut twists, mut jobs) = (Vec::new(), Vec::<Job>::new());
    for fed in fed {
        let report = match fed {
            Fed::Event(event) => robot.step(&event),
            Fed::Image(image) => robot.queue_image(LazyImage::from(image)),
            Fed::Answer(worker) => {
                let at = jobs.iter().position(|job| job.worker() == worker).unwrap();
                robot.apply_answer(jobs.remove(at).run())
            }
        };
        twists.extend(report.twist);
        jobs.extend(std::iter::from_fn(|| robot.next_job()));
    }
    twists
}

#[test]
fn a_threaded_run_is_replayed_without_threads() {
    let robot = || robot(Pose2::new(1.0, 0.5, 1.0)).with_background_jobs();
    let (mut first, mut second) = (robot(), robot());
    let (fed, twists) = live(&mut first);
    assert!(fed.iter().any(|fed| matches!(fed, Fed::Answer(Worker::Perception))));
    assert!(fed.iter().any(|fed| matches!(fed, Fed::Answer(Worker::Decision))));
    assert_eq!(twists, again(&mut second, fed));
    assert_eq!(first.dropped_images(), second.dropped_images());
    assert_eq!(first.grid(), second.grid());
}
