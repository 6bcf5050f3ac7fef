//! The trajectory follower on a simulated base.

use crate::plant::{DT, Plant};
use std::f64::consts::{FRAC_PI_2, PI};
use trundle_control::{FollowPhase, Follower, FollowerConfig};
use trundle_core::{DifferentialDrive, DriveLimits, Pose2, Trajectory, TrajectoryPoint, Twist2};

fn follower() -> Follower {
    Follower::new(FollowerConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI).unwrap()
}

/// A trajectory through legs of (length m, turn rad), each from rest to rest; a leg of length 0 is a turn on the spot.
fn legs(legs: &[(f64, f64)]) -> Trajectory {
    let mut points = vec![TrajectoryPoint { time: 0.0, pose: Pose2::IDENTITY, twist: Twist2::ZERO }];
    for &(length, turn) in legs {
        let from = *points.last().unwrap();
        let seconds = (length.abs() / 0.3).max(turn.abs() / 0.6) * 1.5 + 1.0;
        let steps = (seconds / DT).ceil() as usize;
        let duration = steps as f64 * DT;
        for i in 1..=steps {
            // A raised cosine: smooth speed, zero at both ends.
            let phase = i as f64 / steps as f64;
            let (share, rate) =
                (phase - (2.0 * PI * phase).sin() / (2.0 * PI), 1.0 - (2.0 * PI * phase).cos());
            let pose = from.pose.advance(Twist2::new(length, turn), share);
            let twist = Twist2::new(length / duration * rate, turn / duration * rate);
            points.push(TrajectoryPoint { time: from.time + i as f64 * DT, pose, twist });
        }
    }
    Trajectory::new(points).unwrap()
}

#[derive(Debug)]
struct Run {
    seconds: f64,
    done: bool,
    /// Largest distance from the reference while tracking, m.
    worst: f64,
    position: f64,
    heading_deg: f64,
    phases: Vec<FollowPhase>,
}

/// Follows a trajectory; `alter` may change the command (a safety stop).
fn run(mut plant: Plant, trajectory: &Trajectory, goal: Pose2, alter: impl Fn(f64, Twist2) -> Twist2) -> Run {
    let mut follower = follower();
    follower.follow(trajectory.clone(), goal);
    let mut run =
        Run { seconds: 0.0, done: false, worst: 0.0, position: 0.0, heading_deg: 0.0, phases: vec![] };
    while !run.done && run.seconds < 90.0 {
        let report = follower.step(&plant.estimate(), plant.now);
        let sent = alter(run.seconds, report.twist);
        follower.sent(sent);
        plant.drive(sent);
        if report.phase == FollowPhase::Tracking {
            run.worst = run.worst.max(report.error.distance());
        }
        if run.phases.last() != Some(&report.phase) {
            run.phases.push(report.phase);
        }
        run.done = report.done;
        run.seconds += DT;
    }
    run.position = plant.pose.distance(&goal);
    run.heading_deg = trundle_core::difference_of_angles(plant.pose.theta, goal.theta).abs().to_degrees();
    run
}

fn unchanged(_: f64, twist: Twist2) -> Twist2 {
    twist
}

#[test]
fn straights_curves_and_turns_end_within_the_tolerances() {
    let routes: [&[(f64, f64)]; 4] = [
        &[(2.0, 0.0)],
        &[(0.0, 2.0), (1.5, 1.2), (1.0, -1.5)],
        &[(1.0, 0.8), (0.0, -FRAC_PI_2)],
        &[(-0.6, 0.3), (0.0, 3.0)],
    ];
    for route in routes {
        for offset in [Pose2::IDENTITY, Pose2::new(-0.03, 0.04, 0.1)] {
            let trajectory = legs(route);
            let run = run(Plant::at(offset), &trajectory, trajectory.end(), unchanged);
            eprintln!(
                "{route:?} from {offset:?}: {:.1} s for {:.1} s, worst {:.3} m, end {:.4} m {:.2} deg",
                run.seconds,
                trajectory.duration(),
                run.worst,
                run.position,
                run.heading_deg
            );
            assert!(run.done && run.position < 0.01 && run.heading_deg < 0.5, "{route:?}: {run:?}");
            assert!(run.worst < 0.03 + offset.position().norm(), "{route:?}: {run:?}");
            assert!(run.seconds < trajectory.duration() + 5.0, "{route:?}: {run:?}");
        }
    }
}

#[test]
fn it_settles_with_noise_and_with_a_moved_goal() {
    let trajectory = legs(&[(1.5, 0.5)]);
    let mut plant = Plant::at(Pose2::new(0.0, 0.03, 0.0));
    plant.noise = (0.003, 0.003);
    let goal = trajectory.end() * Pose2::new(0.02, -0.04, 0.1);
    let run = run(plant, &trajectory, goal, unchanged);
    assert!(run.done && run.position < 0.02 && run.heading_deg < 1.0, "{run:?}");
}

#[test]
fn the_reference_waits_for_a_stopped_robot() {
    let trajectory = legs(&[(1.5, 0.5), (0.8, -0.8)]);
    let held = |time: f64, twist| if (2.0..5.0).contains(&time) { Twist2::ZERO } else { twist };
    let run = run(Plant::at(Pose2::IDENTITY), &trajectory, trajectory.end(), held);
    assert!(run.done && run.position < 0.01, "{run:?}");
    assert!(run.worst < 0.15, "the reference ran away: {run:?}");
    assert!(run.seconds > trajectory.duration() + 2.0);
}

#[test]
fn a_robot_limited_to_a_low_speed_arrives() {
    let trajectory = legs(&[(1.0, 0.5)]);
    let creeping = |_: f64, twist: Twist2| {
        let part = (0.08 / twist.v.abs()).min(1.0);
        Twist2::new(twist.v * part, twist.omega * part)
    };
    let run = run(Plant::at(Pose2::IDENTITY), &trajectory, trajectory.end(), creeping);
    assert!(run.done && run.worst < 0.12, "{run:?}");
}

#[test]
fn a_new_trajectory_from_the_reference_causes_no_jump() {
    let trajectory = legs(&[(2.0, 0.5)]);
    let (mut plant, mut follower) = (Plant::at(Pose2::IDENTITY), follower());
    follower.follow(trajectory.clone(), trajectory.end());
    let mut last = Twist2::ZERO;
    for i in 0..200 {
        if i % 25 == 24 {
            let begin = follower.reference().unwrap().time;
            let rest = trajectory.points().iter().filter(|p| p.time > begin + 1e-9);
            let rest = std::iter::once(trajectory.at(begin)).chain(rest.copied());
            let rest = rest.map(|p| TrajectoryPoint { time: p.time - begin, ..p }).collect();
            follower.follow(Trajectory::new(rest).unwrap(), trajectory.end());
            // Times now count from the new beginning.
            let again = follower.reference().unwrap();
            assert_eq!(again.time, 0.0);
            return assert_continues(follower, plant, last);
        }
        let report = follower.step(&plant.estimate(), plant.now);
        last = report.twist;
        plant.drive(report.twist);
    }
}

fn assert_continues(mut follower: Follower, mut plant: Plant, last: Twist2) {
    let next = follower.step(&plant.estimate(), plant.now).twist;
    assert!((next.v - last.v).abs() < 0.011 && (next.omega - last.omega).abs() < 0.061);
}

#[test]
fn after_halt_it_brakes_within_the_limits() {
    let trajectory = legs(&[(2.0, 0.5)]);
    let (mut plant, mut follower) = (Plant::at(Pose2::IDENTITY), follower());
    assert_eq!(follower.step(&plant.estimate(), plant.now).phase, FollowPhase::Idle);
    follower.follow(trajectory.clone(), trajectory.end());
    for _ in 0..150 {
        let report = follower.step(&plant.estimate(), plant.now);
        plant.drive(report.twist);
    }
    let v = plant.twist().v;
    follower.halt();
    let mut steps = 0;
    while plant.twist().v > 1e-3 {
        let report = follower.step(&plant.estimate(), plant.now);
        plant.drive(report.twist);
        steps += 1;
    }
    let braking = f64::from(steps) * DT;
    assert!(v > 0.2 && braking > v / 0.5 - 0.05 && braking < v / 0.5 + 0.6, "{v} m/s, {braking} s");
}

#[test]
fn far_from_its_reference_it_reports_off_track() {
    let trajectory = legs(&[(2.0, 0.0)]);
    let mut follower = follower();
    follower.follow(trajectory.clone(), trajectory.end());
    let mut plant = Plant::at(Pose2::new(0.0, 0.5, 0.0));
    assert!(follower.step(&plant.estimate(), plant.now).off_track);
}
