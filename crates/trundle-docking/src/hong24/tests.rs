//! Decisions of the method: the order of the deviations, the cost of candidates, recovery moves.

use crate::contact_space::ContactSpace;
use crate::hong24::config::Hong24Config;
use crate::hong24::decide::{Decision, Hong24Method};
use crate::hong24::plan::plan;
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::Motion;
use crate::scene::obstacle_scene::{Obstacle, ObstacleScene};
use crate::work_budget::{WorkBudget, run_to_end};
use std::sync::Arc;
use trundle_collision::RoundedHull;
use trundle_core::{Footprint, Pose2, Vector2};

fn at(x: f64, y: f64) -> Vector2 {
    Vector2::new(x, y)
}

fn robot() -> Footprint {
    let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| at(x, y));
    Footprint::polygon(corners.to_vec()).unwrap()
}

fn scene(obstacles: &[Obstacle]) -> ObstacleScene {
    ObstacleScene::new(obstacles).unwrap()
}

/// The decision at `pose`, with the goal at the origin.
fn decided(obstacles: &[Obstacle], config: &Hong24Config, pose: Pose2, recoveries: usize) -> Decision {
    let scene = scene(obstacles);
    let space = ContactSpace::new(&robot(), 0.0, &scene);
    let method = Hong24Method { space: &space, limits: MotionLimits::default(), config };
    run_to_end(method.decide(&pose, &Pose2::IDENTITY, recoveries))
}

fn moved(obstacles: &[Obstacle], config: &Hong24Config, pose: Pose2) -> Vec<Motion> {
    match decided(obstacles, config, pose, 0) {
        Decision::Move(motions) => motions,
        other => panic!("{other:?}"),
    }
}

/// The pose after some motions.
fn after(pose: Pose2, motions: &[Motion]) -> Pose2 {
    motions.iter().fold(pose, |pose, motion| motion.after(pose, motion.amount()))
}

#[test]
fn below_all_three_thresholds_the_method_is_settled() {
    let config = Hong24Config::default();
    for (x, y, theta) in [(0.0, 0.0, 0.0), (0.0099, 0.0099, 0.017), (-0.0099, -0.0099, -0.017)] {
        assert_eq!(
            decided(&[], &config, Pose2::new(x, y, theta), 0),
            Decision::Settled,
            "({x}, {y}, {theta})"
        );
    }
}

#[test]
fn the_lateral_deviation_comes_before_the_longitudinal_one() {
    let start = Pose2::new(0.5, 0.2, 0.0);
    let end = after(start, &moved(&[], &Hong24Config::default(), start));
    assert!(end.y.abs() < 0.05 && end.x.abs() > 0.02, "{end:?}");
}

#[test]
fn the_longitudinal_deviation_is_driven_along_the_goal_heading() {
    let start = Pose2::new(0.3, 0.005, 0.4);
    let motions = moved(&[], &Hong24Config::default(), start);
    let [Motion::Turn(turn), Motion::Drive(distance)] = motions[..] else { panic!("{motions:?}") };
    assert!((turn + 0.4).abs() < 1e-12 && (distance + 0.3).abs() < 1e-12, "{motions:?}");
}

#[test]
fn the_angle_comes_last_and_takes_the_shorter_turn() {
    for theta in [0.5, -0.5, 3.0, -3.0] {
        let motions = moved(&[], &Hong24Config::default(), Pose2::new(0.005, 0.005, theta));
        let [Motion::Turn(turn)] = motions[..] else { panic!("{motions:?}") };
        assert!((turn + theta).abs() < 1e-12, "{turn} for {theta}");
    }
}

#[test]
fn the_chosen_pair_has_the_least_cost_of_all_sampled_pairs() {
    let (config, limits) = (
        Hong24Config { angle_step: 0.1, distance_step: 0.05, ..Hong24Config::default() },
        MotionLimits::default(),
    );
    for start in [Pose2::new(-0.2, 0.15, 0.3), Pose2::new(0.1, -0.3, -1.0), Pose2::new(0.0, 0.05, 2.0)] {
        let cost = |turn: f64, distance: f64| {
            let end = after(start, &[Motion::Turn(turn), Motion::Drive(distance)]);
            config.time_weight * (limits.turn_time(turn) + limits.drive_time(distance))
                + config.lateral_weight * end.y.abs()
        };
        let motions = moved(&[], &config, start);
        let [Motion::Turn(turn), Motion::Drive(distance)] = motions[..] else { panic!("{motions:?}") };
        // Every pair: the point D of a straight is its sample of minimum lateral deviation.
        let mut min = f64::INFINITY;
        for i in -31..=31 {
            for sign in [1.0, -1.0] {
                let left = |k: i32| {
                    after(
                        start,
                        &[Motion::Turn(0.1 * f64::from(i)), Motion::Drive(sign * 0.05 * f64::from(k))],
                    )
                    .y
                    .abs()
                };
                let d = (1..=16).take_while(|&k| k == 1 || left(k) < left(k - 1)).last().unwrap();
                if left(d) < start.y.abs() - config.lateral_threshold / 2.0 {
                    min = min.min(cost(0.1 * f64::from(i), sign * 0.05 * f64::from(d)));
                }
            }
        }
        assert!(
            (cost(turn, distance) - min).abs() < 1e-9,
            "{motions:?} costs {}, not {min}",
            cost(turn, distance)
        );
    }
}

#[test]
fn a_larger_lateral_weight_leaves_less_and_a_larger_time_weight_takes_less_time() {
    let (start, limits) = (Pose2::new(0.0, 0.25, 0.2), MotionLimits::default());
    let judged = |config: &Hong24Config| {
        let motions = moved(&[], config, start);
        (after(start, &motions).y.abs(), motions.iter().map(|motion| motion.time(&limits)).sum::<f64>())
    };
    let exact = judged(&Hong24Config { lateral_weight: 1e4, ..Hong24Config::default() });
    let quick = judged(&Hong24Config { time_weight: 100.0, lateral_weight: 10.0, ..Hong24Config::default() });
    assert!(exact.0 < quick.0 && exact.1 > quick.1, "{exact:?} {quick:?}");
}

#[test]
fn of_two_equal_candidates_the_clockwise_and_the_forward_one_is_taken() {
    let motions = moved(&[], &Hong24Config::default(), Pose2::new(0.0, 0.2, 0.0));
    assert!(
        matches!(motions[..], [Motion::Turn(turn), Motion::Drive(distance)] if turn < 0.0 && distance > 0.0),
        "{motions:?}"
    );
}

#[test]
fn no_chosen_motion_passes_a_sample_that_touches() {
    let walls = [
        Obstacle::Segment(at(-2.0, 0.45), at(2.0, 0.45)),
        Obstacle::Segment(at(-2.0, -0.45), at(2.0, -0.45)),
    ];
    let (scene, mut pose) = (scene(&walls), Pose2::new(-0.1, -0.2, 0.1));
    let space = ContactSpace::new(&robot(), 0.0, &scene);
    for motion in moved(&walls, &Hong24Config::default(), pose) {
        for i in 0..=100 {
            let sample = motion.after(pose, motion.amount() * f64::from(i) / 100.0);
            assert_eq!(space.contact(&sample), None, "{motion:?} at {sample:?}");
        }
        pose = motion.after(pose, motion.amount());
    }
}

/// A sleeve around the robot next to the goal: it can neither turn nor approach the goal's line.
fn sleeve() -> Vec<Obstacle> {
    [-0.01, 0.41].map(|y| Obstacle::Segment(at(-2.0, y), at(2.0, y))).to_vec()
}

#[test]
fn recovery_moves_alternate_between_back_and_forward() {
    let (config, pose) = (Hong24Config::default(), Pose2::new(0.0, 0.2, 0.0));
    for (recoveries, distance) in [(0, -0.1), (1, 0.1), (2, -0.1), (3, 0.1)] {
        match decided(&sleeve(), &config, pose, recoveries) {
            Decision::Recover(Motion::Drive(length)) => {
                assert!((length - distance).abs() < 1e-12, "{length}")
            }
            other => panic!("{recoveries}: {other:?}"),
        }
    }
}

#[test]
fn a_recovery_goes_the_other_way_where_its_own_is_blocked_and_is_stuck_between_both() {
    let (config, pose) = (Hong24Config::default(), Pose2::new(0.0, 0.2, 0.0));
    let (mut behind, front) = (sleeve(), Obstacle::Segment(at(0.305, 0.0), at(0.305, 0.4)));
    behind.push(Obstacle::Segment(at(-0.305, 0.0), at(-0.305, 0.4)));
    assert!(
        matches!(decided(&behind, &config, pose, 0), Decision::Recover(Motion::Drive(length)) if length > 0.0)
    );
    behind.push(front);
    assert_eq!(decided(&behind, &config, pose, 0), Decision::Stuck);
}

#[test]
fn once_the_work_is_used_up_the_method_is_stuck() {
    let (scene, config) = (scene(&[]), Hong24Config::default());
    let hull = RoundedHull::new(&robot(), 0.0);
    let space = ContactSpace::metered(hull, &scene, WorkBudget::endless(10));
    space.spend(10);
    let method = Hong24Method { space: &space, limits: MotionLimits::default(), config: &config };
    assert_eq!(run_to_end(method.decide(&Pose2::new(0.0, 0.2, 0.0), &Pose2::IDENTITY, 0)), Decision::Stuck);
}

#[test]
fn a_plan_ends_within_the_thresholds_or_after_the_largest_number_of_motions() {
    let (scene, limits) = (scene(&[]), MotionLimits::default());
    let space = ContactSpace::metered(
        RoundedHull::new(&robot(), 0.0),
        &scene,
        Arc::clone(&WorkBudget::endless(u64::MAX)),
    );
    let planned = |max_motions: usize| {
        let config = Hong24Config { max_motions, ..Hong24Config::default() };
        run_to_end(plan(&space, Pose2::new(0.4, 0.3, 2.0), Pose2::IDENTITY, &limits, &config))
    };
    let end = planned(40).expect("a plan").end();
    assert!(end.x.abs() <= 0.01 && end.y.abs() <= 0.01 && end.theta.abs() <= 1_f64.to_radians(), "{end:?}");
    assert_eq!(planned(1), None);
}
