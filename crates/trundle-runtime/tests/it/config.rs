//! The robot file: defaults, wrong keys and values.

use trundle_runtime::RobotConfig;
use trundle_runtime::settings::{RobotFile, to_commented_toml};

fn read(text: &str) -> Result<RobotConfig, String> {
    RobotFile::parse(text, &[]).map(|file| file.config).map_err(|error| error.to_string())
}

#[test]
fn the_printed_file_reads_back_the_same() {
    let mut config = RobotConfig::default();
    config.footprint_radius = 0.2;
    config.schedule.map_hz = 3.0;
    assert_eq!(read(&to_commented_toml(&config)).unwrap(), config);
    assert_eq!(read("").unwrap(), RobotConfig::default());
}

#[test]
fn the_defaults_are_valid_and_wrong_keys_are_named() {
    RobotConfig::default().validated().unwrap();
    let error = read("[schedule]\nmap_rate = 5.0\n").unwrap_err();
    assert!(error.contains("map_rate") && error.contains("line 2"), "{error}");
}

#[test]
fn outlines_are_checked_and_a_base_is_not_faster_than_the_limit_of_its_odometry() {
    let field = |config: RobotConfig| config.validated().unwrap_err().field;
    let mut flat = RobotConfig::default();
    flat.footprint = Some(vec![[0.0, 0.0], [1.0, 0.0]]);
    assert_eq!(field(flat), "footprint corners");
    let mut fast = RobotConfig::default();
    fast.limits.wheel_speed = 2.4;
    assert_eq!(field(fast.clone()), "odometry.max_speed");
    fast.odometry.max_speed = 5.0;
    fast.footprint = Some(vec![[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2]]);
    let fast = fast.validated().unwrap();
    assert_eq!(read(&to_commented_toml(&fast)).unwrap(), fast);
}
