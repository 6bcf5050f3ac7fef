//! Messages of a broker: orders and instant actions of a master, commands of a home.

use std::time::Duration;
use trundle::core::{DriveLimits, Footprint, Pose2};
use trundle::fleet::vda5050::message::{HeaderCounter, Identity, Topic};
use trundle::fleet::vda5050::{Vehicle, vehicle_state};
use trundle::fleet::{RobotCommands, RobotFacts, RobotStatus, read_home_command};
use trundle::runtime::OperatorCommand;

/// A robot that accepts every command without effect.
#[derive(Default)]
struct AcceptingRobot(u64);

impl RobotCommands for AcceptingRobot {
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String> {
        command.validated().map_err(|error| error.to_string())?;
        self.0 += 1;
        Ok(self.0)
    }

    fn stop(&mut self) -> Result<(), String> {
        Ok(())
    }
}

/// A message as an order, then as instant actions; the state after each must be JSON.
pub fn vda5050(bytes: &[u8]) {
    let view = RobotStatus::at_rest(Pose2::new(0.0, 0.0, 0.0));
    let (mut vehicle, mut robot) = (Vehicle::new(facts(), "map"), AcceptingRobot::default());
    let identity = Identity { manufacturer: "trundle".to_owned(), serial_number: "r1".to_owned() };
    let mut headers = HeaderCounter::new(identity);
    for is_order in [true, false, true] {
        match is_order {
            true => vehicle.on_order(bytes, &view),
            false => vehicle.on_instant_actions(bytes, &view, &mut robot),
        }
        for _ in 0..3 {
            vehicle.step(Duration::from_secs(7), &view, &mut robot);
        }
        let state = serde_json::to_string(&vehicle_state(&vehicle, headers.header(Topic::State), &view));
        assert!(state.is_ok(), "{state:?}");
    }
}

/// A command of a home.
pub fn home_command(bytes: &[u8]) {
    let _ = read_home_command(bytes);
}

fn facts() -> RobotFacts {
    let (footprint, limits) = (Footprint::KOBUKI, DriveLimits::KOBUKI);
    RobotFacts { title: String::new(), footprint, limits, height_m: 0.5 }
}
