//! Reads a robot file: translates keys, names unknown ones, applies overrides, and validates.

use super::former_names::present_key;
use super::plausibility::require_plausible;
use super::reference::{Setting, reference};
use super::value_kind::{kind_problem, wanted};
use crate::RobotConfig;
use serde::Deserialize;
use std::borrow::Cow;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};
use trundle_core::toml_problem;

/// A robot file that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotFile {
    /// The robot, gaps filled with the defaults.
    pub config: RobotConfig,
    /// One sentence for each key that is deprecated.
    pub warnings: Vec<String>,
}

/// Why a robot file cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}{message}", line.map_or(String::new(), |line| format!("line {line}: ")))]
pub struct SettingsError {
    /// The line in the file, from 1, where it is known.
    pub line: Option<usize>,
    /// The error, and the accepted values.
    pub message: String,
}

impl SettingsError {
    fn new(line: Option<usize>, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}

impl RobotFile {
    /// Reads the text of a robot file, TOML, then applies `overrides`, each `key=value`.
    ///
    /// # Errors
    /// When the text is no TOML, a key is unknown or stands twice, a value is of the wrong kind, outside its range or implausible.
    pub fn parse(text: &str, overrides: &[String]) -> Result<Self, SettingsError> {
        let mut warnings = Vec::new();
        let mut config = read(text, &mut warnings)?;
        if !overrides.is_empty() {
            config = overridden(&config, overrides, &mut warnings)?;
        }
        let config = require_plausible(&config).and_then(|()| config.validated()).map_err(|error| {
            let unit = error.unit;
            let key =
                reference().iter().find(|setting| setting.path == error.field).map(|setting| setting.key);
            let field = key.unwrap_or(&error.field).to_owned();
            SettingsError::new(None, trundle_core::Invalid { field, unit, ..error }.to_string())
        })?;
        Ok(Self { config, warnings })
    }
}

/// Reads without checking ranges.
fn read(text: &str, warnings: &mut Vec<String>) -> Result<RobotConfig, SettingsError> {
    let line = |at: usize| 1 + text[..at.min(text.len())].matches('\n').count();
    let failed = |error: toml::de::Error| {
        let at = error.span().map(|span| span.start);
        let problem = toml_problem(text, at, error.message());
        SettingsError::new(at.map(|_| problem.line), problem.message)
    };
    let table = DeTable::parse(text).map_err(failed)?;
    let span = table.span();
    let mut problem = None;
    let translated = translate(table.into_inner(), "", warnings, &mut |at, message| {
        problem.get_or_insert_with(|| SettingsError::new(Some(line(at)), message));
    });
    match problem {
        Some(problem) => Err(problem),
        None => {
            let given = || toml::Deserializer::from(Spanned::new(span.clone(), translated.clone()));
            // Errors of this one name their line.
            RobotConfig::deserialize(given()).map_err(|error| {
                missing_keys(&translated, &error).map_or_else(
                    || failed(error),
                    |(at, message)| SettingsError::new(Some(line(at)), message),
                )
            })?;
            let mut table = toml::Table::try_from(RobotConfig::default())
                .expect("invariant: the configuration is plain data");
            overlay(&mut table, toml::Table::deserialize(given()).map_err(failed)?);
            RobotConfig::deserialize(toml::Value::Table(table)).map_err(failed)
        }
    }
}

/// Where serde misses a field: the table's place in the text, and the keys that the table of the file lacks.
fn missing_keys(given: &DeTable<'_>, error: &toml::de::Error) -> Option<(usize, String)> {
    let field = error.message().strip_prefix("missing field `")?.strip_suffix('`')?;
    let lacks = |setting: &&Setting| setting.field() == field && table_of(given, setting.path).is_some();
    let first = reference().iter().find(lacks)?;
    let (at, table) = table_of(given, first.path)?;
    let siblings = reference().iter().filter(|setting| setting.table() == first.table());
    let is_missed = |setting: &&Setting| setting.field() == field || is_required(setting);
    let missing = siblings.filter(|setting| !table.contains_key(setting.field())).filter(is_missed);
    let missing: Vec<String> =
        missing.map(|setting| format!("{} ({})", setting.name(), wanted(setting))).collect();
    let table = first.table();
    Some((at, format!("[{table}] lacks {}; it goes whole or not at all", missing.join(", "))))
}

/// The table of the file that should hold the field at `path` and does not, with its place in the text.
fn table_of<'a, 'i>(given: &'a DeTable<'i>, path: &str) -> Option<(usize, &'a DeTable<'i>)> {
    let (head, rest) = path.split_once('.')?;
    let value = given.get(head)?;
    let DeValue::Table(table) = value.get_ref() else { return None };
    if rest.contains('.') {
        return table_of(table, rest);
    }
    (!table.contains_key(rest)).then(|| (value.span().start, table))
}

/// Whether a table without this setting cannot be read.
fn is_required(setting: &Setting) -> bool {
    !setting.doc.contains("Default")
}

/// Puts the values of `given` in place of those of `table`. What a table within does not give keeps the robot's default, which may
/// differ from the default of that table's type.
fn overlay(table: &mut toml::Table, given: toml::Table) {
    for (key, value) in given {
        match (table.get_mut(&key), value) {
            (Some(toml::Value::Table(inner)), toml::Value::Table(given)) => overlay(inner, given),
            (_, value) => _ = table.insert(key, value),
        }
    }
}

/// The table with the names of fields in place of keys; reports unknown keys, and keys that stand twice, to `refuse`.
fn translate<'i>(
    table: DeTable<'i>,
    prefix: &str,
    warnings: &mut Vec<String>,
    refuse: &mut impl FnMut(usize, String),
) -> DeTable<'i> {
    let mut translated = DeTable::new();
    for (key, value) in table {
        let full = if prefix.is_empty() { key.to_string() } else { format!("{prefix}.{}", key.get_ref()) };
        let (span, value_span) = (key.span(), value.span());
        let found = find(&full);
        if let Some(problem) = found.as_ref().and_then(|found| kind_problem_of(&full, found, &value)) {
            refuse(value_span.start, problem);
            continue;
        }
        let field: Cow<'i, str> = match found {
            Some(Found::Key(setting)) => setting.field().into(),
            Some(Found::OldKey(setting)) => {
                warnings.push(format!("{full} is deprecated: write {}", setting.key));
                setting.field().into()
            }
            Some(Found::Table) => key.into_inner(),
            None => {
                refuse(span.start, unknown(&full, prefix));
                continue;
            }
        };
        let value = match value.into_inner() {
            DeValue::Table(inner) => DeValue::Table(translate(inner, &full, warnings, refuse)),
            other => other,
        };
        if translated.insert(Spanned::new(span.clone(), field), Spanned::new(value_span, value)).is_some() {
            refuse(span.start, format!("{full} is set twice, once under its old name"));
        }
    }
    translated
}

/// What is wrong with the kind of a value in the file.
fn kind_problem_of(key: &str, found: &Found, value: &Spanned<DeValue<'_>>) -> Option<String> {
    match found {
        Found::Key(setting) | Found::OldKey(setting) => {
            let plain = toml::Value::deserialize(ValueDeserializer::from(value.clone()));
            plain.map_or_else(
                |_| Some(format!("{key} is beyond what can be read, expected {}", wanted(setting))),
                |value| kind_problem(setting, &value),
            )
        }
        Found::Table => (!matches!(value.get_ref(), DeValue::Table(_))).then(|| {
            format!(
                "{key} is a table of settings, expected [{key}] on a line of its own, or {key}.NAME = VALUE"
            )
        }),
    }
}

/// What a dotted key is.
enum Found {
    Key(&'static Setting),
    OldKey(&'static Setting),
    Table,
}

fn find(full: &str) -> Option<Found> {
    let inside = |setting: &Setting| setting.key.strip_prefix(full).is_some_and(|rest| rest.starts_with('.'));
    let settings = reference();
    let named = |key: &str| settings.iter().find(|setting| setting.key == key);
    let of_path = |path: &str| settings.iter().find(|setting| setting.path == path);
    let former = || present_key(full).and_then(|present| named(&present).or_else(|| of_path(&present)));
    let key = named(full).map(Found::Key);
    let old = || of_path(full).or_else(former).map(Found::OldKey);
    key.or_else(old).or_else(|| settings.iter().any(inside).then_some(Found::Table))
}

fn unknown(full: &str, prefix: &str) -> String {
    let mut names: Vec<&str> = reference()
        .iter()
        .filter_map(|setting| {
            let inner = if prefix.is_empty() {
                Some(setting.key)
            } else {
                setting.key.strip_prefix(prefix)?.strip_prefix('.')
            };
            inner.and_then(|inner| inner.split('.').next())
        })
        .collect();
    names.dedup();
    if names.is_empty() {
        return format!("unknown key {full}; {}", nearest(prefix));
    }
    let place = if prefix.is_empty() { "the robot file".to_owned() } else { format!("[{prefix}]") };
    format!("unknown key {full}; {place} has {}", names.join(", "))
}

/// What the name before the last point of an unknown key is, where it is no table.
fn nearest(prefix: &str) -> String {
    match find(prefix) {
        Some(Found::Key(setting) | Found::OldKey(setting)) => {
            format!("{} is itself a value, expected {}", setting.key, wanted(setting))
        }
        _ => unknown(prefix, prefix.rsplit_once('.').map_or("", |(table, _)| table)),
    }
}

/// The same robot with `key=value` pairs on top.
fn overridden(
    config: &RobotConfig,
    overrides: &[String],
    warnings: &mut Vec<String>,
) -> Result<RobotConfig, SettingsError> {
    let mut table = toml::Table::try_from(config).expect("invariant: the configuration is plain data");
    for pair in overrides {
        let refused = |message: String| SettingsError::new(None, format!("--set {pair}: {message}"));
        let (key, value) = pair.split_once('=').ok_or_else(|| refused("expected key=value".into()))?;
        let (key, value) = (key.trim(), value.trim());
        let setting = match find(key) {
            Some(Found::Key(setting)) => setting,
            Some(Found::OldKey(setting)) => {
                warnings.push(format!("{key} is deprecated: write {}", setting.key));
                setting
            }
            Some(Found::Table) => return Err(refused(format!("[{key}] is a table; set one of its keys"))),
            None => return Err(refused(unknown(key, key.rsplit_once('.').map_or("", |(table, _)| table)))),
        };
        let parsed =
            format!("value = {value}").parse::<toml::Table>().ok().and_then(|mut t| t.remove("value"));
        let parsed = parsed.unwrap_or_else(|| toml::Value::String(value.to_owned()));
        if let Some(problem) = kind_problem(setting, &parsed) {
            return Err(refused(problem));
        }
        set(&mut table, setting.path, as_kind(parsed, setting.kind));
        RobotConfig::deserialize(toml::Value::Table(table.clone())).map_err(|error| {
            refused(toml_problem(&format!("{} =", setting.key), Some(0), error.message()).message)
        })?;
    }
    Ok(RobotConfig::deserialize(toml::Value::Table(table)).expect("invariant: read after every override"))
}

/// A whole number for a number with a point.
fn as_kind(value: toml::Value, kind: &str) -> toml::Value {
    match value {
        toml::Value::Integer(i) if kind == "number" => toml::Value::Float(i as f64),
        other => other,
    }
}

fn set(table: &mut toml::Table, path: &str, value: toml::Value) {
    match path.split_once('.') {
        None => {
            table.insert(path.to_owned(), value);
        }
        Some((head, rest)) => {
            let inner =
                table.entry(head.to_owned()).or_insert_with(|| toml::Value::Table(toml::Table::new()));
            if let Some(inner) = inner.as_table_mut() {
                set(inner, rest, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<RobotFile, SettingsError> {
        RobotFile::parse(text, &[])
    }

    #[test]
    fn keys_with_units_and_old_keys_are_read() {
        let new =
            parse("[drive]\nwheel_radius_m = 0.036\nwheelbase_m = 0.24\nticks_per_turn = 2578.33\n").unwrap();
        let old =
            parse("[drive]\nwheel_radius = 0.036\nwheelbase = 0.24\nticks_per_turn = 2578.33\n").unwrap();
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
            (
                "[drive]\nwheel_radius_m = \"big\"",
                2,
                "drive.wheel_radius_m is \"big\", expected a number in m",
            ),
            ("[slam]\nseed = -1", 2, "slam.seed is -1, expected a whole number, 0 or more"),
            ("[slam]\nseed = 99999999999999999999999", 2, "slam.seed is beyond what can be read"),
            ("drive = 3", 1, "drive is a table of settings, expected [drive]"),
            ("sight = 3", 1, "sight is 3, expected one of depth_camera, laser"),
            (
                "[camera]\nwidth_px = 640",
                1,
                "[camera] lacks height_px (a whole number, 0 or more in px), fx_px",
            ),
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

    /// The value of a setting in a configuration, as text for an override; none where it is not set.
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
    fn whole_numbers_are_numbers_and_points_are_no_counts() {
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
}
