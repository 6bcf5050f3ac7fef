//! Settings out of their range are refused with key, value, unit and range.

use crate::common::{at, robot};
use trundle_core::{Footprint, Pose2};
use trundle_docking::hong24::Hong24Config;
use trundle_docking::{
    DockingConfig, DockingPlanner, MotionLimits, Obstacle, ObstacleScene, Positioner, PositionerConfig,
    SearchLimit,
};

/// A setting: key, unit, lowest and highest value, and how it is set.
type Setting<C> = (&'static str, &'static str, f64, f64, fn(&mut C, f64));

/// Both ends of each range are accepted; values outside and not-a-number are refused by name.
fn refuses<C: Clone>(
    prefix: &str,
    good: &C,
    settings: &[Setting<C>],
    check: impl Fn(C) -> Result<(), String>,
) {
    for (key, unit, low, high, set) in settings {
        let with = |value: f64| {
            let mut config = good.clone();
            set(&mut config, value);
            check(config)
        };
        assert_eq!((with(*low), with(*high)), (Ok(()), Ok(())), "{key}");
        for bad in [low - 0.0005, high * 1.01, f64::NAN, f64::INFINITY] {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            let expected = format!("{prefix}{key} is {bad}{unit}, expected {low} to {high}");
            assert_eq!(with(bad), Err(expected), "{key}");
        }
    }
}

fn planner(config: DockingConfig) -> Result<(), String> {
    DockingPlanner::new(config).map(|_| ()).map_err(|error| error.to_string())
}

fn positioner(config: PositionerConfig) -> Result<(), String> {
    let made = Positioner::new(DockingConfig::default(), config, robot(), Pose2::IDENTITY);
    made.map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn every_number_of_the_planner_is_checked() {
    let settings: [Setting<DockingConfig>; 8] = [
        ("margin", "m", 0.0, 0.5, |c, x| c.margin = x),
        ("margin_saving", "", 0.0, 1.0, |c, x| c.margin_saving = x),
        ("overlap", "m", 0.0, 0.02, |c, x| c.overlap = x),
        ("reach", "m", 0.1, 10.0, |c, x| c.reach = x),
        ("max_distance", "m", 0.1, 20.0, |c, x| c.max_distance = x),
        ("position_tolerance", "m", 0.001, 0.1, |c, x| c.position_tolerance = x),
        ("heading_tolerance", "rad", 0.001, 0.2, |c, x| c.heading_tolerance = x),
        ("gap", "", 0.0, 1.0, |c, x| c.gap = x),
    ];
    refuses("docking.", &DockingConfig::default(), &settings, planner);
}

#[test]
fn every_count_of_the_planner_is_checked() {
    let refused = |set: fn(&mut DockingConfig)| {
        let mut config = DockingConfig::default();
        set(&mut config);
        planner(config).unwrap_err()
    };
    let nodes = refused(|c| c.search_nodes = 10_000_001);
    assert_eq!(nodes, "docking.search_nodes is 10000001, expected 0 to 10000000");
    let boxes = refused(|c| c.bound_boxes = 100_000_001);
    assert_eq!(boxes, "docking.bound_boxes is 100000001, expected 0 to 100000000");
    for (key, error) in [
        ("max_work", refused(|c| c.max_work = 0)),
        ("plan_work", refused(|c| c.plan_work = 0)),
        ("points_work", refused(|c| c.points_work = 0)),
    ] {
        assert_eq!(error, format!("docking.{key} is 0, expected 100000 to 100000000000"));
    }
    assert!(refused(|c| c.plan_work = u64::MAX).starts_with("docking.plan_work is 18446744073709552000"));
}

#[test]
fn every_speed_and_the_pause_are_checked() {
    let settings: [Setting<DockingConfig>; 5] = [
        ("speed", "m/s", 0.01, 2.0, |c, x| c.limits.speed = x),
        ("acceleration", "m/s^2", 0.01, 5.0, |c, x| c.limits.acceleration = x),
        ("turn_rate", "rad/s", 0.01, 10.0, |c, x| c.limits.turn_rate = x),
        ("angular_acceleration", "rad/s^2", 0.01, 50.0, |c, x| c.limits.angular_acceleration = x),
        ("switch_time", "s", 0.0, 10.0, |c, x| c.limits.switch_time = x),
    ];
    refuses("docking.limits.", &DockingConfig::default(), &settings, planner);
}

#[test]
fn every_number_of_hong24_is_checked() {
    let settings: [Setting<DockingConfig>; 9] = [
        ("time_weight", "1/s", 0.0, 1000.0, |c, x| c.paper.time_weight = x),
        ("lateral_weight", "1/m", 0.0, 1e6, |c, x| c.paper.lateral_weight = x),
        ("angle_step", "rad", 0.001, 0.5, |c, x| c.paper.angle_step = x),
        ("distance_step", "m", 0.001, 0.5, |c, x| c.paper.distance_step = x),
        ("reach", "m", 0.01, 10.0, |c, x| c.paper.reach = x),
        ("lateral_threshold", "m", 0.001, 0.1, |c, x| c.paper.lateral_threshold = x),
        ("longitudinal_threshold", "m", 0.001, 0.1, |c, x| c.paper.longitudinal_threshold = x),
        ("angle_threshold", "rad", 0.001, 0.2, |c, x| c.paper.angle_threshold = x),
        ("recovery", "m", 0.01, 1.0, |c, x| c.paper.recovery = x),
    ];
    refuses("docking.paper.", &DockingConfig::default(), &settings, planner);
    for (max_motions, good) in [(0, false), (1, true), (1000, true), (1001, false)] {
        let mut config = Hong24Config::default();
        config.max_motions = max_motions;
        assert_eq!(config.validated().is_ok(), good, "{max_motions}");
    }
}

#[test]
fn every_number_of_the_positioner_is_checked() {
    let settings: [Setting<PositionerConfig>; 12] = [
        ("measure_time", "s", 0.02, 10.0, |c, x| c.measure_time = x),
        ("aim", "", 0.05, 1.0, |c, x| c.aim = x),
        ("release", "", 1.0, 100.0, |c, x| c.release = x),
        ("creep_speed", "m/s", 0.001, 0.2, |c, x| c.creep_speed = x),
        ("creep_rate", "rad/s", 0.001, 1.0, |c, x| c.creep_rate = x),
        ("delay", "s", 0.0, 1.0, |c, x| c.delay = x),
        ("braking", "", 0.1, 1.0, |c, x| c.braking = x),
        ("heading_gain", "1/s", 0.0, 10.0, |c, x| c.heading_gain = x),
        ("overlap", "m", 0.0, 0.02, |c, x| c.overlap = x),
        ("sigmas", "", 0.0, 10.0, |c, x| c.sigmas = x),
        ("max_margin", "m", 0.0, 0.5, |c, x| c.max_margin = x),
        ("patience", "s", 0.1, 100.0, |c, x| c.patience = x),
    ];
    refuses("positioner.", &PositionerConfig::default(), &settings, positioner);
    let mut config = PositionerConfig::default();
    config.attempts = 101;
    let attempts = positioner(config);
    assert_eq!(attempts, Err("positioner.attempts is 101, expected 0 to 100".into()));
    let mut config = PositionerConfig::default();
    config.step_work = 9_999;
    let work = positioner(config);
    assert_eq!(work, Err("positioner.step_work is 9999, expected 10000 to 100000000000".into()));
}

#[test]
fn a_positioner_refuses_the_settings_of_its_planner_too() {
    let mut docking = DockingConfig::default();
    docking.reach = 0.0;
    let made = Positioner::new(docking, PositionerConfig::default(), Footprint::KOBUKI, Pose2::IDENTITY);
    assert_eq!(made.unwrap_err().to_string(), "docking.reach is 0 m, expected 0.1 to 10");
}

#[test]
fn every_search_limit_names_a_setting_that_the_configuration_has() {
    let written = serde_json::to_value(DockingConfig::default()).unwrap();
    let limits =
        [SearchLimit::SearchNodes, SearchLimit::MaxWork, SearchLimit::PlanWork, SearchLimit::PointsWork];
    for limit in limits {
        assert!(written.get(limit.setting()).is_some(), "{limit:?}");
    }
}

#[test]
fn missing_keys_take_their_default_and_unknown_keys_are_refused() {
    let read = |text: &str| serde_json::from_str::<DockingConfig>(text);
    let limits = MotionLimits { speed: 0.1, ..MotionLimits::default() };
    let mut expected = DockingConfig::default();
    expected.limits = limits;
    assert_eq!(read(r#"{"limits": {"speed": 0.1}}"#).unwrap(), expected);
    for text in [r#"{"margins": 0.1}"#, r#"{"limits": {"v": 0.1}}"#, r#"{"paper": {"w1": 1}}"#] {
        assert!(read(text).unwrap_err().to_string().contains("unknown field"), "{text}");
    }
    assert!(serde_json::from_str::<PositionerConfig>(r#"{"wait": 1}"#).is_err());
}

#[test]
fn the_method_of_hong24_has_two_names_in_files() {
    let read = |name: &str| serde_json::from_str::<DockingConfig>(&format!(r#"{{"method": "{name}"}}"#));
    assert_eq!(read("paper").unwrap(), read("hong24").unwrap());
    assert_ne!(read("paper").unwrap(), read("optimal").unwrap());
    assert!(read("fast").is_err());
}

#[test]
fn obstacles_that_are_not_valid_are_refused_with_their_number_and_value() {
    let good = Obstacle::Point(at(0.0, 0.0));
    let refused =
        |bad: Obstacle| ObstacleScene::new(&[good.clone(), good.clone(), bad]).unwrap_err().to_string();
    let point = refused(Obstacle::Point(at(1.0, f64::INFINITY)));
    assert_eq!(point, "obstacle 2 is (1, inf) m, expected finite coordinates");
    let segment = refused(Obstacle::Segment(at(0.0, 0.0), at(f64::NAN, 1.0)));
    assert_eq!(segment, "obstacle 2 is (NaN, 1) m, expected finite coordinates");
    let line = refused(Obstacle::Polygon(vec![at(0.0, 0.0), at(1.0, 0.0)]));
    assert_eq!(line, "obstacle 2: polygon corners is 2, expected 3 or more");
    let dent = refused(Obstacle::Polygon(vec![at(0.0, 0.0), at(2.0, 0.0), at(0.5, 0.5), at(0.0, 2.0)]));
    assert_eq!(dent, "obstacle 2: polygon is turned inward at corner 1, expected convex");
}
