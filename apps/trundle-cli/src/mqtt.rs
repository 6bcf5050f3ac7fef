//! The option --mqtt: a robot at home and in a fleet.

use crate::console;
use clap::Args;
use std::path::PathBuf;
use trundle::app::operator::OperatorLink;
use trundle::app::{AppError, RunSetup};
use trundle::fleet::{BrokerAddress, FleetLink, FleetOptions, NoPlaces, Password, RobotFacts, RobotName};

/// Home and fleet.
#[derive(Debug, Args)]
pub struct MqttArgs {
    /// Join a home (Home Assistant) or a fleet (VDA 5050) by this broker: mqtt://USER@HOST:PORT; the run goes on after its mission
    #[arg(long, value_name = "URL")]
    pub mqtt: Option<BrokerAddress>,
    /// The broker's password stands in FILE [default: the variable TRUNDLE_MQTT_PASSWORD]
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
    /// Joins the broker, where one is given.
    pub fn join(
        &self,
        setup: &RunSetup,
        link: &OperatorLink,
        is_steered: bool,
    ) -> Result<Option<FleetLink>, AppError> {
        let Some(broker) = &self.mqtt else { return Ok(None) };
        if !is_steered {
            return Err(AppError::input("--mqtt: a replay takes no commands; use it with demo, run or ros2"));
        }
        let options = FleetOptions {
            broker: broker.clone(),
            password: Password::read(self.mqtt_password_file.as_deref())?,
            name: self.mqtt_name.clone().unwrap_or_default(),
            map_id: self.mqtt_map.clone(),
        };
        let fleet = FleetLink::start(options, link.operator(), RobotFacts::of(setup)?, Box::new(NoPlaces))?;
        console::print(&fleet.announcement());
        Ok(Some(fleet))
    }
}
