//! Settings given as `key=value`, which replace those of a robot file.

use super::settings_error::SettingsError;
use super::translation::{Found, find, unknown};
use super::value_kind::kind_problem;
use crate::RobotConfig;
use serde::Deserialize;
use trundle_core::toml_problem;

/// The same robot with the values of `key=value` pairs.
pub(super) fn overridden(
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

/// Converts a whole number to a number with a point.
fn as_kind(value: toml::Value, kind: &str) -> toml::Value {
    match value {
        toml::Value::Integer(i) if kind == "number" => toml::Value::Float(i as f64),
        other => other,
    }
}

/// Sets the value at a dotted path.
pub(super) fn set(table: &mut toml::Table, path: &str, value: toml::Value) {
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
