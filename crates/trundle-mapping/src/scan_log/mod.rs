//! Log of scans, from which the map can be redrawn at corrected poses.

mod entry;
mod live_mapper;
mod packed_scan;

pub use live_mapper::{LiveMapper, Redrawn};
