//! `/telemetry`: numbers for plots.

use foxglove::bytes::BufMut;
use foxglove::{Encode, Schema};
use serde::Serialize;
use serde_json::json;
use trundle_app::operator::RunView;
use trundle_core::Stamp;

/// Numbers for plots, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Telemetry {
    /// Time of the robot \[s\].
    time: f64,
    /// Measured speed \[m/s\].
    speed: f64,
    /// Measured turn rate \[rad/s\].
    turn_rate: f64,
    /// Commanded speed \[m/s\].
    commanded_speed: f64,
    /// Commanded turn rate \[rad/s\].
    commanded_turn_rate: f64,
    /// Standard deviation of the position along its most uncertain axis \[m\].
    position_sigma: f64,
    /// Standard deviation of the heading \[rad\].
    heading_sigma: f64,
    /// Charge of the battery, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    battery_charge: Option<f64>,
    /// Voltage of the battery \[V\].
    #[serde(skip_serializing_if = "Option::is_none")]
    battery_voltage: Option<f64>,
}

/// The numbers of a view.
pub fn message(view: &RunView) -> Option<(Stamp, Telemetry)> {
    let estimate = &view.estimate;
    let message = Telemetry {
        time: view.stamp.as_secs(),
        speed: estimate.twist.v,
        turn_rate: estimate.twist.omega,
        commanded_speed: view.twist.v,
        commanded_turn_rate: view.twist.omega,
        position_sigma: estimate.position_sigma(),
        heading_sigma: estimate.heading_sigma(),
        battery_charge: view.battery.and_then(|battery| battery.charge),
        battery_voltage: view.battery.map(|battery| battery.voltage_v),
    };
    Some((view.stamp, message))
}

impl Encode for Telemetry {
    type Error = serde_json::Error;

    fn get_schema() -> Option<Schema> {
        let number = json!({"type": "number"});
        let properties: serde_json::Map<_, _> = [
            "time",
            "speed",
            "turn_rate",
            "commanded_speed",
            "commanded_turn_rate",
            "position_sigma",
            "heading_sigma",
            "battery_charge",
            "battery_voltage",
        ]
        .map(|name| (name.to_owned(), number.clone()))
        .into_iter()
        .collect();
        let schema = json!({"type": "object", "properties": properties}).to_string();
        Some(Schema::new("trundle.Telemetry", "jsonschema", schema.into_bytes()))
    }

    fn get_message_encoding() -> String {
        "json".to_owned()
    }

    fn encode(&self, bytes: &mut impl BufMut) -> Result<(), Self::Error> {
        serde_json::to_writer(bytes.writer(), self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use trundle_app::operator::Activity;
    use trundle_core::{Battery, Pose2, PowerSource, Twist2};

    #[test]
    fn the_schema_has_every_number_and_one_that_is_not_measured_is_left_out() {
        let activity = Activity { name: "tracking", reason: None };
        let stamp = Stamp::from_nanos(500_000_000);
        let mut view = RunView::of_activity(stamp, Pose2::IDENTITY, Twist2::new(0.2, 0.1), activity);
        let sent = |view: &RunView| serde_json::to_value(message(view).unwrap().1).unwrap();
        assert_eq!(sent(&view)["speed"], json!(0.2));
        assert!(sent(&view).get("battery_charge").is_none());
        view.battery = Some(Battery {
            voltage_v: 12.0,
            charge: Some(0.5),
            source: PowerSource::default(),
            is_charging: false,
        });
        let schema: Value = serde_json::from_slice(&Telemetry::get_schema().unwrap().data).unwrap();
        let names = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&sent(&view)), names(&schema["properties"]));
    }
}
