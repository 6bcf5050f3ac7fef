//! A charging station: its box, its infrared light, and its contacts.
//!
//! Frame `station`: on the floor at the middle of the box's front, x out of the front; a docked robot faces -x. The light follows the
//! Kobuki's documentation ("Docking Stations", kobuki.readthedocs.io). Three emitters send a left, a middle and a right sector, each coded
//! as near or far; three receivers at the robot's front report the received codes. The documentation gives no angles and no distances:
//! those here are ours.

mod body;
mod config;
mod contacts;
mod light;
mod sensing;

pub(crate) use body::station_box;
pub use config::StationConfig;
pub(crate) use sensing::StationSensing;
