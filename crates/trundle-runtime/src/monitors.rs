//! Monitors of the sensors: a frozen camera, scans that contradict the map.

pub(crate) mod camera_health;
pub(crate) mod scan_map_consistency;
