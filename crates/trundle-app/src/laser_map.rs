//! The map of a laser log, a bag, a recording or an RGB-D folder by the particle filter, or the robot's trajectory in a given map.

mod counts;
mod depth_scans;
mod input;
mod known_stretches;
mod live_view;
mod log_input;
mod mount_check;
mod mount_steps;
mod neighbours;
mod numbers;
mod request;
mod run;
mod run_result;
mod wrong_options;

pub use counts::ScanCounts;
pub use input::read_log;
pub use log_input::{DepthLog, LogInput};
pub use numbers::map_rows;
pub use request::LaserMapRequest;
pub(crate) use request::depth_filter;
pub use run::map_log;
pub use run_result::LaserMapRun;
