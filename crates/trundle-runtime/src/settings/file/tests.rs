//! Tests of robot files: keys, old keys, overrides, refusals.

use super::super::reference::{Setting, reference};
use super::*;

fn parse(text: &str) -> Result<RobotFile, SettingsError> {
    RobotFile::parse(text, &[])
}

#[test]
fn keys_with_units_and_old_keys_are_read() {
    let new =
        parse("[drive]\nwheel_radius_m = 0.036\nwheelbase_m = 0.24\nticks_per_turn = 2578.33\n").unwrap();
    let old = parse("[drive]\nwheel_radius = 0.036\nwheelbase = 0.24\nticks_per_turn = 2578.33\n").unwrap();
    assert_eq!(new.config, old.config);
    assert!(new.warnings.is_empty());
    assert_eq!(old.warnings[0], "drive.wheel_radius is deprecated: write drive.wheel_radius_m");
    assert_eq!(parse("").unwrap().config, RobotConfig::default());
}

#[test]
fn former_names_are_read_with_a_warning() {
    let old = parse("[movers]\nleast_way_m = 0.3\nleast_hits = 4\n").unwrap();
    assert_eq!(old.config, parse("[movers]\nmin_distance_m = 0.3\nmin_hits = 4\n").unwrap().config);
    assert_eq!(old.warnings[0], "movers.least_hits is deprecated: write movers.min_hits");
    let set = RobotFile::parse("", &["movers.least_way=0.3".to_owned()]).unwrap();
    assert_eq!(set.warnings, ["movers.least_way is deprecated: write movers.min_distance_m"]);
    assert!(parse("[movers]\nleast_foot_m = 0.3\n").unwrap_err().message.contains("least_foot_m"));
}

#[test]
fn unknown_and_doubled_keys_name_their_line() {
    let error = parse("[safety]\nlatency_s = 0.2\nlatency_ms = 200\n").unwrap_err();
    assert_eq!(error.line, Some(3));
    assert!(
        error.message.starts_with("unknown key safety.latency_ms; [safety] has deceleration_m_s2"),
        "{error}"
    );
    let error = parse("[safety]\nlatency_s = 0.2\nlatency = 0.2\n").unwrap_err();
    assert!(error.line.is_some() && error.message.contains("set twice"), "{error}");
    let error = parse("[safety]\nlatency_s = \"soon\"\n").unwrap_err();
    assert_eq!(error.line, Some(2), "{error}");
    assert_eq!(parse("x").unwrap_err().line, Some(1));
}

#[test]
fn overrides_come_last_and_fill_nothing_else() {
    let set = |pairs: &[&str]| {
        let pairs: Vec<String> = pairs.iter().map(|pair| (*pair).to_owned()).collect();
        RobotFile::parse("[control]\nlead_s = 0.05\n", &pairs)
    };
    let file = set(&["control.lead_s=0.04", "camera.fx_px=360", "sight=depth_camera"]).unwrap();
    assert_eq!(file.config.control.lead, 0.04);
    assert_eq!(file.config.camera.fx(), 360.0);
    assert!(set(&["control.lead_s"]).unwrap_err().message.contains("expected key=value"));
    assert!(set(&["control=1"]).unwrap_err().message.contains("is a table"));
    assert!(set(&["control.speed=1"]).unwrap_err().message.contains("unknown key control.speed"));
    assert!(set(&["control.lead_s=fast"]).unwrap_err().message.starts_with("--set control.lead_s=fast"));
}

#[test]
fn no_word_of_serde_is_in_a_message() {
    for (text, line, words) in [
        ("footprint_m = 0.15", 1, "footprint_m is 0.15, expected a list of corners [["),
        ("footprint_m = [[0, 1], [2, \"a\"]]", 1, "expected a list of corners [["),
        ("[drive]\nwheel_radius_m = \"big\"", 2, "drive.wheel_radius_m is \"big\", expected a number in m"),
        ("[slam]\nseed = -1", 2, "slam.seed is -1, expected a whole number, 0 or more"),
        ("[slam]\nseed = 99999999999999999999999", 2, "slam.seed is beyond what can be read"),
        ("drive = 3", 1, "drive is a table of settings, expected [drive]"),
        ("sight = 3", 1, "sight is 3, expected one of depth_camera, laser"),
        ("[camera]\nwidth_px = 640", 1, "[camera] lacks height_px (a whole number, 0 or more in px), fx_px"),
        ("[drive.wheel_radius_m]\nx = 1", 1, "drive.wheel_radius_m is a table, expected a number in m"),
        ("x", 1, "'x': there is no value, expected KEY = VALUE"),
    ] {
        let error = parse(text).unwrap_err();
        assert_eq!(error.line, Some(line), "{text}: {error}");
        assert!(error.message.contains(words), "{text}: {error}");
    }
    let set = |pair: &str| RobotFile::parse("", &[pair.to_owned()]).unwrap_err().message;
    let disc = set("footprint=0.15");
    assert!(
        disc.starts_with("--set footprint=0.15: footprint_m is 0.15, expected a list of corners"),
        "{disc}"
    );
    let inside = set("footprint.radius_m=0.15");
    assert!(inside.contains("footprint_m is itself a value, expected a list of corners"), "{inside}");
    let nowhere = set("foo.bar=1");
    assert!(nowhere.contains("the robot file has footprint_radius_m"), "{nowhere}");
    assert!(set("camera.width_px=2.5").contains("camera.width_px is 2.5, expected a whole number"));
}

#[test]
fn errors_of_range_name_the_key_of_the_file() {
    let error = parse("[odometry]\nmax_speed_m_s = 0.3\n").unwrap_err().to_string();
    assert!(error.contains("odometry.max_speed_m_s is 0.3 m/s"), "{error}");
}

/// The value of a setting in a configuration, as text for an override. `None` if it is not set.
fn value_of(config: &RobotConfig, setting: &Setting) -> Option<toml::Value> {
    let root = toml::Value::try_from(config).unwrap();
    setting.path.split('.').try_fold(root, |value, field| value.get(field).cloned())
}

/// Every setting that has a default, with that default.
fn defaults() -> impl Iterator<Item = (&'static Setting, toml::Value)> {
    reference().iter().filter_map(|s| Some((s, value_of(&RobotConfig::default(), s)?)))
}

#[test]
fn every_setting_put_to_its_default_by_its_key_changes_nothing() {
    let pairs: Vec<String> = defaults().map(|(s, value)| format!("{}={value}", s.key)).collect();
    let file = RobotFile::parse("", &pairs).unwrap();
    assert_eq!(file.config, RobotConfig::default());
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
}

#[test]
fn every_old_name_is_read_with_a_warning_that_gives_the_name_to_write() {
    let old: Vec<_> = defaults().filter(|(s, _)| s.path != s.key).collect();
    assert!(old.len() > 50, "most settings have a unit");
    let warning = |s: &Setting| format!("{} is deprecated: write {}", s.path, s.key);
    let expected: Vec<String> = old.iter().map(|(s, _)| warning(s)).collect();
    let pairs: Vec<String> = old.iter().map(|(s, value)| format!("{}={value}", s.path)).collect();
    let file = RobotFile::parse("", &pairs).unwrap();
    assert_eq!((&file.config, &file.warnings), (&RobotConfig::default(), &expected));
    let mut file = parse(&pairs.join("\n")).unwrap();
    file.warnings.sort_unstable();
    let mut sorted = expected;
    sorted.sort_unstable();
    assert_eq!((file.config, file.warnings), (RobotConfig::default(), sorted));
}

#[test]
fn a_key_beside_the_settings_of_any_table_is_refused_with_the_keys_of_that_table() {
    for setting in reference() {
        let table = setting.table();
        let key = if table.is_empty() { "speeed".to_owned() } else { format!("{table}.speeed") };
        let error = parse(&format!("\n{key} = 1\n")).unwrap_err();
        assert!(error.message.starts_with(&format!("unknown key {key}; ")), "{error}");
        let beside = setting.name().split('.').next().unwrap_or_default();
        assert!(error.message.contains(beside), "{error} does not name {beside}");
    }
}

#[test]
fn a_value_of_another_kind_is_refused_for_every_setting() {
    for setting in reference() {
        let error = RobotFile::parse("", &[format!("{}={{ a = 1 }}", setting.key)]).unwrap_err();
        assert!(error.message.starts_with(&format!("--set {}=", setting.key)), "{error}");
    }
}

#[test]
fn of_two_overrides_of_one_key_the_later_one_holds() {
    let pairs = ["limits.v_m_s=0.3", "limits.v_m_s = 0.4"].map(str::to_owned);
    assert_eq!(RobotFile::parse("[limits]\nv_m_s = 0.2\n", &pairs).unwrap().config.limits.v, 0.4);
    for pair in ["=1", "limits=0.3", "limits.=1", ".v=1"] {
        let error = RobotFile::parse("", &[pair.to_owned()]).unwrap_err();
        assert!(error.line.is_none() && error.message.starts_with(&format!("--set {pair}: ")), "{error}");
    }
}

#[test]
fn whole_numbers_are_numbers_and_points_are_not_counts() {
    assert_eq!(parse("[schedule]\nmap_hz = 4\n").unwrap().config.schedule.map_hz, 4.0);
    let file = RobotFile::parse("", &["schedule.map_hz=4".to_owned()]).unwrap();
    assert_eq!(file.config.schedule.map_hz, 4.0);
    let count = reference().iter().find(|setting| setting.kind == "integer").unwrap();
    assert!(RobotFile::parse("", &[format!("{}=2.5", count.key)]).is_err(), "{}", count.key);
}

#[test]
fn one_key_of_a_table_leaves_the_rest_of_the_robot_as_it_is() {
    let file = parse("[docking.planner]\nreach_m = 1.25\n").unwrap();
    let mut expected = RobotConfig::default();
    expected.docking.planner.reach = 1.25;
    assert_eq!(file.config, expected);
}
