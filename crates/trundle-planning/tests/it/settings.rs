//! Settings and input outside their range are refused with key, value, unit and range.

use trundle_core::{Footprint, GridGeometry, Invalid, Vector2};
use trundle_planning::{
    ClearanceCostConfig, CostMask, CurveConfig, ExploreConfig, MovingObstacle, ObstacleTrackerConfig,
    PlannerConfig, PotentialConfig, SpeedMask, TimingConfig, WaypointGraph,
};

/// A setting: key, unit, lowest and highest value, and how it is set.
type Setting<C> = (&'static str, &'static str, f64, f64, fn(&mut C, f64));

/// Both ends of each range are accepted; values outside and not-a-number are refused by name.
fn refuses<C: Clone>(
    prefix: &str,
    good: &C,
    settings: &[Setting<C>],
    check: impl Fn(C) -> Result<C, Invalid>,
) {
    for (key, unit, low, high, set) in settings {
        let with = |value: f64| {
            let mut config = good.clone();
            set(&mut config, value);
            check(config).map(|_| ()).map_err(|error| error.to_string())
        };
        assert_eq!((with(*low), with(*high)), (Ok(()), Ok(())), "{key}");
        for bad in [low - 0.0005, high * 1.01, f64::NAN, f64::INFINITY] {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            let expected = format!("{prefix}{key} is {bad}{unit}, expected {low} to {high}");
            assert_eq!(with(bad), Err(expected), "{key}");
        }
    }
}

#[test]
fn every_cost_of_low_clearance_is_checked() {
    let settings: [Setting<ClearanceCostConfig>; 7] = [
        ("margin", "m", 0.0, 1.0, |c, x| c.margin = x),
        ("margin_weight", "", 0.0, 100.0, |c, x| c.margin_weight = x),
        ("comfort", "m", 0.0, 5.0, |c, x| c.comfort = x),
        ("comfort_weight", "", 0.0, 10.0, |c, x| c.comfort_weight = x),
        ("unknown_weight", "", 0.0, 100.0, |c, x| c.unknown_weight = x),
        ("mask_weight", "", 0.0, 20.0, |c, x| c.mask_weight = x),
        ("escape", "m", 0.0, 1.0, |c, x| c.escape = x),
    ];
    refuses("room.", &ClearanceCostConfig::default(), &settings, ClearanceCostConfig::validated);
}

#[test]
fn every_number_of_the_curve_is_checked() {
    let settings: [Setting<CurveConfig>; 7] = [
        ("piece", "m", 0.1, 100.0, |c, x| c.piece = x),
        ("reach", "m", 0.1, 10.0, |c, x| c.reach = x),
        ("min_tangent", "", 0.01, 1.0, |c, x| c.min_tangent = x),
        ("max_curvature", "1/m", 0.1, 1000.0, |c, x| c.max_curvature = x),
        ("detour", "", 1.0, 10.0, |c, x| c.detour = x),
        ("turn_first", "rad", 0.0, std::f64::consts::PI, |c, x| c.turn_first = x),
        ("turn_last", "rad", 0.0, std::f64::consts::PI, |c, x| c.turn_last = x),
    ];
    refuses("curve.", &CurveConfig::default(), &settings, CurveConfig::validated);
    for (degree, good) in [(4, false), (5, true), (12, true), (13, false)] {
        let mut config = CurveConfig::default();
        config.degree = degree;
        assert_eq!(config.validated().is_ok(), good, "{degree}");
    }
    let text = |smoothing| {
        let mut config = CurveConfig::default();
        config.smoothing = smoothing;
        config.validated().unwrap_err().to_string()
    };
    assert_eq!(text(0.0), "curve.smoothing is 0 m, expected a finite number above 0");
    assert_eq!(text(11.0), "curve.smoothing is 11 m, expected 0 to 10");
}

#[test]
fn every_number_of_the_timing_is_checked() {
    let settings: [Setting<TimingConfig>; 5] = [
        ("period", "s", 0.001, 1.0, |c, x| c.period = x),
        ("slow_speed", "m/s", 0.01, 10.0, |c, x| c.slow_speed = x),
        ("full_speed_clearance", "m", 0.0, 10.0, |c, x| c.full_speed_clearance = x),
        ("unknown_speed", "m/s", 0.01, 10.0, |c, x| c.unknown_speed = x),
        ("jerk", "m/s^3", 0.01, 1000.0, |c, x| c.jerk = Some(x)),
    ];
    refuses("timing.", &TimingConfig::default(), &settings, TimingConfig::validated);
}

#[test]
fn every_number_of_the_tracker_of_moving_obstacles_is_checked() {
    let settings: [Setting<ObstacleTrackerConfig>; 9] = [
        ("reach", "m", 1.0, 20.0, |c, x| c.reach = x),
        ("memory", "s", 0.1, 60.0, |c, x| c.memory = x),
        ("gap", "m", 0.01, 2.0, |c, x| c.gap = x),
        ("smallest", "m", 0.0, 5.0, |c, x| c.smallest = x),
        ("largest", "m", 0.05, 10.0, |c, x| c.largest = x),
        ("gate", "m", 0.05, 10.0, |c, x| c.gate = x),
        ("window", "s", 0.1, 10.0, |c, x| c.window = x),
        ("min_speed", "m/s", 0.01, 10.0, |c, x| c.min_speed = x),
        ("min_distance", "m", 0.01, 10.0, |c, x| c.min_distance = x),
    ];
    refuses("tracker.", &ObstacleTrackerConfig::default(), &settings, ObstacleTrackerConfig::validated);
    let mut one = ObstacleTrackerConfig::default();
    one.sightings = 1;
    assert_eq!(one.validated().unwrap_err().to_string(), "tracker.sightings is 1, expected 2 to 1000");
    let mut none = ObstacleTrackerConfig::default();
    none.min_hits = 0;
    assert_eq!(none.validated().unwrap_err().to_string(), "tracker.min_hits is 0, expected 1 to 10000");
}

#[test]
fn every_number_of_the_exploration_is_checked() {
    let settings: [Setting<ExploreConfig>; 4] = [
        ("min_frontier", "m", 0.05, 5.0, |c, x| c.min_frontier = x),
        ("view_distance", "m", 0.5, 10.0, |c, x| c.view_distance = x),
        ("gain", "", 0.0, 10.0, |c, x| c.gain = x),
        ("reach", "m", 1.0, 1000.0, |c, x| c.reach = x),
    ];
    refuses("explore.", &ExploreConfig::default(), &settings, ExploreConfig::validated);
}

#[test]
fn the_planner_checks_its_own_numbers_and_those_of_its_parts() {
    let settings: [Setting<PlannerConfig>; 2] = [
        ("beyond", "m", 0.0, 100.0, |c, x| c.beyond = x),
        ("goal_tolerance", "m", 0.0, 100.0, |c, x| c.goal_tolerance = x),
    ];
    refuses("", &PlannerConfig::default(), &settings, PlannerConfig::validated);
    let field = |set: fn(&mut PlannerConfig)| {
        let mut config = PlannerConfig::default();
        set(&mut config);
        config.validated().unwrap_err().field
    };
    assert_eq!(field(|c| c.room.margin = -1.0), "room.margin");
    assert_eq!(field(|c| c.potential.reach = 0.0), "potential.reach");
    assert_eq!(field(|c| c.curve.detour = 0.5), "curve.detour");
    assert_eq!(field(|c| c.timing.period = 0.0), "timing.period");
}

#[test]
fn every_number_of_the_potential_is_checked() {
    let text = |set: fn(&mut PotentialConfig)| {
        let mut config = PotentialConfig::default();
        set(&mut config);
        config.validated().unwrap_err().to_string()
    };
    let above = "expected a finite number above 0";
    assert_eq!(text(|c| c.attraction = 0.0), format!("potential.attraction is 0, {above}"));
    assert_eq!(text(|c| c.repulsion = -1.0), format!("potential.repulsion is -1, {above}"));
    assert_eq!(text(|c| c.reach = f64::NAN), "potential.reach is NaN m, expected 0.001 to 100");
    assert_eq!(text(|c| c.patience = 0), "potential.patience is 0 steps, expected 1 to 100000");
}

#[test]
fn masks_graphs_and_moving_obstacles_are_refused_with_what_is_wrong() {
    let text = |error: Invalid| error.to_string();
    let geometry = GridGeometry::new(0.5, Vector2::zeros(), 2, 2).unwrap();
    let few = CostMask::new(geometry, vec![0; 3]).unwrap_err();
    assert_eq!(text(few), "number of values of the mask is 3, expected 4");
    assert_eq!(
        text(CostMask::new(geometry, vec![0, 101, 0, 0]).unwrap_err()),
        "value of the mask is 101, expected 0 to 100"
    );
    assert_eq!(
        text(SpeedMask::new(geometry, vec![1.0; 5]).unwrap_err()),
        "cells of the speed mask is 5, expected 4"
    );
    let slow = SpeedMask::new(geometry, vec![1.0, 1.0, -0.1, 1.0]).unwrap_err();
    assert_eq!(text(slow), "limit of the speed mask is -0.1 m/s, expected more than 0");
    let lane = WaypointGraph::new(vec![Vector2::zeros()], vec![(0, 0), (0, 1)]).unwrap_err();
    assert_eq!(text(lane), "lane 1 of the waypoint graph is (0, 1), expected numbers of nodes");
    let wide = MovingObstacle::new(Vector2::zeros(), Vector2::zeros(), -0.1).unwrap_err();
    assert_eq!(text(wide), "obstacle radius is -0.1 m, expected 0 to 100");
    assert!(MovingObstacle::new(Vector2::zeros(), Vector2::new(0.0, f64::NAN), 0.1).is_err());
    assert!(Footprint::disc(0.0).is_err());
}
