//! From a depth image to a laser-like scan: of each bearing the nearest obstacle, or how far nothing stands there.

mod config;
mod height_gate;
mod pixel_rays;
mod scanner;
mod support;

pub use config::DepthScanConfig;
pub use scanner::DepthScanner;
