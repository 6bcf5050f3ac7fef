//! Propagation does not depend on the frames in which trajectories are given.

use crate::rbpf::propagate_trajectory;
use proptest::prelude::*;
use trundle_core::{Pose2, Stamp, wrap_angle};

type Trajectory = Vec<(Stamp, Pose2)>;

fn stamp(i: usize) -> Stamp {
    Stamp::from_nanos(i as i64 * 50_000_000)
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-5.0..5.0_f64, -5.0..5.0_f64, -3.0..3.0_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

/// Odometry of 20 small steps, and corrected poses at some of its stamps.
fn any_run() -> impl Strategy<Value = (Trajectory, Trajectory)> {
    let step = (0.0..0.3_f64, -0.1..0.1_f64, -0.3..0.3_f64);
    let steps = prop::collection::vec(step, 20);
    let errors = prop::collection::vec((-0.05..0.05_f64, -0.05..0.05_f64, -0.05..0.05_f64), 4);
    (steps, errors).prop_map(|(steps, errors)| {
        let mut odometry = vec![(stamp(0), Pose2::IDENTITY)];
        for (i, (x, y, theta)) in steps.into_iter().enumerate() {
            odometry.push((stamp(i + 1), odometry[i].1 * Pose2::new(x, y, theta)));
        }
        let known = |(k, (x, y, theta)): (usize, (f64, f64, f64))| {
            let (at, pose) = odometry[2 + 5 * k];
            (at, pose * Pose2::new(x, y, theta))
        };
        let processed = errors.into_iter().enumerate().map(known).collect();
        (odometry, processed)
    })
}

fn moved(by: Pose2, trajectory: &[(Stamp, Pose2)]) -> Trajectory {
    trajectory.iter().map(|(at, pose)| (*at, by * *pose)).collect()
}

fn is_same(a: &[(Stamp, Pose2)], b: &[(Stamp, Pose2)]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| {
            a.0 == b.0 && a.1.distance(&b.1) < 1e-9 && wrap_angle(a.1.theta - b.1.theta).abs() < 1e-9
        })
}

proptest! {
    #[test]
    fn the_origin_of_the_odometry_does_not_matter((odometry, processed) in any_run(), origin in any_pose()) {
        let expected = propagate_trajectory(&processed, &odometry);
        prop_assert_eq!(expected.len(), odometry.len() - 2);
        prop_assert!(is_same(&propagate_trajectory(&processed, &moved(origin, &odometry)), &expected));
    }

    #[test]
    fn a_moved_map_moves_the_trajectory((odometry, processed) in any_run(), by in any_pose()) {
        let expected = moved(by, &propagate_trajectory(&processed, &odometry));
        prop_assert!(is_same(&propagate_trajectory(&moved(by, &processed), &odometry), &expected));
    }

    #[test]
    fn odometry_without_error_is_returned_as_it_is((odometry, processed) in any_run()) {
        let exact: Vec<_> = processed
            .iter()
            .map(|(at, _)| *odometry.iter().find(|(stamp, _)| stamp == at).unwrap())
            .collect();
        prop_assert!(is_same(&propagate_trajectory(&exact, &odometry), &odometry[2..]));
    }
}

#[test]
fn without_processed_poses_there_is_no_trajectory() {
    assert!(propagate_trajectory(&[], &[(stamp(0), Pose2::IDENTITY)]).is_empty());
}
