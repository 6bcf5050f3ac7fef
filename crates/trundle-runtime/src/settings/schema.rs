//! The JSON schema of the robot file, for editors.

use super::reference::{Setting, reference};
use crate::RobotConfig;
use serde_json::{Map, Value, json};

/// JSON schema (draft 2020-12) of `robot.toml`, with the defaults.
pub fn json_schema() -> Value {
    let defaults =
        serde_json::to_value(RobotConfig::default()).expect("invariant: the configuration is plain data");
    let mut root = table();
    for setting in reference() {
        insert(&mut root, setting.key, property(setting, &defaults));
    }
    root["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    root["title"] = json!("trundle robot file");
    root
}

fn table() -> Value {
    json!({ "type": "object", "additionalProperties": false, "properties": {} })
}

fn insert(at: &mut Value, key: &str, property: Value) {
    let properties = at["properties"].as_object_mut().expect("invariant: a table has properties");
    match key.split_once('.') {
        None => {
            properties.insert(key.to_owned(), property);
        }
        Some((head, rest)) => insert(properties.entry(head).or_insert_with(table), rest, property),
    }
}

fn property(setting: &Setting, defaults: &Value) -> Value {
    let mut property = Map::new();
    property.insert("description".into(), json!(setting.doc));
    let kind = match setting.kind {
        "number" => json!("number"),
        "integer" => json!("integer"),
        "flag" => json!("boolean"),
        "list" => json!("array"),
        choices => {
            property.insert("enum".into(), choices.split('|').collect());
            json!("string")
        }
    };
    property.insert("type".into(), kind);
    let pointer = format!("/{}", setting.path.replace('.', "/"));
    if let Some(value) = defaults.pointer(&pointer).filter(|value| !value.is_null()) {
        property.insert("default".into(), value.clone());
    }
    Value::Object(property)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_has_every_key_with_its_default() {
        let schema = json_schema();
        let radius = &schema["properties"]["drive"]["properties"]["wheel_radius_m"];
        assert_eq!(radius["type"], "number");
        assert_eq!(radius["default"], 0.035);
        assert_eq!(schema["properties"]["sight"]["enum"], json!(["depth_camera", "laser"]));
        for setting in reference() {
            let pointer = format!("/properties/{}", setting.key.replace('.', "/properties/"));
            assert!(schema.pointer(&pointer).is_some(), "{}", setting.key);
        }
    }
}
