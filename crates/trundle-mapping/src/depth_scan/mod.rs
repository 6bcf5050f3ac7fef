//! Converts a depth image to a laser-like scan: for each bearing the nearest obstacle, and the ranges that are certainly free.

mod bearings;
mod config;
mod fan;
mod floor_fit;
mod floor_samples;
mod mount;
mod pixel_model;
mod pixel_rays;
mod pixel_row;
mod range_bins;
mod scan_fusion;
mod scanner;

pub use config::DepthScanConfig;
pub use floor_fit::FloorFit;
pub use scan_fusion::{ScanFusion, ScanFusionConfig};
pub use scanner::DepthScanner;
