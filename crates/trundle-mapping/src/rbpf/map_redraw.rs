//! Redraw of the map along a trajectory that a loop closure corrected.

use crate::scan_match::scan_points::ScanPoints;
use trundle_core::Pose2;
use trundle_grid::tiles::{RayUpdateScratch, TileMap};

/// Map along a corrected trajectory, in progress. Some scans are redrawn with each new scan, beside the map in use.
#[derive(Debug, Clone, Default)]
pub(crate) struct MapRedraw {
    /// Corrected poses of the first stored scans, m.
    pub(crate) poses: Vec<Pose2>,
    /// Largest displacement of a pose, m.
    pub(crate) farthest: f64,
    /// Number of scans that are redrawn.
    pub(crate) drawn: usize,
    /// Map of the redrawn scans.
    pub(crate) map: TileMap,
    pub(super) points: ScanPoints,
    pub(super) scratch: RayUpdateScratch,
}
