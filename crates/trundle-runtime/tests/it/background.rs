//! The robot with its long work as jobs.

use crate::robot::{Base, robot, wall};
use trundle_core::{Pose2, SensorEvent, Stamp, Touch, Twist2, WheelTicks};
use trundle_runtime::{Answer, DriveState, Job, LazyImage, ReasonKind, Robot, StepReport, Worker};

/// The goal of all these drives.
const GOAL: Pose2 = Pose2 { x: 1.5, y: 0.0, theta: 0.0 };

/// Feeds a robot that drives towards a wall at 50 Hz, with images at 10 Hz until `until`. `work` receives the jobs of each step and returns
/// the answers to apply now.
fn live(
    robot: &mut Robot,
    seconds: f64,
    until: f64,
    mut work: impl FnMut(Stamp, Vec<Job>) -> Vec<Answer>,
) -> Vec<StepReport> {
    let (mut reports, mut base) = (Vec::new(), Base::default());
    for i in 0..(seconds * 50.0) as i64 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        let mut step = robot.step(&gyro);
        step.twist = None;
        for event in [wheels, wall(stamp, base.to_wall())] {
            let report = match event {
                SensorEvent::Rgbd(_) if i % 5 != 0 || stamp.as_secs() >= until => continue,
                SensorEvent::Rgbd(image) => robot.queue_image(LazyImage::from(image)),
                event => robot.step(&event),
            };
            step = followed_by(&step, report);
            let mut jobs: Vec<Job> = std::iter::from_fn(|| robot.next_job()).collect();
            loop {
                let answers = work(stamp, std::mem::take(&mut jobs));
                if answers.is_empty() {
                    break;
                }
                for answer in answers {
                    let report = robot.apply_answer(answer);
                    step = followed_by(&step, report);
                    jobs.extend(std::iter::from_fn(|| robot.next_job()));
                }
            }
        }
        base.command(step.twist);
        reports.push(step);
    }
    reports
}

/// The report of a step of several inputs: the last one, with the last command.
fn followed_by(earlier: &StepReport, mut report: StepReport) -> StepReport {
    report.twist = report.twist.or(earlier.twist);
    report
}

fn at_once(_now: Stamp, jobs: Vec<Job>) -> Vec<Answer> {
    jobs.into_iter().map(Job::run).collect()
}

fn with_background_jobs() -> Robot {
    robot(GOAL).with_background_jobs()
}

/// Jobs whose answers arrive after these delays, s, by worker.
fn after(look: f64, think: f64) -> impl FnMut(Stamp, Vec<Job>) -> Vec<Answer> {
    let mut open: Vec<(Stamp, Job)> = Vec::new();
    move |now, jobs| {
        for job in jobs {
            let takes = if job.worker() == Worker::Perception { look } else { think };
            open.push((now.after(takes), job));
        }
        let (ready, rest): (Vec<_>, Vec<_>) = open.drain(..).partition(|(due, _)| *due <= now);
        open = rest;
        ready.into_iter().map(|(_, job)| job.run()).collect()
    }
}

fn twists(reports: &[StepReport]) -> Vec<Option<Twist2>> {
    reports.iter().map(|report| report.twist).collect()
}

#[test]
fn work_done_at_once_is_work_done_within_the_step() {
    let within = live(&mut robot(GOAL), 4.0, 3.0, |_, jobs| {
        assert!(jobs.is_empty(), "a robot that does not defer gives nothing out");
        Vec::new()
    });
    let mut robot = with_background_jobs();
    let beside = live(&mut robot, 4.0, 3.0, at_once);
    assert_eq!(twists(&within), twists(&beside));
    assert!(within.iter().zip(&beside).all(|(a, b)| a.state == b.state && a.estimate == b.estimate));
    assert!(within.iter().any(|report| report.twist.is_some_and(|twist| twist.v > 0.05)), "it drove");
    assert!(robot.dropped_images().is_empty());
}

#[test]
fn answers_in_the_same_places_give_the_same_reports() {
    let run = || {
        let mut robot = with_background_jobs();
        let reports = live(&mut robot, 4.0, 4.0, after(0.13, 0.07));
        (twists(&reports), robot.dropped_images().to_vec())
    };
    assert_eq!(run(), run());
    assert!(!run().1.is_empty(), "images every 0.1 s, each looked at for 0.13 s");
}

#[test]
fn an_overloaded_worker_gets_the_newest_image() {
    let mut robot = with_background_jobs();
    // Images at 0, 0.1, ... 0.9 s: the first is processed until 0.52 s, then that of 0.5 s until 1.04 s.
    live(&mut robot, 1.0, 1.0, after(0.52, 0.0));
    let dropped: Vec<i64> = robot.dropped_images().iter().map(|stamp| stamp.nanos / 1_000_000).collect();
    assert_eq!(dropped, [100, 200, 300, 400, 600, 700, 800]);
    robot.drop_queued_image();
    assert_eq!(robot.dropped_images().last().unwrap().nanos, 900_000_000);
}

#[test]
fn a_perception_job_that_never_ends_stops_the_robot() {
    let mut looks = 0;
    let mut lost = Vec::new();
    let reports = live(&mut with_background_jobs(), 6.0, 6.0, |_, jobs| {
        let mut answers = Vec::new();
        for job in jobs {
            looks += u32::from(job.worker() == Worker::Perception);
            // From the 25th job on, no perception job returns.
            if job.worker() == Worker::Perception && looks >= 25 {
                lost.push(job)
            } else {
                answers.push(job.run())
            }
        }
        answers
    });
    assert!(reports.iter().any(|report| report.twist.is_some_and(|twist| twist.v > 0.05)), "it drove");
    let last = reports.last().unwrap();
    assert_eq!(last.twist, Some(Twist2::ZERO));
    assert!(
        last.state.reason().is_some_and(|reason| reason.is_due_to(ReasonKind::ImageMissing)),
        "{:?}",
        last.state
    );
}

#[test]
fn during_a_long_decision_job_the_robot_brakes_for_the_bumper() {
    let mut lost = Vec::new();
    let mut robot = with_background_jobs();
    let drives = |report: &StepReport| report.twist.is_some_and(|twist| twist.v > 0.05);
    let reports = live(&mut robot, 2.6, 2.6, |now, jobs| {
        let mut answers = Vec::new();
        for job in jobs {
            let is_gone = now.as_secs() > 2.4 && job.worker() == Worker::Decision;
            if is_gone { lost.push(job) } else { answers.push(job.run()) }
        }
        answers
    });
    assert!(reports[121..].iter().any(drives), "without the captain it goes on");
    assert_eq!(lost.len(), 1, "one captain, one job");
    let stamp = Stamp::from_nanos(2_600_000_000);
    robot.step(&SensorEvent::Touch(Touch { stamp, pressed: true }));
    let report = robot.step(&SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }));
    assert_eq!(report.twist, Some(Twist2::ZERO));
    // After the late answer the robot has the bumper contact; the decision from half a second earlier is not sent.
    let report = robot.apply_answer(lost.remove(0).run());
    assert_eq!(report.twist, None);
    let stamp = stamp.after(0.02);
    let report = robot.step(&SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }));
    assert_eq!(report.twist, Some(Twist2::ZERO));
    assert!(matches!(report.state, DriveState::Waiting { .. }), "{:?}", report.state);
}

#[test]
fn an_image_that_cannot_be_decoded_is_reported() {
    let mut robot = with_background_jobs();
    robot.step(&SensorEvent::Wheels(WheelTicks { stamp: Stamp::default(), left: 0, right: 0 }));
    robot.queue_image(LazyImage::new(Stamp::default(), || Err("no JPEG".to_owned())));
    let mut jobs = std::iter::from_fn(|| robot.next_job());
    let job = jobs.find(|job| job.worker() == Worker::Perception).unwrap();
    let report = robot.apply_answer(job.run());
    assert_eq!((report.broken_image.as_deref(), report.image), (Some("no JPEG"), Some(Stamp::default())));
}
