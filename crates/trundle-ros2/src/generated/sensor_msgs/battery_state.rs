//! `sensor_msgs/msg/BatteryState`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `sensor_msgs`: `BatteryState`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BatteryState {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `float32`.
    pub voltage: f32,
    /// `float32`.
    pub temperature: f32,
    /// `float32`.
    pub current: f32,
    /// `float32`.
    pub charge: f32,
    /// `float32`.
    pub capacity: f32,
    /// `float32`.
    pub design_capacity: f32,
    /// `float32`.
    pub percentage: f32,
    /// `uint8`.
    pub power_supply_status: u8,
    /// `uint8`.
    pub power_supply_health: u8,
    /// `uint8`.
    pub power_supply_technology: u8,
    /// `bool`.
    pub present: bool,
    /// `float32[]`.
    pub cell_voltage: Vec<f32>,
    /// `float32[]`.
    pub cell_temperature: Vec<f32>,
    /// `string`.
    pub location: std::string::String,
    /// `string`.
    pub serial_number: std::string::String,
}

impl ros2_client::Message for BatteryState {}

impl BatteryState {
    /// `uint8`.
    pub const POWER_SUPPLY_STATUS_UNKNOWN: u8 = 0;
    /// `uint8`.
    pub const POWER_SUPPLY_STATUS_CHARGING: u8 = 1;
    /// `uint8`.
    pub const POWER_SUPPLY_STATUS_DISCHARGING: u8 = 2;
    /// `uint8`.
    pub const POWER_SUPPLY_STATUS_NOT_CHARGING: u8 = 3;
    /// `uint8`.
    pub const POWER_SUPPLY_STATUS_FULL: u8 = 4;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_UNKNOWN: u8 = 0;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_GOOD: u8 = 1;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_OVERHEAT: u8 = 2;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_DEAD: u8 = 3;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_OVERVOLTAGE: u8 = 4;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: u8 = 5;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_COLD: u8 = 6;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: u8 = 7;
    /// `uint8`.
    pub const POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: u8 = 8;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_UNKNOWN: u8 = 0;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_NIMH: u8 = 1;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_LION: u8 = 2;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_LIPO: u8 = 3;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_LIFE: u8 = 4;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_NICD: u8 = 5;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_LIMN: u8 = 6;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_TERNARY: u8 = 7;
    /// `uint8`.
    pub const POWER_SUPPLY_TECHNOLOGY_VRLA: u8 = 8;
}

impl crate::interface::MessageType for BatteryState {
    const PACKAGE: &str = "sensor_msgs";
    const NAME: &str = "BatteryState";
}
