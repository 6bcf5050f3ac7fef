//! Gaps and free motions of the rounded hull.

use crate::support::{any_point, any_pose, any_segment, corners, hull, seen_from};
use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_collision::{RoundedHull, Segment, StraightContact, blocked_headings, straight_contact};
use trundle_core::{Footprint, Pose2, Vector2};

/// Slack of a sampled contact, m.
const SLACK_M: f64 = 1e-9;

proptest! {
    #[test]
    fn a_gap_does_not_change_under_a_rigid_motion(segment in any_segment(), motion in any_pose(), pose in any_pose()) {
        let moved = Segment { a: motion.transform(segment.a), b: motion.transform(segment.b) };
        let here = hull(0.02).distance(&seen_from(pose, &segment));
        let there = hull(0.02).distance(&seen_from(motion * pose, &moved));
        prop_assert!((here - there).abs() < 1e-9, "{here} {there}");
    }

    #[test]
    fn a_gap_does_not_depend_on_the_direction_of_a_segment(segment in any_segment()) {
        let reversed = Segment { a: segment.b, b: segment.a };
        let (there, back) = (hull(0.02).distance(&segment), hull(0.02).distance(&reversed));
        prop_assert!((there - back).abs() < 1e-12, "{there} {back}");
        prop_assert!(hull(0.02).overlaps(&segment) == hull(0.02).overlaps(&reversed) || there < 1e-12);
    }

    #[test]
    fn a_mirrored_footprint_has_the_gap_of_the_mirrored_segment(segment in any_segment()) {
        let mirrored = |p: Vector2| Vector2::new(p.x, -p.y);
        let other = Footprint::polygon(corners().into_iter().map(mirrored).collect()).unwrap();
        let there = Segment { a: mirrored(segment.a), b: mirrored(segment.b) };
        let (gap, other) = (hull(0.02).distance(&segment), RoundedHull::new(&other, 0.02).distance(&there));
        prop_assert!((gap - other).abs() < 1e-12);
    }

    #[test]
    fn a_margin_reduces_the_gap_by_itself(segment in any_segment(), margin in 0.001..0.2_f64) {
        let (bare, grown) = (hull(1e-4).distance(&segment), hull(margin).distance(&segment));
        prop_assert!(((bare + 1e-4 - margin).max(0.0) - grown).abs() < 1e-12);
    }

    #[test]
    fn every_sampled_heading_of_a_free_turn_is_free(segment in any_segment(), heading in -3.1..3.1_f64) {
        let (hull, mut angles, mut blocked) = (hull(0.02), Vec::new(), Vec::new());
        blocked_headings(&hull, &segment, &mut angles, &mut blocked);
        let free = |at: f64| blocked.iter().all(|arc| (at - arc.start).rem_euclid(TAU) > arc.length);
        let (left, right) = blocked.iter().fold((TAU, TAU), |(left, right), arc| {
            let (l, r) = arc.free_turn_from(heading);
            (left.min(l), right.min(r))
        });
        for i in 0..=60 {
            let part = f64::from(i) / 60.0 * (1.0 - 1e-9);
            for turn in [part * left, -part * right] {
                let pose = Pose2::new(0.0, 0.0, heading + turn);
                let gap = hull.distance(&seen_from(pose, &segment));
                prop_assert!(left == 0.0 || gap > 0.0 || !hull.overlaps(&seen_from(pose, &segment)), "{turn}");
            }
        }
        // A heading is free exactly if the hull has no overlap.
        for i in 0..90 {
            let at = TAU * f64::from(i) / 90.0;
            let seen = seen_from(Pose2::new(0.0, 0.0, at), &segment);
            let near = (hull.core_distance(&seen) - 0.02).abs() < 1e-6;
            prop_assert!(near || free(at) != hull.overlaps(&seen), "{at}");
        }
    }

    #[test]
    fn every_sampled_pose_of_a_free_straight_move_is_free_and_its_end_touches(segment in any_segment()) {
        let hull = hull(0.02);
        prop_assume!(!hull.overlaps(&segment));
        let (sign, free) = match straight_contact(&hull, &segment) {
            Some(StraightContact::Ahead(free)) => (1.0, free),
            Some(StraightContact::Behind(free)) => (-1.0, free),
            None => (1.0, 3.0),
        };
        for i in 0..=50 {
            let at = Pose2::new(sign * free * f64::from(i) / 50.0, 0.0, 0.0);
            let seen = seen_from(at, &segment);
            prop_assert!(!hull.overlaps(&seen) || hull.core_distance(&seen) > 0.02 - SLACK_M, "{i}");
        }
        let end = seen_from(Pose2::new(sign * free, 0.0, 0.0), &segment);
        prop_assert!(straight_contact(&hull, &segment).is_none() || hull.distance(&end) < 1e-6);
    }

    #[test]
    fn a_shrunk_hull_touches_nothing_within_its_depth(point in any_point(), depth in 0.001..0.1_f64) {
        let (whole, point) = (hull(0.01), Segment::point(point));
        let Some(small) = whole.shrunk(depth) else { return Ok(()) };
        prop_assume!(whole.distance(&point) > 0.0);
        prop_assert!(small.distance(&point) >= whole.distance(&point) + depth - 1e-9);
    }
}
