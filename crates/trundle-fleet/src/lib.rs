//! trundle by MQTT: a robot at home and in a fleet, by one connection to a broker.
//!
//! [`FleetLink::start`] joins a broker on a separate thread. It reads views of the run and sends commands by `trundle_app::operator`; the
//! robot never waits for it, and continues if the broker is lost.
//!
//! | part | purpose |
//! |---|---|
//! | `broker` | the connection: bounded queues, size limits, back-off |
//! | `home` | state, map picture, places and commands for a home; Home Assistant's discovery |
//! | [`vda5050`] | orders and states of VDA 5050 2.1 for a master control |
//! | `worker` | the thread that connects the parts |
//!
//! ```
//! use trundle_fleet::{HomeCommand, read_home_command};
//! assert_eq!(read_home_command(b"pause")?, HomeCommand::Pause);
//! assert!(read_home_command(b"fly").is_err());
//! # Ok::<(), String>(())
//! ```

mod address;
mod broker;
mod error;
mod fleet_link;
mod home;
mod master_link;
mod options;
mod places;
mod robot_commands;
mod robot_facts;
mod robot_status;
mod timestamp;
pub mod vda5050;
mod worker;

pub use address::BrokerAddress;
pub use error::FleetError;
pub use fleet_link::FleetLink;
pub use home::{HomeCommand, read_home_command};
pub use options::{FleetOptions, Password, RobotName};
pub use places::Places;
pub use robot_commands::RobotCommands;
pub use robot_facts::RobotFacts;
pub use robot_status::RobotStatus;
