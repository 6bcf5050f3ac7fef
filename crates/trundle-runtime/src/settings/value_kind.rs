//! Checks that a value has the kind of its setting.

use super::reference::Setting;
use toml::Value;

/// The problem of a value of the wrong kind: key, value and expected kind; `None` if the kind fits.
pub(super) fn kind_problem(setting: &Setting, value: &Value) -> Option<String> {
    (!is_of_kind(setting.kind, value)).then(|| {
        let (key, wanted) = (setting.key, wanted(setting));
        match value {
            Value::Table(_) => format!("{key} is a table, expected {wanted}"),
            value => format!("{key} is {value}, expected {wanted}"),
        }
    })
}

/// Accepted value of a setting, in words.
pub(super) fn wanted(setting: &Setting) -> String {
    let unit = if setting.unit.is_empty() { String::new() } else { format!(" in {}", setting.unit) };
    match setting.kind {
        "number" => format!("a number{unit}"),
        "integer" => format!("a whole number, 0 or more{unit}"),
        "flag" => "true or false".to_owned(),
        "list" => format!(
            "a list of corners [[X, Y], [X, Y], [X, Y], ...]{unit}; a disc is set by footprint_radius_m"
        ),
        words => format!("one of {}", words.replace('|', ", ")),
    }
}

fn is_of_kind(kind: &str, value: &Value) -> bool {
    match (kind, value) {
        ("number", Value::Float(_) | Value::Integer(_)) | ("flag", Value::Boolean(_)) => true,
        // The text form of corners is read later.
        ("list", Value::String(_)) => true,
        ("list", Value::Array(corners)) => corners.iter().all(is_corner),
        ("number" | "integer" | "flag" | "list", value) => {
            kind == "integer" && value.as_integer().is_some_and(|number| number >= 0)
        }
        (words, Value::String(word)) => words.split('|').any(|known| known == word),
        _ => false,
    }
}

fn is_corner(corner: &Value) -> bool {
    let is_number = |value: &Value| matches!(value, Value::Float(_) | Value::Integer(_));
    corner.as_array().is_some_and(|pair| pair.len() == 2 && pair.iter().all(is_number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::reference;

    fn problem(key: &str, value: impl Into<Value>) -> Option<String> {
        kind_problem(reference().iter().find(|setting| setting.key == key).unwrap(), &value.into())
    }

    #[test]
    fn values_of_another_kind_are_named_with_key_value_and_kind() {
        let radius = problem("drive.wheel_radius_m", "abc").unwrap();
        assert_eq!(radius, "drive.wheel_radius_m is \"abc\", expected a number in m");
        assert_eq!(problem("drive.wheel_radius_m", 1), None);
        let width = problem("camera.width_px", -1).unwrap();
        assert_eq!(width, "camera.width_px is -1, expected a whole number, 0 or more in px");
        let sight = problem("sight", "sonar").unwrap();
        assert_eq!(sight, "sight is \"sonar\", expected one of depth_camera, laser");
        let disc = problem("footprint_m", 0.15).unwrap();
        assert!(disc.starts_with("footprint_m is 0.15, expected a list of corners [[X, Y], "), "{disc}");
        assert!(problem("footprint_m", vec![Value::from(vec![1.0])]).is_some());
        assert_eq!(problem("footprint_m", vec![Value::from(vec![1.0, 2.0])]), None);
    }
}
