//! The formats of the TUM RGB-D benchmark \[Sturm12\]: trajectories, image lists, folders.

mod association;
mod frame;
mod list;
mod odometry;
mod orb_slam;
mod sequence;
mod trajectory;
mod writer;

pub use frame::TumFrame;
pub use odometry::{odometry_text, read_odometry};
use orb_slam::orb_slam_yaml;
pub use sequence::TumSequence;
pub use trajectory::{read_trajectory, trajectory_text, trajectory_text_from_planar};
pub use writer::TumWriter;
