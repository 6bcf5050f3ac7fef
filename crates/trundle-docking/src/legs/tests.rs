//! Laws of legs and of their query.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::Manoeuvre;
use crate::scene::obstacle_scene::{Obstacle, ObstacleScene};
use proptest::prelude::*;
use trundle_core::{Footprint, Pose2, Vector2};

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-0.5..0.5_f64, -0.5..0.5_f64, -3.1..3.1_f64).prop_map(|(x, y, t)| Pose2::new(x, y, t))
}

fn any_legs() -> impl Strategy<Value = Legs> {
    prop::collection::vec((-3.1..3.1_f64, -0.5..0.5_f64), 2..6).prop_map(Legs)
}

fn query(start: Pose2, goal: Pose2) -> DockingQuery {
    DockingQuery { start, goal, limits: MotionLimits::default(), reach: 8.0 }
}

proptest! {
    #[test]
    fn closed_legs_end_at_the_goal_and_keep_all_headings(start in any_pose(), goal in any_pose(), legs in any_legs()) {
        let Some(closed) = legs.closed(&query(start, goal)) else { return Ok(()) };
        let end = closed.corners(&start).last().unwrap();
        prop_assert!((end - goal.position()).norm() < 1e-6);
        let n = legs.0.len();
        prop_assert!(closed.0.iter().zip(&legs.0).all(|(a, b)| a.0 == b.0));
        prop_assert_eq!(&closed.0[..n - 2], &legs.0[..n - 2]);
    }

    #[test]
    fn the_motions_of_free_legs_end_at_the_goal_in_the_time_stated(start in any_pose(), goal in any_pose(), legs in any_legs()) {
        let (query, scene) = (query(start, goal), ObstacleScene::new(&[]).unwrap());
        let Some(closed) = legs.closed(&query) else { return Ok(()) };
        let mut space = ContactSpace::new(&Footprint::KOBUKI, 0.0, &scene);
        let Some((time, motions)) = closed.motions(&query, &mut space) else { return Ok(()) };
        let manoeuvre = Manoeuvre::new(start, &motions, query.limits);
        prop_assert!(manoeuvre.end().distance(&goal) < 1e-6);
        prop_assert!((manoeuvre.duration() - time).abs() < 1e-6, "{} {time}", manoeuvre.duration());
    }

    #[test]
    fn the_least_time_is_never_above_the_time_of_the_motions(start in any_pose(), goal in any_pose(), legs in any_legs()) {
        let wall = Obstacle::Segment(Vector2::new(-2.0, 0.9), Vector2::new(2.0, 0.9));
        let (query, scene) = (query(start, goal), ObstacleScene::new(&[wall]).unwrap());
        let Some(closed) = legs.closed(&query) else { return Ok(()) };
        let corners = [(0.3, 0.05), (-0.1, 0.05), (-0.1, -0.05), (0.3, -0.05)].map(|(x, y)| Vector2::new(x, y));
        let mut space = ContactSpace::new(&Footprint::polygon(corners.to_vec()).unwrap(), 0.0, &scene);
        if let Some((time, _)) = closed.motions(&query, &mut space) {
            prop_assert!(closed.min_time(&query) <= time + 1e-9);
        }
    }

    #[test]
    fn the_poses_of_legs_lie_at_their_corners_with_their_headings(start in any_pose(), legs in any_legs()) {
        let mut from = start.position();
        for (pose, &(heading, distance)) in legs.poses(&start).zip(&legs.0) {
            prop_assert!(((pose.position() - from).norm() - distance.abs()).abs() < 1e-9);
            prop_assert!((pose.theta - heading).abs() < 1e-12);
            from = pose.position();
        }
        prop_assert_eq!(legs.corners(&start).count(), legs.0.len());
    }

    #[test]
    fn the_region_holds_both_ends_and_no_move_inside_it_is_longer_than_the_longest(start in any_pose(), goal in any_pose()) {
        let query = query(start, goal);
        prop_assert!(query.in_region(start.position()) && query.in_region(goal.position()));
        let corner = Vector2::repeat(query.half());
        prop_assert!((query.longest() - 2.0 * corner.norm()).abs() < 1e-9);
        prop_assert!(!query.in_region(query.center() + corner * 1.001));
    }
}

#[test]
fn parallel_last_legs_cannot_be_closed() {
    let query = query(Pose2::IDENTITY, Pose2::new(0.1, 0.2, 0.0));
    assert_eq!(Legs(vec![(0.3, 0.1), (0.3, 0.1)]).closed(&query), None);
    assert_eq!(Legs(vec![(0.3, 0.1), (0.3 - std::f64::consts::PI, 0.1)]).closed(&query), None);
    assert!(Legs(vec![(0.3, 0.1), (0.4, 0.1)]).closed(&query).is_some());
}

#[test]
fn no_motion_costs_nothing_and_every_other_one_its_pause() {
    let query = query(Pose2::IDENTITY, Pose2::IDENTITY);
    assert_eq!((query.turn_cost(0.0), query.drive_cost(0.0)), (0.0, 0.0));
    assert_eq!(query.turn_cost(-0.5), query.limits.turn_time(0.5) + query.limits.switch_time);
    assert_eq!(query.drive_cost(-0.5), query.limits.drive_time(0.5) + query.limits.switch_time);
    assert_eq!(Legs::default().min_time(&query), 0.0);
}

#[test]
fn legs_through_a_wall_or_out_of_the_region_have_no_motions() {
    let wall = Obstacle::Segment(Vector2::new(0.5, -1.0), Vector2::new(0.5, 1.0));
    let scene = ObstacleScene::new(&[wall]).unwrap();
    let free = ObstacleScene::new(&[]).unwrap();
    let straight = query(Pose2::IDENTITY, Pose2::new(1.0, 0.0, 0.0));
    let legs = Legs(vec![(0.0, 1.0)]);
    let motions = |scene: &ObstacleScene, query: &DockingQuery, legs: &Legs| {
        legs.motions(query, &mut ContactSpace::new(&Footprint::KOBUKI, 0.0, scene)).is_some()
    };
    assert!(motions(&free, &straight, &legs) && !motions(&scene, &straight, &legs));
    let small = DockingQuery { reach: 0.1, ..query(Pose2::IDENTITY, Pose2::IDENTITY) };
    let out_and_back = Legs(vec![(0.0, 1.0), (0.0, -1.0)]);
    let wide = DockingQuery { reach: 2.0, ..small };
    assert!(motions(&free, &wide, &out_and_back) && !motions(&free, &small, &out_and_back));
}
