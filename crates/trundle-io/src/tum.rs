//! The formats of the TUM RGB-D benchmark \[Sturm12\]: trajectories, image lists, folders.

mod association;
mod frame;
mod kitti;
mod list;
mod members;
mod odometry;
mod odometry_units;
mod orb_slam;
mod rows;
mod sequence;
mod trajectory;
mod trajectory_form;
mod writer;

pub(crate) use association::pair_nearest;
pub use frame::TumFrame;
pub use odometry::{odometry_text, read_odometry};
use orb_slam::orb_slam_yaml;
pub use sequence::TumSequence;
pub use trajectory::{
    TrajectoryFile, read_trajectory, read_trajectory_file, trajectory_text, trajectory_text_from_planar,
};
pub use writer::TumWriter;
