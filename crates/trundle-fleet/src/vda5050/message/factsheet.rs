//! Abilities of the robot, for the master.

use super::header::MessageHeader;
use crate::robot_facts::RobotFacts;
use crate::vda5050::abilities::{ABILITIES, UNUSABLE_EDGE_FIELDS};
use crate::vda5050::limits::{
    MAX_ACTIONS_OF_NODE, MAX_ID_BYTES, MAX_MESSAGE_BYTES, MAX_NODES, MIN_STATE_PERIOD, STATE_PERIOD,
    VISUALIZATION_PERIOD,
};
use serde::Serialize;
use serde_json::{Value, json};

/// Abilities of the robot.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Factsheet {
    /// The header.
    #[serde(flatten)]
    header: MessageHeader,
    type_specification: Value,
    physical_parameters: Value,
    protocol_limits: Value,
    protocol_features: Value,
    agv_geometry: Value,
    load_specification: Value,
}

impl Factsheet {
    /// The factsheet of a robot.
    #[must_use]
    pub fn of(header: MessageHeader, facts: &RobotFacts) -> Self {
        Self {
            header,
            type_specification: json!({
                "seriesName": "trundle", "seriesDescription": "two wheels, one RGB-D camera",
                "agvKinematic": "DIFF", "agvClass": "CARRIER", "maxLoadMass": 0,
                "localizationTypes": ["NATURAL"], "navigationTypes": ["AUTONOMOUS"],
            }),
            physical_parameters: physical_parameters(facts),
            protocol_limits: protocol_limits(),
            protocol_features: json!({ "optionalParameters": optional_parameters(), "agvActions": actions() }),
            agv_geometry: json!({
                "envelopes2d": [{ "set": "body", "polygonPoints": outline(facts) }],
            }),
            load_specification: json!({ "loadPositions": [], "loadSets": [] }),
        }
    }
}

fn physical_parameters(facts: &RobotFacts) -> Value {
    let (length, width) = facts.size();
    let limits = &facts.limits;
    json!({
        "speedMin": 0.0, "speedMax": limits.v, "angularSpeedMin": 0.0, "angularSpeedMax": limits.omega,
        "accelerationMax": limits.acceleration, "decelerationMax": limits.acceleration,
        "heightMin": facts.height_m, "heightMax": facts.height_m, "width": width, "length": length,
    })
}

fn protocol_limits() -> Value {
    json!({
        "maxStringLens": { "msgLen": MAX_MESSAGE_BYTES, "idLen": MAX_ID_BYTES, "idNumericalOnly": false },
        "maxArrayLens": { "order.nodes": MAX_NODES, "order.edges": MAX_NODES - 1, "node.actions": MAX_ACTIONS_OF_NODE },
        "timing": {
            "minOrderInterval": MIN_STATE_PERIOD.as_secs_f64(), "minStateInterval": MIN_STATE_PERIOD.as_secs_f64(),
            "defaultStateInterval": STATE_PERIOD.as_secs_f64(),
            "visualizationInterval": VISUALIZATION_PERIOD.as_secs_f64(),
        },
    })
}

/// Optional fields of orders that the robot uses. An order with a field of [`UNUSABLE_EDGE_FIELDS`] is rejected.
fn optional_parameters() -> Vec<Value> {
    debug_assert!(!UNUSABLE_EDGE_FIELDS.contains(&"maxSpeed"));
    let used = [
        "order.nodes.nodePosition.theta",
        "order.nodes.nodePosition.allowedDeviationXY",
        "order.nodes.nodePosition.allowedDeviationTheta",
        "order.edges.maxSpeed",
        "order.edges.maxHeight",
    ];
    used.iter().map(|parameter| json!({ "parameter": parameter, "support": "SUPPORTED" })).collect()
}

fn actions() -> Vec<Value> {
    let action = |ability: &crate::vda5050::abilities::Ability| {
        let parameters = ability.parameters.iter().map(|(key, kind, is_optional)| {
            json!({ "key": key, "valueDataType": kind, "isOptional": is_optional })
        });
        // The optional field `blockingTypes` is left out: the schema of version 2.1 demands an array that is one of three texts.
        json!({
            "actionType": ability.action_type, "actionDescription": ability.description,
            "actionScopes": ability.scopes(), "actionParameters": parameters.collect::<Vec<_>>(),
        })
    };
    ABILITIES.iter().map(action).collect()
}

fn outline(facts: &RobotFacts) -> Vec<Value> {
    facts.outline().iter().map(|corner| json!({ "x": corner.x, "y": corner.y })).collect()
}
