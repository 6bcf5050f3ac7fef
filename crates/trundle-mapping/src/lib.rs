//! Scans from depth images, occupancy grids from scans, and scan matching against a grid.
//!
//! - [`DepthScanner`]: one depth image in, one laser-like [`trundle_core::Scan`] out (the robot's height band, docs/methods.md A2).
//! - [`GridMapper`]: scans at known poses in, a log-odds occupancy grid out (docs/methods.md A3 with one particle).
//! - [`map_edit`]: finished maps cropped, rotated, compared, merged, and divided into rooms.
//! - [`ScanMatcher`]: the pose at which a scan fits the grid best, its covariance, and the directions that the scan does not determine.
//!
//! The parts of a particle filter are separate types. The map of one particle is a [`LogOddsGrid`]: its tiles are shared until
//! written, so a clone is cheap. The evidence of a scan does not depend on the owner of the map.
//!
//! ```
//! use trundle_core::{Beam, Cell, Pose2, Scan, Stamp, Vector2};
//! use trundle_mapping::{GridMapper, MapperConfig};
//!
//! let mut mapper = GridMapper::new(MapperConfig::default())?;
//! let wall_ahead = vec![Beam::Hit { range: 2.0 }; 10];
//! let scan = Scan::new(Stamp::default(), Vector2::zeros(), 0.0, 0.002, wall_ahead)?;
//! for _ in 0..4 {
//!     mapper.insert(Pose2::IDENTITY, &scan);
//! }
//! assert_eq!(mapper.grid().at(Vector2::new(2.01, 0.01)), Cell::Occupied);
//! assert_eq!(mapper.grid().at(Vector2::new(1.51, 0.01)), Cell::Free);
//! assert_eq!(mapper.grid().at(Vector2::new(2.51, 0.01)), Cell::Unknown);
//! # Ok::<(), trundle_core::Invalid>(())
//! ```

mod depth_scan;
mod filter_models;
mod global_localization;
mod grid_mapper;
mod loop_closing;
pub mod map_edit;
mod particle_config;
mod persist;
mod polish;
mod pose_graph;
mod rbpf;
mod scan_log;
mod scan_match;
mod units;

pub use depth_scan::{DepthScanConfig, DepthScanner, FloorFit, ScanFusion, ScanFusionConfig};
pub use global_localization::{Localized, MapLocalizer};
pub use grid_mapper::{GridMapper, Insertion};
pub use particle_config::{MotionConfig, ParticleConfig, PosePriorConfig};
pub use persist::FilterFileError;
pub use rbpf::{
    MappingPause, ParticleMapper, Processed, Refusal, ScanUpdate, propagate_trajectory, propagated_poses,
};
pub use scan_log::{LiveMapper, Redrawn};
pub use scan_match::{Lost, MatchedMap, ScanMatch, ScanMatchConfig, ScanMatcher};
pub use trundle_grid::{Evidence, GridCell, LogOddsGrid, MapperConfig, RayCells, ray_cells};
