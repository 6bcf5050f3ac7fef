//! Finished maps: cropped, rotated, compared, matched with each other, merged, and divided into rooms.
//!
//! All functions take and return three-valued grids ([`trundle_core::OccupancyGrid`]). A map that is moved onto other cells is resampled
//! once, by [`resampled`]: walls keep their thickness, no wall opens and no obstacle is lost.
//!
//! ```
//! use trundle_core::{OccupancyGrid, Pose2};
//! use trundle_mapping::map_edit::{known_part, rotated};
//!
//! let grid = OccupancyGrid::from_ascii(0.05, "?????\n?###?\n?...?")?;
//! let known = known_part(&grid)?;
//! assert_eq!((known.geometry().width, known.geometry().height), (3, 2));
//! let upright = rotated(&known, Pose2::IDENTITY, std::f64::consts::FRAC_PI_2)?;
//! assert_eq!((upright.geometry().width, upright.geometry().height), (2, 3));
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod comparison;
mod coverage;
mod crop;
mod lattice;
mod map_match;
mod merge;
mod resample;
mod rooms;
mod rotation;
mod thinning;
mod wall_direction;

pub use comparison::{CellPair, MapComparison};
pub use crop::{cropped, known_part};
pub use lattice::{covering_lattice, lattice_of};
pub use map_match::{MIN_AGREEING_M, MIN_AGREEING_SHARE, MapFit, MapMatch, MatchFailure, fit_at, match_maps};
pub use merge::{MergeCounts, merged};
pub use resample::resampled;
pub use rooms::{MapRooms, Room, RoomLimits, map_rooms};
pub use rotation::{rotated, upright};
pub use wall_direction::{WallDirection, wall_direction};
