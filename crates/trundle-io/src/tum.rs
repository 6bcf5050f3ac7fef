//! The formats of the TUM RGB-D benchmark \[Sturm12\]: trajectories, image lists, folders.

mod association;
mod list;
mod odometry;
mod sequence;
mod trajectory;

pub use odometry::{odometry_text, read_odometry};
pub use sequence::TumSequence;
pub use trajectory::{read_trajectory, trajectory_text, trajectory_text_from_planar};
