//! Robots that cannot, or should not, bend sharply.

use crate::support::{at_home, found_plan, judge, planner};
use proptest::prelude::*;
use trundle_core::{OccupancyGrid, Pose2, Twist2};
use trundle_planning::{PlanResult, PlannerConfig};

const RADIUS: f64 = 0.1755;

fn gentle(max_curvature: f64) -> PlannerConfig {
    let mut config = at_home();
    config.curve.max_curvature = max_curvature;
    config.curve.detour = 1.5;
    config
}

fn sharpest(result: &PlanResult) -> f64 {
    let samples = result.curves().flat_map(|curve| curve.samples(0.002));
    samples.map(|sample| sample.curvature.abs()).fold(0.0, f64::max)
}

/// Corridors 1.6 m wide that meet at right angles.
fn bends() -> OccupancyGrid {
    let corridor = |r: usize, c: usize| {
        let first = r < 16;
        let second = (44..60).contains(&c) && r < 60;
        let third = (44..60).contains(&r) && c >= 44;
        first && c < 60 || second || third
    };
    let row = |r: usize| (0..100).map(|c| if corridor(r, c) { '.' } else { '#' }).collect::<String>();
    OccupancyGrid::from_ascii(0.1, &(0..60).rev().map(row).collect::<Vec<_>>().join("\n")).unwrap()
}

#[test]
fn corners_are_taken_as_gently_as_asked() {
    let (start, goal) = (Pose2::new(0.8, 0.8, 0.0), Pose2::new(9.0, 5.2, 0.0));
    for max in [8.0, 3.0, 2.0, 1.5, 1.2] {
        let result = found_plan(planner(gentle(max), RADIUS).plan(&bends(), start, Twist2::ZERO, goal));
        judge(&bends(), &result, start, goal, RADIUS);
        eprintln!(
            "at most {max} /m: {:.2} /m, {} phases, {:.2} m",
            sharpest(&result),
            result.phases.len(),
            result.length
        );
        assert!(sharpest(&result) <= max * 1.001, "{} of {max}", sharpest(&result));
        assert_eq!(result.phases.len(), 1, "{max}: {:?}", result.phases);
    }
}

#[test]
fn where_no_curve_is_gentle_enough_it_turns_on_the_spot() {
    let (start, goal) = (Pose2::new(0.8, 0.8, 0.0), Pose2::new(9.0, 5.2, 0.0));
    let result = found_plan(planner(gentle(0.3), RADIUS).plan(&bends(), start, Twist2::ZERO, goal));
    judge(&bends(), &result, start, goal, RADIUS);
    assert!(sharpest(&result) <= 0.3 * 1.001 && result.phases.len() > 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Two arcs and a line between these headings have the room; so has a curve.
    #[test]
    fn an_open_floor_has_a_gentle_curve(
        x in 4.0..5.0, y in -1.0..1.0, start in -0.7..0.7, end in -0.7..0.7, max in 1.0..4.0,
    ) {
        let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(120); 120].join("\n")).unwrap();
        let heading = f64::atan2(y, x);
        let (start, goal) = (Pose2::new(3.0, 6.0, heading + start), Pose2::new(3.0 + x, 6.0 + y, heading + end));
        let result = found_plan(planner(gentle(max), RADIUS).plan(&grid, start, Twist2::ZERO, goal));
        judge(&grid, &result, start, goal, RADIUS);
        prop_assert!(sharpest(&result) <= max * 1.001, "{} of {max}", sharpest(&result));
        prop_assert!(result.phases.len() == 1, "{max}: {:?}", result.phases.len());
    }
}
