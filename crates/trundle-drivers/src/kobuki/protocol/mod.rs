//! The Kobuki's serial protocol in both directions, as pure functions.
//!
//! Line: 115200 baud, 8 data bits, no parity, 1 stop bit. A frame is `AA 55 | length | sub-payloads | checksum`. A sub-payload is
//! `id | length | data`. The checksum is the XOR of all bytes from the length on. Numbers are little-endian.
//!
//! | module | content |
//! |---|---|
//! | [`frame`] | frames, sub-payloads, checksum |
//! | [`base_control`] | twist to speed and radius, and back |
//! | [`command`] | commands to the base |
//! | [`feedback`] | a feedback packet with all its sub-payloads |
//! | [`core_sensors`] | stamp, bumper, wheels, charger |
//! | [`sensor_payloads`] | docking light, gyro, cliff, currents, inputs |
//! | [`device_info`] | versions, unique id, gains |
//!
//! Source: "Appendix: Protocol Specification" of the Kobuki's documentation, <https://yujinrobot.github.io/kobuki>.

pub mod base_control;
pub mod command;
pub mod core_sensors;
pub mod device_info;
pub mod feedback;
mod fields;
pub mod frame;
pub mod sensor_payloads;

pub use base_control::BaseControl;
pub use command::{KobukiCommand, Led, Outputs, SoundSequence};
pub use core_sensors::{Charger, CoreSensors, ThreeSides};
pub use device_info::{Gains, UniqueId, Version};
pub use feedback::Feedback;
pub use frame::PayloadError;
pub use sensor_payloads::{CliffSignals, GeneralInputs, Inertia, MotorCurrents, RawGyro};
