//! Laws of the lower bound: squares, ranges of legs, and chains against random legs.

use crate::contact_space::ContactSpace;
use crate::free_motion::FreeTurn;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::lower_bound::boxes::{PositionBox, Region, Square};
use crate::lower_bound::branch_and_bound::improve;
use crate::lower_bound::chain::{Chain, Ends, MAX_SPLIT_LEGS};
use crate::lower_bound::leg_feasibility::ShrunkHulls;
use crate::lower_bound::ranges::{Heading, LegRange};
use crate::motion::limits::MotionLimits;
use crate::scene::obstacle_scene::{Obstacle, ObstacleScene};
use crate::work_budget::run_to_end;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use trundle_collision::HeadingArc;
use trundle_core::{Footprint, Pose2, Vector2, wrap_angle};

fn any_point() -> impl Strategy<Value = Vector2> {
    (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| Vector2::new(x, y))
}

fn any_box() -> impl Strategy<Value = PositionBox> {
    (any_point(), 0.0..0.4_f64).prop_map(|(center, half)| PositionBox { center, half })
}

/// A point inside a box, from a point of the square between -1 and 1.
fn inside(place: &PositionBox, part: Vector2) -> Vector2 {
    place.center + part * place.half
}

fn query(start: Pose2, goal: Pose2) -> DockingQuery {
    DockingQuery { start, goal, limits: MotionLimits::default(), reach: 1.5 }
}

proptest! {
    #[test]
    fn the_quarters_of_a_square_hold_each_of_its_points(path in prop::collection::vec(0_usize..4, 0..10), part in any_point()) {
        let region = Region { center: Vector2::new(0.3, -0.7), half: 2.0 };
        let square = path.iter().fold(Square::ALL, |square, &i| square.quarters()[i]);
        let whole = region.place(square);
        let p = inside(&whole, part);
        let holding = square.quarters().map(|quarter| region.place(quarter));
        prop_assert!(holding.iter().any(|quarter| (p - quarter.center).amax() <= quarter.half + 1e-12));
        for quarter in holding {
            prop_assert!((quarter.half - whole.half / 2.0).abs() < 1e-15);
            prop_assert!((quarter.center - whole.center).amax() <= whole.half / 2.0 + 1e-12);
        }
    }

    #[test]
    fn every_leg_between_two_boxes_is_in_their_range(a in any_box(), b in any_box(), s in any_point(), t in any_point()) {
        let range = LegRange::between(&a, &b);
        let leg = inside(&b, t) - inside(&a, s);
        prop_assert!(leg.norm() >= range.min - 1e-12);
        if leg.norm() > 1e-9 {
            let off = wrap_angle(leg.y.atan2(leg.x) - range.direction).abs();
            prop_assert!(off <= range.spread + 1e-9, "{off} beyond {}", range.spread);
        }
        prop_assert!(a.radius() >= (inside(&a, s) - a.center).norm() - 1e-12);
    }

    #[test]
    fn no_turn_into_a_range_is_shorter_than_its_least_turn(
        middle in -3.1..3.1_f64, spread in 0.0..1.5_f64, part in -1.0..1.0_f64, from in -3.1..3.1_f64,
    ) {
        let range = Heading { middle, spread };
        let min = range.min_turn_from(from, f64::INFINITY, f64::INFINITY).unwrap();
        prop_assert!(wrap_angle(middle + part * spread - from).abs() >= min - 1e-9);
        prop_assert!((0.0..=PI + 1e-9).contains(&min));
    }

    #[test]
    fn less_free_turn_never_shortens_the_least_turn(
        middle in -3.1..3.1_f64, spread in 0.0..1.0_f64, from in -3.1..3.1_f64, left in 0.0..7.0_f64, right in 0.0..7.0_f64,
    ) {
        let range = Heading { middle, spread };
        let free = range.min_turn_from(from, f64::INFINITY, f64::INFINITY).unwrap();
        let limited = range.min_turn_from(from, left, right);
        prop_assert!(limited.is_none_or(|turn| turn >= free - 1e-12 && turn <= left.max(right) + 1e-12));
    }

    #[test]
    fn gaps_never_shorten_the_least_turn_between_two_ranges(
        a in -3.1..3.1_f64, b in -3.1..3.1_f64, spread in 0.0..0.5_f64, start in 0.0..TAU, length in 0.1..6.0_f64,
    ) {
        let (one, other) = (Heading { middle: a, spread }, Heading { middle: b, spread });
        let free = one.min_turn_to(&other, &[HeadingArc::FULL]).unwrap();
        if let Some(turn) = one.min_turn_to(&other, &[HeadingArc { start, length }]) {
            prop_assert!(turn >= free - 1e-9 && turn <= length + 1e-9);
        }
        prop_assert!((free - other.min_turn_to(&one, &[HeadingArc::FULL]).unwrap()).abs() < 1e-9);
    }

    #[test]
    fn a_chain_through_boxes_is_bounded_below_every_legs_through_points_of_them(
        boxes in prop::collection::vec(any_box(), 1..4), parts in prop::collection::vec(any_point(), 3), gears in 0_u32..16,
        start in -3.1..3.1_f64, goal in -3.1..3.1_f64,
    ) {
        let query = query(Pose2::new(-0.2, 0.1, start), Pose2::new(0.3, -0.1, goal));
        let ends = [query.start, query.goal].map(|pose| PositionBox::exactly(pose.position()));
        let mut places = [ends[1]; MAX_SPLIT_LEGS + 1];
        places[0] = ends[0];
        places[1..=boxes.len()].copy_from_slice(&boxes);
        let legs = boxes.len() + 1;
        let chain = Chain { places: &places, legs, free: [[true; 2]; MAX_SPLIT_LEGS] };
        let free = FreeTurn::ALL_ROUND;
        let full: &[HeadingArc] = &[HeadingArc::FULL];
        let bound = chain.min_time(&Ends { query: &query, start: &free, goal: &free }, [full; MAX_SPLIT_LEGS - 1]).unwrap();
        // Legs through one point of each box.
        let mut points = vec![query.start.position()];
        points.extend(boxes.iter().zip(&parts).map(|(place, part)| inside(place, *part)));
        points.push(query.goal.position());
        let leg = |(i, pair): (usize, &[Vector2])| {
            let (d, backward) = (pair[1] - pair[0], gears >> i & 1 == 1);
            let heading = wrap_angle(d.y.atan2(d.x) + if backward { PI } else { 0.0 });
            (heading, if backward { -d.norm() } else { d.norm() })
        };
        let driven = Legs(points.windows(2).enumerate().map(leg).collect());
        // A pause separates two legs even without a turn.
        let turns = |(a, b): (&(f64, f64), &(f64, f64))| if wrap_angle(a.0 - b.0).abs() < 1e-9 { query.limits.switch_time } else { 0.0 };
        let pauses: f64 = driven.0.iter().zip(&driven.0[1..]).map(turns).sum();
        prop_assert!(bound <= driven.min_time(&query) + pauses + 1e-9, "{bound} above {}", driven.min_time(&query));
    }
}

fn wall() -> ObstacleScene {
    let wall = |y: f64| Obstacle::Segment(Vector2::new(-2.0, y), Vector2::new(2.0, y));
    ObstacleScene::new(&[wall(0.4), wall(-0.4)]).unwrap()
}

fn robot() -> Footprint {
    let corners = [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)].map(|(x, y)| Vector2::new(x, y));
    Footprint::polygon(corners.to_vec()).unwrap()
}

#[test]
fn a_leg_that_is_free_for_the_robot_is_never_excluded_for_a_box_around_it() {
    let scene = wall();
    let space = ContactSpace::new(&robot(), 0.0, &scene);
    let mut shrunk = ShrunkHulls::new(&space);
    let mut tested = 0;
    for i in 0..400 {
        let turn = f64::from(i) * 0.37;
        let (from, to) = (
            Vector2::new(0.5 * turn.sin(), 0.15 * (1.3 * turn).cos()),
            Vector2::new(0.5 * (2.1 * turn).cos(), 0.15 * turn.sin()),
        );
        let d = to - from;
        let heading = d.y.atan2(d.x);
        if !space.drive(&Pose2::new(from.x, from.y, heading), d.norm() + 0.01).allows(d.norm())
            || space.contact(&Pose2::new(from.x, from.y, heading)).is_some()
        {
            continue;
        }
        tested += 1;
        for half in [0.0, 0.01, 0.1] {
            let shift = Vector2::new(0.7 * half, -0.9 * half);
            let [a, b] = [from, to].map(|p| PositionBox { center: p + shift, half });
            assert!(
                shrunk.may_drive(&a, &b, &LegRange::between(&a, &b), false),
                "{from} to {to}, box of {half}"
            );
        }
    }
    assert!(tested > 50, "{tested}");
}

#[test]
fn the_free_headings_of_a_square_hold_those_of_its_points() {
    let scene = wall();
    let mut space = ContactSpace::new(&robot(), 0.0, &scene);
    let mut shrunk = ShrunkHulls::new(&space);
    let region = Region { center: Vector2::zeros(), half: 0.15 };
    for square in Square::ALL.quarters().into_iter().flat_map(Square::quarters) {
        shrunk.find_gaps(&region, square);
        let place = region.place(square);
        for (i, part) in [(-1.0, -1.0), (1.0, -0.5), (0.2, 0.9)].into_iter().enumerate() {
            let p = inside(&place, Vector2::new(part.0, part.1));
            let mut blocked = Vec::new();
            space.blocked_headings(p, &mut blocked);
            for k in 0..90 {
                let heading = f64::from(k) * TAU / 90.0;
                let holds = |arc: &HeadingArc| (heading - arc.start).rem_euclid(TAU) <= arc.length;
                if !blocked.iter().any(holds) {
                    assert!(
                        shrunk.gaps(square).iter().any(holds),
                        "{square:?}, point {i}, heading {heading}"
                    );
                }
            }
        }
    }
}

#[test]
fn branch_and_bound_raises_the_bound_until_it_meets_the_time() {
    let scene = ObstacleScene::new(&[]).unwrap();
    let query = query(Pose2::IDENTITY, Pose2::new(0.0, 0.3, 0.0));
    let bounded = |boxes: usize| {
        let mut space = ContactSpace::new(&robot(), 0.0, &scene);
        run_to_end(improve(&query, &mut space, None, 0.01, (boxes, u64::MAX)))
    };
    let (few, many) = (bounded(100), bounded(20_000));
    assert!(few.bound <= many.bound + 1e-9 && few.boxes <= 101);
    let (time, legs) = many.best.expect("legs without obstacles");
    assert!(many.bound <= time && many.bound >= 0.7 * time, "{} of {time}", many.bound);
    assert!((legs.corners(&query.start).last().unwrap() - query.goal.position()).norm() < 1e-9);
}
