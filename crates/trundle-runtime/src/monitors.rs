//! Monitors of the sensors: a frozen camera.

pub(crate) mod camera_health;
