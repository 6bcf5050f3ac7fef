//! Home Assistant's discovery: one message with a description of the robot and its entities.
//!
//! Source: Home Assistant, "MQTT": discovery of a device; "MQTT vacuum", "MQTT sensor", "MQTT button", "MQTT image", "MQTT select".

use crate::{RobotFacts, RobotName};
use serde_json::{Map, Value, json};

/// First part of the topics of discovery.
const DISCOVERY_PREFIX: &str = "homeassistant";

/// The topics of a robot at home.
#[derive(Debug, Clone)]
pub struct DiscoveryTopics {
    /// Discovery, retained.
    pub discovery: String,
    /// State as JSON, retained.
    pub state: String,
    /// Picture of the map as PNG, retained.
    pub map: String,
    /// Commands to the robot.
    pub command: String,
    /// Whether the last command was accepted, and why not.
    pub reply: String,
    /// Whether the robot is connected, as VDA 5050 has it.
    connection: String,
}

impl DiscoveryTopics {
    /// The topics of a robot.
    pub fn of(name: &RobotName, connection: String) -> Self {
        let of = |last: &str| format!("{}/{}/{last}", name.manufacturer, name.serial_number);
        Self {
            discovery: format!("{DISCOVERY_PREFIX}/device/{}/config", object_id(name)),
            state: of("state"),
            map: of("map"),
            command: of("command"),
            reply: of("reply"),
            connection,
        }
    }
}

/// Name of the robot in Home Assistant.
fn object_id(name: &RobotName) -> String {
    format!("{}_{}", name.manufacturer, name.serial_number)
}

/// The discovery of a robot with the named places `places`.
pub fn discovery(name: &RobotName, facts: &RobotFacts, topics: &DiscoveryTopics, places: &[String]) -> Value {
    let id = object_id(name);
    json!({
        "device": {
            "identifiers": [id], "name": name.serial_number, "manufacturer": name.manufacturer,
            "model": facts.title, "serial_number": name.serial_number, "sw_version": env!("CARGO_PKG_VERSION"),
        },
        "origin": {
            "name": "trundle", "sw_version": env!("CARGO_PKG_VERSION"), "support_url": env!("CARGO_PKG_REPOSITORY"),
        },
        "availability": [{
            "topic": topics.connection,
            "value_template": "{{ 'online' if value_json.connectionState == 'ONLINE' else 'offline' }}",
        }],
        "components": components(&id, topics, places),
    })
}

fn components(id: &str, topics: &DiscoveryTopics, places: &[String]) -> Map<String, Value> {
    let mut all = Map::new();
    let mut add = |key: &str, mut component: Value| {
        component["unique_id"] = json!(format!("{id}_{key}"));
        all.insert(key.to_owned(), component);
    };
    add("vacuum", vacuum(topics));
    add(
        "map",
        json!({ "platform": "image", "name": "Map", "image_topic": topics.map, "content_type": "image/png" }),
    );
    for (key, sensor) in sensors(topics) {
        add(key, sensor);
    }
    for (key, title) in
        [("explore", "Explore"), ("return", "Return"), ("dock", "Dock"), ("continue", "Continue")]
    {
        add(
            key,
            json!({ "platform": "button", "name": title, "command_topic": topics.command, "payload_press": key }),
        );
    }
    // A component with only its platform removes an earlier one.
    let place = if places.is_empty() { json!({ "platform": "select" }) } else { select(topics, places) };
    if places.is_empty() {
        all.insert("place".to_owned(), place);
    } else {
        add("place", place);
    }
    all
}

fn vacuum(topics: &DiscoveryTopics) -> Value {
    json!({
        "platform": "vacuum", "name": Value::Null,
        "state_topic": topics.state, "command_topic": topics.command, "send_command_topic": topics.command,
        "json_attributes_topic": topics.state,
        "supported_features": ["start", "pause", "stop", "return_home", "send_command"],
        "payload_start": "start", "payload_pause": "pause", "payload_stop": "stop",
        "payload_return_to_base": "return_to_base",
    })
}

fn sensors(topics: &DiscoveryTopics) -> Vec<(&'static str, Value)> {
    let sensor = |title: &str, field: &str, unit: Value, class: Value| {
        let mut sensor = json!({
            "platform": "sensor", "name": title, "state_topic": topics.state,
            "value_template": format!("{{{{ value_json.{field} }}}}"),
        });
        if !unit.is_null() {
            sensor["unit_of_measurement"] = unit;
            sensor["state_class"] = json!("measurement");
        }
        if !class.is_null() {
            sensor["device_class"] = class;
        }
        sensor
    };
    let reply = json!({
        "platform": "sensor", "name": "Reply", "state_topic": topics.reply,
        "value_template": "{{ value_json.text[:255] }}", "entity_category": "diagnostic",
    });
    vec![
        ("battery", sensor("Battery", "battery", json!("%"), json!("battery"))),
        ("x", sensor("X", "x", json!("m"), Value::Null)),
        ("y", sensor("Y", "y", json!("m"), Value::Null)),
        ("heading", sensor("Heading", "heading_deg", json!("°"), Value::Null)),
        ("doing", sensor("Doing", "doing", Value::Null, Value::Null)),
        ("reply", reply),
    ]
}

fn select(topics: &DiscoveryTopics, places: &[String]) -> Value {
    json!({
        "platform": "select", "name": "Go to", "command_topic": topics.command, "options": places,
        "command_template": "{{ {'command': 'go', 'place': value} | tojson }}",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DriveLimits, Footprint};

    fn of(places: &[&str]) -> Value {
        let name: RobotName = "acme/r1".parse().unwrap();
        let facts = RobotFacts {
            title: "demo: house".to_owned(),
            footprint: Footprint::KOBUKI,
            limits: DriveLimits::KOBUKI,
            height_m: 1.0,
        };
        let places: Vec<String> = places.iter().map(ToString::to_string).collect();
        discovery(
            &name,
            &facts,
            &DiscoveryTopics::of(&name, "uagv/v2/acme/r1/connection".to_owned()),
            &places,
        )
    }

    #[test]
    fn each_component_has_a_platform_and_a_name_of_its_own() {
        let found = of(&["kitchen"]);
        let components = found["components"].as_object().unwrap();
        let ids: std::collections::BTreeSet<_> =
            components.values().map(|c| c["unique_id"].as_str().unwrap()).collect();
        assert_eq!(ids.len(), components.len());
        assert!(components.values().all(|c| c["platform"].is_string()));
        assert_eq!(components["place"]["options"], json!(["kitchen"]));
        assert_eq!(components["vacuum"]["command_topic"], "acme/r1/command");
    }

    #[test]
    fn without_places_there_is_no_choice_of_them() {
        assert_eq!(of(&[])["components"]["place"], json!({ "platform": "select" }));
    }
}
