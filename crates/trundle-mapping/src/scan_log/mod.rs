//! Log of scans: the map can be drawn again from it at corrected poses.

mod entry;
mod live_mapper;
mod packed_scan;

pub use live_mapper::{LiveMapper, Redrawn};
