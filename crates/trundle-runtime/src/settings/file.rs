//! Reads a robot file: translates keys, reports unknown keys, applies overrides, and validates.

use super::missing_keys::missing_keys;
use super::overrides::overridden;
use super::refusal::require_valid;
use super::settings_error::SettingsError;
use super::translation::translate;
use crate::RobotConfig;
use serde::Deserialize;
use toml::Spanned;
use toml::de::DeTable;
use trundle_core::toml_problem;

/// A robot file that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotFile {
    /// The robot, gaps filled with the defaults.
    pub config: RobotConfig,
    /// One sentence for each deprecated key.
    pub warnings: Vec<String>,
}

impl RobotFile {
    /// Reads the text of a robot file, TOML, then applies `overrides`, each `key=value`.
    ///
    /// # Errors
    /// When the text is not TOML, a key is unknown or given twice, a value has the wrong kind, is outside its range or implausible.
    pub fn parse(text: &str, overrides: &[String]) -> Result<Self, SettingsError> {
        let mut warnings = Vec::new();
        let mut config = read(text, &mut warnings)?;
        if !overrides.is_empty() {
            config = overridden(&config, overrides, &mut warnings)?;
        }
        require_valid(&config)?;
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
            // Errors of this parse contain their line.
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

/// Replaces values of `table` by those of `given`. A value absent from an inner table keeps the robot's default, which may differ from the
/// default of that table's type.
fn overlay(table: &mut toml::Table, given: toml::Table) {
    for (key, value) in given {
        match (table.get_mut(&key), value) {
            (Some(toml::Value::Table(inner)), toml::Value::Table(given)) => overlay(inner, given),
            (_, value) => _ = table.insert(key, value),
        }
    }
}

#[cfg(test)]
mod tests;
