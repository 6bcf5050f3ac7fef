//! The run log: for evaluation and pictures.

use trundle_app::{RunLog, TrackCounts};
use trundle_core::{Pose2, PoseEstimate, SensorEvent, Stamp, Touch, Twist2};
use trundle_runtime::{DriveState, Reason, StepReport};
use trundle_slam::Tracking;

fn at(seconds: f64) -> Stamp {
    Stamp::default().after(seconds)
}

fn truth(seconds: f64, x: f64) -> SensorEvent {
    SensorEvent::Truth { stamp: at(seconds), pose: Pose2::new(x, 0.0, 0.0) }
}

fn estimate(seconds: f64, pose: Pose2) -> PoseEstimate {
    let covariance = nalgebra::Matrix3::zeros();
    PoseEstimate { stamp: at(seconds), pose, twist: Twist2::ZERO, covariance }
}

fn report(seconds: f64, x: f64, state: DriveState) -> StepReport {
    let mut report = StepReport::default();
    (report.estimate, report.state) = (Some(estimate(seconds, Pose2::new(x, 0.0, 0.0))), state);
    report
}

#[test]
fn each_change_of_the_state_or_of_its_kind_of_reason_is_logged_once() {
    let mut log = RunLog::default();
    let waiting = |reason| DriveState::Waiting { reason };
    let states = [
        DriveState::Driving,
        DriveState::Driving,
        waiting(Reason::PoseUncertain { sigma: 0.4 }),
        waiting(Reason::PoseUncertain { sigma: 0.5 }),
        waiting(Reason::MovingObstacle),
        DriveState::Driving,
    ];
    for (i, state) in states.into_iter().enumerate() {
        let now = 5.0 + i as f64;
        log.on_report(at(now), &report(now, 0.1 * i as f64, state));
    }
    let changes: Vec<_> = log.changes.iter().map(|change| (change.at, change.state.to_string())).collect();
    let uncertain = DriveState::Waiting { reason: Reason::PoseUncertain { sigma: 0.4 } }.to_string();
    let expected = [
        (0.0, "driving"),
        (2.0, &uncertain),
        (4.0, "waiting: a moving obstacle blocks the path"),
        (5.0, "driving"),
    ];
    assert_eq!(changes, expected.map(|(at, text)| (at, text.to_owned())));
    assert_eq!(log.changes[1].pose.x, 0.2);
    assert_eq!((log.elapsed(), log.state.clone()), (5.0, DriveState::Driving));
}

#[test]
fn truth_is_the_newest_up_to_an_instant_in_the_map_frame() {
    let mut log = RunLog::default();
    let map_from_world = Pose2::new(10.0, 0.0, 0.0);
    for i in 0..5 {
        log.on_event(&truth(f64::from(i), f64::from(i)), map_from_world);
    }
    assert_eq!(log.truth_at(at(-0.1)), None);
    for (seconds, x) in [(0.0, 10.0), (1.99, 11.0), (2.0, 12.0), (99.0, 14.0)] {
        assert_eq!(log.truth_at(at(seconds)).unwrap().x, x, "{seconds} s");
    }
    assert_eq!(log.path_length(), 4.0);
}

#[test]
fn the_error_of_the_estimate_is_over_images_with_truth() {
    let mut log = RunLog::default();
    assert_eq!(log.estimate_rmse(), None);
    log.estimates = vec![
        estimate(0.0, Pose2::new(5.0, 0.0, 0.0)),
        estimate(1.0, Pose2::new(1.03, 0.0, 0.0)),
        estimate(2.0, Pose2::new(2.0, 0.04, 0.0)),
    ];
    log.truths = vec![(at(1.0), Pose2::new(1.0, 0.0, 0.0)), (at(2.0), Pose2::new(2.0, 0.0, 0.0))];
    assert_eq!(log.pose_samples().len(), 2, "before the first truth there is nothing to compare");
    let expected = ((0.03_f64.powi(2) + 0.04_f64.powi(2)) / 2.0).sqrt();
    assert!((log.estimate_rmse().unwrap() - expected).abs() < 1e-12);
}

#[test]
fn without_truth_the_path_is_the_estimated_one() {
    let mut log = RunLog::default();
    assert_eq!(log.path_length(), 0.0);
    log.estimates = vec![estimate(0.0, Pose2::IDENTITY), estimate(1.0, Pose2::new(0.3, 0.4, 1.0))];
    assert_eq!(log.path_length(), 0.5);
}

#[test]
fn contacts_are_those_in_truth_where_they_are_known() {
    let mut log = RunLog::default();
    for pressed in [true, false, true] {
        log.on_event(&SensorEvent::Touch(Touch { stamp: at(0.0), pressed }), Pose2::IDENTITY);
    }
    assert_eq!(log.contacts(), 2);
    log.true_contacts = Some(0);
    assert_eq!(log.contacts(), 0);
}

#[test]
fn images_are_counted_by_tracking_state() {
    let mut counts = TrackCounts::default();
    let images = [Tracking::Ok, Tracking::Ok, Tracking::Weak, Tracking::DeadReckoning, Tracking::Lost];
    images.into_iter().for_each(|tracking| counts.count(tracking));
    assert_eq!((counts.ok, counts.weak, counts.dead_reckoned, counts.lost), (2, 1, 1, 1));
}

#[test]
fn stamps_are_seconds_since_the_first_event() {
    let mut log = RunLog::default();
    assert_eq!(log.seconds_of(&[at(7.0)]), [0.0]);
    log.on_report(at(5.0), &report(5.0, 0.0, DriveState::Idle));
    assert_eq!(log.seconds_of(&[at(5.0), at(7.5)]), [0.0, 2.5]);
}
