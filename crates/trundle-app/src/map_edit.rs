//! Finished maps: cropped, rotated, compared, merged, and divided into rooms.

mod alignment;
mod box_arg;
mod crop;
mod diff;
mod diff_picture;
mod input;
mod merge;
mod output;
mod room_zones;
mod rooms;
mod rooms_picture;
mod rotate;

pub use box_arg::BoxArg;
pub use crop::{CropExtent, crop_map};
pub use diff::{DiffPose, DiffRequest, diff_maps};
pub use merge::{MergeRequest, merge_maps};
pub use output::EditedMap;
pub use rooms::{RoomsRequest, divide_map};
pub use rotate::{RotationTarget, rotate_map};
