//! The option --mqtt: a robot at home and in a fleet.

use clap::Args;
use std::path::PathBuf;
use trundle::app::operator::OperatorLink;
use trundle::app::{AppError, RunSetup};
use trundle::fleet::{BrokerAddress, FleetLink, RobotName};

/// Home and fleet.
#[derive(Debug, Args)]
pub struct MqttArgs {
    /// Join a home (Home Assistant) or a fleet (VDA 5050) through this broker: mqtt://USER@HOST:PORT; the run continues after its mission
    #[arg(long, value_name = "URL")]
    pub mqtt: Option<BrokerAddress>,
    /// File with the broker's password [default: the variable TRUNDLE_MQTT_PASSWORD]
    #[arg(long, value_name = "FILE", requires = "mqtt", hide_short_help = true)]
    pub mqtt_password_file: Option<PathBuf>,
    /// Name of the robot: SERIAL or MANUFACTURER/SERIAL [default: trundle and the name of this machine]
    #[arg(long, value_name = "NAME", requires = "mqtt", hide_short_help = true)]
    pub mqtt_name: Option<RobotName>,
    /// Name of the map in orders and states.
    #[arg(long, value_name = "MAP", requires = "mqtt", default_value = "map", hide_short_help = true)]
    pub mqtt_map: String,
}

impl MqttArgs {
    /// Joins the broker, if one is given.
    pub fn join(
        &self,
        setup: &RunSetup,
        link: &OperatorLink,
        is_steered: bool,
    ) -> Result<Option<FleetLink>, AppError> {
        let Some(broker) = self.mqtt.clone() else { return Ok(None) };
        let (file, name) = (self.mqtt_password_file.as_deref(), self.mqtt_name.as_ref());
        let fleet = FleetLink::for_run(setup, link, is_steered, broker, file, name, &self.mqtt_map)?;
        crate::console::print(&fleet.announcement());
        Ok(Some(fleet))
    }
}
