//! From a depth image to a laser-like scan: of each bearing the nearest obstacle, and where nothing stands for certain.

mod bearings;
mod config;
mod floor_fit;
mod fusion;
mod model;
mod mount;
mod pixel_rays;
mod row;
mod scanner;
mod span_bits;

pub use config::DepthScanConfig;
pub use floor_fit::FloorFit;
pub use fusion::{ScanFusion, ScanFusionConfig};
pub use scanner::DepthScanner;
