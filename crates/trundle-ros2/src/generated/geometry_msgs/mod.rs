//! `geometry_msgs`. Written by `cargo xtask ros-interfaces`.

mod point;
mod point32;
mod polygon;
mod polygon_stamped;
mod pose;
mod pose_array;
mod pose_stamped;
mod pose_with_covariance;
mod pose_with_covariance_stamped;
mod quaternion;
mod transform;
mod transform_stamped;
mod twist;
mod twist_stamped;
mod twist_with_covariance;
mod vector3;

pub use point::*;
pub use point32::*;
pub use polygon::*;
pub use polygon_stamped::*;
pub use pose::*;
pub use pose_array::*;
pub use pose_stamped::*;
pub use pose_with_covariance::*;
pub use pose_with_covariance_stamped::*;
pub use quaternion::*;
pub use transform::*;
pub use transform_stamped::*;
pub use twist::*;
pub use twist_stamped::*;
pub use twist_with_covariance::*;
pub use vector3::*;
