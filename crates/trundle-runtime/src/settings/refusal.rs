//! Refusals of values of a robot file: the key in its table, and the unit that was probably meant.

use super::overrides::set;
use super::plausibility::require_plausible;
use super::reference::{Setting, reference};
use super::settings_error::SettingsError;
use crate::RobotConfig;
use serde::Deserialize;
use trundle_core::Invalid;

/// Refuses a configuration with a value that is outside its range or implausible.
///
/// # Errors
/// Names the first such value by its key in the file.
pub(super) fn require_valid(config: &RobotConfig) -> Result<(), SettingsError> {
    first_refusal(config).map_or(Ok(()), |error| {
        let Some(setting) = setting_at(&error.field) else {
            return Err(SettingsError::new(None, error.to_string()));
        };
        let unit = meant_unit(config, setting, &error);
        let expected = match unit {
            Some(unit) if !error.expected.ends_with('?') => format!("{}; is it in {unit}?", error.expected),
            _ => error.expected,
        };
        let named = Invalid { field: setting.key.to_owned(), expected, ..error };
        Err(SettingsError::new(None, named.to_string()))
    })
}

/// The first refused value, with its path in [`RobotConfig`] where one is known.
fn first_refusal(config: &RobotConfig) -> Option<Invalid> {
    let whole = || config.clone().validated().map(drop);
    require_plausible(config).and_then(|()| require_valid_parts(config)).and_then(|()| whole()).err()
}

/// Checks each table by itself. Building the robot replaces some values, and errors of its parts lack the name of the table.
fn require_valid_parts(config: &RobotConfig) -> Result<(), Invalid> {
    let at =
        |table: &'static str| move |error: Invalid| Invalid { field: path_in(table, &error.field), ..error };
    config.odometry.clone().validated().map_err(at("odometry"))?;
    config.slam.clone().validated().map_err(at("slam"))?;
    config.scan.clone().validated().map_err(at("scan"))?;
    config.scan_match.clone().validated().map_err(at("scan_match"))?;
    config.localization.clone().validated().map_err(at("localization"))?;
    config.mapping.clone().validated().map_err(at("mapping"))?;
    config.movers.validated().map_err(at("movers"))?;
    config.planning.validated().map_err(at("planning"))?;
    config.control.clone().validated().map_err(at("control"))?;
    config.docking.planner.clone().validated().map_err(at("docking.planner"))?;
    config.docking.positioner.validated().map_err(at("docking.positioner"))?;
    config.safety.clone().validated().map_err(at("safety"))?;
    config.mission_executor.validated().map_err(at("mission_executor"))?;
    config.station.validated().map(drop).map_err(at("station"))
}

/// The path of a part's field in [`RobotConfig`]. A part names the field alone, or behind a name of its own.
fn path_in(table: &str, field: &str) -> String {
    let inner = field.split_once('.').map(|(_, inner)| format!("{table}.{inner}"));
    let paths = [Some(format!("{table}.{field}")), inner].into_iter().flatten();
    paths.into_iter().find(|path| setting_at(path).is_some()).unwrap_or_else(|| field.to_owned())
}

/// The setting with this path or key.
fn setting_at(name: &str) -> Option<&'static Setting> {
    reference().iter().find(|setting| setting.path == name || setting.key == name)
}

/// The unit in which a refused value would be accepted.
fn meant_unit(config: &RobotConfig, setting: &Setting, error: &Invalid) -> Option<&'static str> {
    let (scale, unit) = likely_unit(setting.unit)?;
    let value: f64 = error.value.parse().ok()?;
    let mut table = toml::Table::try_from(config).ok()?;
    set(&mut table, setting.path, toml::Value::Float(value * scale));
    let scaled = RobotConfig::deserialize(toml::Value::Table(table)).ok()?;
    let is_refused = first_refusal(&scaled).is_some_and(|scaled| scaled.field == error.field);
    (!is_refused).then_some(unit)
}

/// Factor to the SI unit, and name, of the unit that is often written in place of an SI unit.
fn likely_unit(unit: &str) -> Option<(f64, &'static str)> {
    const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;
    match unit {
        "m" => Some((1e-3, "millimetres")),
        "m/s" => Some((1e-3, "mm/s")),
        "m/s^2" => Some((1e-3, "mm/s^2")),
        "rad" => Some((DEGREE_RAD, "degrees")),
        "rad/s" => Some((DEGREE_RAD, "degrees per second")),
        "rad/s^2" => Some((DEGREE_RAD, "degrees per second squared")),
        "s" => Some((1e-3, "milliseconds")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::RobotFile;

    fn refused(pair: &str) -> String {
        RobotFile::parse("", &[pair.to_owned()]).unwrap_err().to_string()
    }

    #[test]
    fn a_refusal_names_the_table_the_range_and_the_likely_unit() {
        let sentence = "mapping.resolution_m is 50 m, expected 0.005 to 1; is it in millimetres?";
        assert_eq!(refused("mapping.resolution_m=50"), sentence);
        let sentence = "slam.depth.farthest_m is 8000 m, expected 0.3 to 100; is it in millimetres?";
        assert_eq!(refused("slam.depth.farthest_m=8000"), sentence);
        assert!(refused("planning.curve.turn_first_rad=60").ends_with("is it in degrees?"));
        assert!(refused("safety.latency_s=200").ends_with("is it in milliseconds?"));
        assert!(refused("docking.planner.limits.turn_rate_rad_s=70").ends_with("degrees per second?"));
        assert_eq!(refused("mapping.hit=-1"), "mapping.hit is -1, expected 0.01 to 10");
        assert!(!refused("mapping.resolution_m=-50").contains('?'), "no unit makes it positive");
    }

    #[test]
    fn values_that_the_robot_replaces_are_checked_too() {
        assert!(refused("mapping.blind_range_m=650").ends_with("is it in millimetres?"));
        assert!(refused("docking.planner.overlap_m=10").starts_with("docking.planner.overlap_m is 10 m"));
    }

    /// Every length, speed, angle and time that a person may write in another unit is refused by its own key.
    #[test]
    fn no_length_in_kilometres_and_no_angle_of_many_turns_is_accepted() {
        let is_bounded = |setting: &&Setting| likely_unit(setting.unit).is_some() && setting.kind == "number";
        for setting in reference().iter().filter(is_bounded) {
            let pair = format!("{}=1e7", setting.key);
            let error = refused(&pair);
            // The camera is checked while it is read, with the pair in front.
            let error = error.strip_prefix(&format!("--set {pair}: ")).unwrap_or(&error);
            assert!(error.starts_with(setting.key), "{}: {error}", setting.key);
        }
    }
}
