//! The file `summary.json`: the numbers of a run for scripts.

use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// The numbers of a run for scripts: `summary.json`. Names contain their unit (`goal_error_m`, `slam_p99_ms`). Values without a unit in
/// their name are SI. Keys are sorted, so equal numbers give equal bytes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    values: BTreeMap<String, Value>,
}

impl Summary {
    /// The summary of a run of `command`.
    pub fn new(command: &str) -> Self {
        let mut summary = Self::default();
        summary.set("command", command);
        summary
    }

    /// Sets a value: a number, text, truth value, list or struct. NaN and infinity become `null`, and so does what
    /// JSON cannot hold.
    pub fn set(&mut self, name: &str, value: impl Serialize) -> &mut Self {
        self.values.insert(name.to_owned(), serde_json::to_value(value).unwrap_or_default());
        self
    }

    /// Records that the user ended the work early; without effect for `false`.
    pub fn set_interrupted(&mut self, is_interrupted: bool) -> &mut Self {
        if is_interrupted { self.set("interrupted", true) } else { self }
    }

    /// A value set before.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.values.get(name)
    }

    /// The text of `summary.json`.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(&self.values).expect("invariant: JSON values are JSON");
        text.push('\n');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_sorted_and_numbers_exact() {
        let mut summary = Summary::new("demo");
        summary.set("goal_error_m", 0.1 + 0.2).set("contacts", 0).set("ate_m", f64::NAN);
        let text = summary.to_json();
        assert_eq!(
            text,
            "{\n  \"ate_m\": null,\n  \"command\": \"demo\",\n  \"contacts\": 0,\n  \
             \"goal_error_m\": 0.30000000000000004\n}\n"
        );
        let back: BTreeMap<String, Value> = serde_json::from_str(&text).unwrap();
        assert_eq!(back["goal_error_m"], 0.1 + 0.2);
        assert_eq!(summary.get("contacts"), Some(&Value::from(0)));
    }
}
