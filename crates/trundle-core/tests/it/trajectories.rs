//! Laws of trajectories and paths.

use proptest::prelude::*;
use trundle_core::{Path, Pose2, Trajectory, TrajectoryPoint, Twist2, Vector2, wrap_angle};

fn any_points() -> impl Strategy<Value = Vec<TrajectoryPoint>> {
    let sample = (0.01..2.0_f64, -5.0..5.0_f64, -5.0..5.0_f64, -3.1..3.1_f64, -0.7..0.7_f64, -3.0..3.0_f64);
    prop::collection::vec(sample, 1..12).prop_map(|samples| {
        let mut time = 0.0;
        let mut points = Vec::new();
        for (step, x, y, theta, v, omega) in samples {
            points.push(TrajectoryPoint {
                time,
                pose: Pose2::new(x, y, theta),
                twist: Twist2::new(v, omega),
            });
            time += step;
        }
        points
    })
}

fn any_path() -> impl Strategy<Value = Vec<Vector2>> {
    prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y)| Vector2::new(x, y)), 1..20)
}

fn close(a: &Pose2, b: &Pose2) -> bool {
    a.distance(b) < 1e-9 && wrap_angle(a.theta - b.theta).abs() < 1e-9
}

proptest! {
    #[test]
    fn at_the_time_of_a_sample_the_reference_is_the_sample(points in any_points()) {
        let trajectory = Trajectory::new(points.clone()).unwrap();
        for point in &points {
            let at = trajectory.at(point.time);
            prop_assert!(close(&at.pose, &point.pose));
            prop_assert!((at.twist.v - point.twist.v).abs() < 1e-12 && (at.twist.omega - point.twist.omega).abs() < 1e-12);
        }
    }

    #[test]
    fn outside_its_time_the_reference_is_held(points in any_points(), far in 0.0..100.0_f64) {
        let trajectory = Trajectory::new(points.clone()).unwrap();
        prop_assert_eq!(trajectory.at(-1e-9 - far), points[0]);
        prop_assert_eq!(trajectory.at(trajectory.duration() + far), points[points.len() - 1]);
        prop_assert_eq!(trajectory.end(), points[points.len() - 1].pose);
        prop_assert_eq!(trajectory.duration(), points[points.len() - 1].time);
    }

    #[test]
    fn the_reference_has_no_jumps(points in any_points(), part in 0.0..1.0_f64) {
        let trajectory = Trajectory::new(points).unwrap();
        let time = part * trajectory.duration();
        let (now, soon) = (trajectory.at(time), trajectory.at(time + 1e-7));
        // 20 m and half a turn in 0.01 s at most.
        prop_assert!(now.pose.distance(&soon.pose) < 1e-3);
        prop_assert!(wrap_angle(now.pose.theta - soon.pose.theta).abs() < 1e-4);
        prop_assert!((now.twist.v - soon.twist.v).abs() < 1e-4);
    }

    #[test]
    fn between_two_samples_the_reference_lies_between_both(points in any_points(), f in 0.0..1.0_f64) {
        let trajectory = Trajectory::new(points.clone()).unwrap();
        for pair in points.windows(2) {
            let time = pair[0].time + f * (pair[1].time - pair[0].time);
            let at = trajectory.at(time);
            let detour = at.pose.distance(&pair[0].pose) + at.pose.distance(&pair[1].pose);
            prop_assert!((detour - pair[0].pose.distance(&pair[1].pose)).abs() < 1e-9);
            let (low, high) = (pair[0].twist.v.min(pair[1].twist.v), pair[0].twist.v.max(pair[1].twist.v));
            prop_assert!(at.twist.v >= low - 1e-12 && at.twist.v <= high + 1e-12);
        }
    }

    #[test]
    fn a_path_keeps_its_length_in_every_frame_and_in_reverse(points in any_path(), x in -9.0..9.0_f64, t in -3.0..3.0_f64) {
        let path = Path::new(points.clone()).unwrap();
        let frame = Pose2::new(x, -x, t);
        let moved = Path::new(points.iter().map(|p| frame.transform(*p)).collect()).unwrap();
        let back = Path::new(points.iter().rev().copied().collect()).unwrap();
        prop_assert!((moved.length() - path.length()).abs() < 1e-9);
        prop_assert!((back.length() - path.length()).abs() < 1e-9);
    }

    #[test]
    fn a_path_is_never_shorter_than_the_line_between_its_ends(points in any_path()) {
        let path = Path::new(points.clone()).unwrap();
        prop_assert!(path.length() + 1e-12 >= (points[points.len() - 1] - points[0]).norm());
        prop_assert_eq!(path.points(), &points[..]);
    }
}

#[test]
fn a_trajectory_of_one_sample_stays_there() {
    let point = TrajectoryPoint { time: 0.0, pose: Pose2::new(1.0, 2.0, 3.0), twist: Twist2::ZERO };
    let trajectory = Trajectory::new(vec![point]).unwrap();
    assert_eq!((trajectory.duration(), trajectory.at(0.0), trajectory.at(5.0)), (0.0, point, point));
}
