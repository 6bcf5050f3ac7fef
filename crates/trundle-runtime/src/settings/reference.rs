//! The reference of settings: each key with its unit, its kind and its meaning.

use std::sync::OnceLock;

/// One key of the robot file.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Dotted path of the fields of [`crate::RobotConfig`], as `drive.wheel_radius`.
    pub path: &'static str,
    /// Dotted key in the file, with its unit, as `drive.wheel_radius_m`.
    pub key: &'static str,
    /// Unit, as `m/s`; empty without a unit.
    pub unit: &'static str,
    /// `number`, `integer`, `flag`, `list`, or the words of a choice separated by `|`.
    pub kind: &'static str,
    /// Meaning, range, default and source of the default.
    pub doc: &'static str,
}

/// Generated from the doc comments of the configuration structs by `cargo xtask settings`.
const REFERENCE_TSV: &str = include_str!("reference.tsv");

/// All settings, in the order of the fields.
pub fn reference() -> &'static [Setting] {
    static SETTINGS: OnceLock<Vec<Setting>> = OnceLock::new();
    SETTINGS.get_or_init(|| REFERENCE_TSV.lines().filter_map(parse).collect())
}

fn parse(line: &'static str) -> Option<Setting> {
    let mut fields = line.split('\t');
    let mut next = || fields.next();
    Some(Setting { path: next()?, key: next()?, unit: next()?, kind: next()?, doc: next()? })
}

impl Setting {
    /// The table that holds the key: `drive` of `drive.wheel_radius_m`; empty at the top.
    pub fn table(&self) -> &'static str {
        self.key.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// The key within its table.
    pub fn name(&self) -> &'static str {
        self.key.rsplit_once('.').map_or(self.key, |(_, name)| name)
    }

    /// The field within its struct.
    pub fn field(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, field)| field)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_meaning_and_stands_once() {
        let mut keys: Vec<&str> = reference().iter().map(|setting| setting.key).collect();
        assert_eq!(keys.len(), REFERENCE_TSV.lines().count());
        assert!(reference().iter().all(|setting| !setting.doc.is_empty()));
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), reference().len());
    }
}
