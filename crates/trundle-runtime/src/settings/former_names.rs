//! Former names of settings, for old robot files and recordings.

use serde_json::Value;

/// Prefixes of former names and of the present ones; longer prefixes come first.
const FORMER_NAMES: [(&str, &str); 9] = [
    ("supervisor", "mission_executor"),
    ("wheel_way_noise", "wheel_distance_noise"),
    ("way_noise", "distance_noise"),
    ("least_way", "min_distance"),
    ("least_room", "min_clearance"),
    ("most_ahead", "max_lead"),
    ("surprise", "max_correction"),
    ("least_", "min_"),
    ("most_", "max_"),
];

/// The present name of a table or of a setting without its table; `None` without a former name.
fn present_name(name: &str) -> Option<String> {
    FORMER_NAMES.iter().find_map(|(former, present)| Some(format!("{present}{}", name.strip_prefix(former)?)))
}

/// The present form of a dotted key; `None` if it has no former name.
pub(super) fn present_key(key: &str) -> Option<String> {
    let present = |name: &str| present_name(name).unwrap_or_else(|| name.to_owned());
    let whole = key.split('.').map(present).collect::<Vec<_>>().join(".");
    (whole != key).then_some(whole)
}

/// The settings of a recording with the present names of all fields.
#[must_use]
pub fn with_present_names(settings: Value) -> Value {
    match settings {
        Value::Object(fields) => {
            let renamed = fields
                .into_iter()
                .map(|(name, value)| (present_name(&name).unwrap_or(name), with_present_names(value)));
            Value::Object(renamed.collect())
        }
        Value::Array(items) => Value::Array(items.into_iter().map(with_present_names).collect()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn former_keys_have_present_ones() {
        let present = |key: &str| present_key(key);
        assert_eq!(present("movers.least_way_m").as_deref(), Some("movers.min_distance_m"));
        assert_eq!(present("docking.most_work").as_deref(), Some("docking.max_work"));
        assert_eq!(present("least_hits").as_deref(), Some("min_hits"));
        assert_eq!(present("supervisor.patience_s").as_deref(), Some("mission_executor.patience_s"));
        assert_eq!(
            present("supervisor.explore.least_gain").as_deref(),
            Some("mission_executor.explore.min_gain")
        );
        assert_eq!(
            present("odometry.way_noise_m_per_sqrt_m").as_deref(),
            Some("odometry.distance_noise_m_per_sqrt_m")
        );
        assert_eq!(present("docking.max_work"), None);
        assert_eq!(present("mostly.speed"), None);
    }

    #[test]
    fn former_names_in_a_recording_are_replaced_at_any_depth() {
        let former = json!({ "a": { "least_speed": 1, "b": [{ "most_work": 2 }] }, "width": 3 });
        let present = json!({ "a": { "min_speed": 1, "b": [{ "max_work": 2 }] }, "width": 3 });
        assert_eq!(with_present_names(former), present);
    }
}
