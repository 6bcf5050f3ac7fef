//! `sensor_msgs`. Written by `cargo xtask ros-interfaces`.

mod battery_state;
mod camera_info;
mod compressed_image;
mod image;
mod imu;
mod joint_state;
mod laser_scan;
mod point_cloud2;
mod point_field;
mod region_of_interest;

pub use battery_state::*;
pub use camera_info::*;
pub use compressed_image::*;
pub use image::*;
pub use imu::*;
pub use joint_state::*;
pub use laser_scan::*;
pub use point_cloud2::*;
pub use point_field::*;
pub use region_of_interest::*;
