//! One trajectory of all frames of a sequence: visual maps placed in one frame by the odometry between them.
//!
//! Problem: images locate frames in visual maps, each with its own coordinate frame; in the dark, frames are not located. Idea: the poses
//! within a visual map are exact relative to each other, so that a map is one rigid body. The odometry between two maps is a constraint of
//! a pose graph over the maps \[Grisetti10\]. A run of frames between two located ones follows the odometry; a pose graph with both ends
//! fixed distributes the error by the covariances of the steps. If images locate all frames, odometry changes no pose. Cost: linear in the
//! frames.
//!
//! | symbol | name here | unit |
//! |---|---|---|
//! | x_i | `world_from_camera` of frame i | m, rad |
//! | z_ij | `OdometryPath::motion` | m, rad |
//! | Omega_ij | `OdometryPath::information` | 1/m^2, 1/rad^2 |

pub(crate) mod frame;
pub(crate) mod fuse;
mod gap;
mod map_layout;
mod odometry_path;
#[cfg(test)]
mod tests;
