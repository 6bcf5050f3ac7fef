//! Small map and cloud of points from some scans of the history.

use crate::filter_models::FilterModels;
use crate::loop_closing::scan_history::ScanHistory;
use crate::scan_match::scan_points::ScanPoints;
use crate::units::in_cells;
use std::collections::BTreeSet;
use trundle_core::Pose2;
use trundle_grid::tiles::{RayUpdateScratch, TileMap};

/// Parts of the trajectory as small maps and as clouds of hits.
#[derive(Debug, Default)]
pub(crate) struct Submaps {
    points: ScanPoints,
    scratch: RayUpdateScratch,
    taken: BTreeSet<(i32, i32)>,
}

/// Minimum distance of two points of a cloud \[cells\]. A nearer point is dropped. Source: ours.
const POINT_SPACING_CELLS: f64 = 3.0;

impl Submaps {
    /// The map drawn from the scans `which` at `poses` (m), and all hits of these scans, map frame.
    pub(crate) fn draw(
        &mut self,
        models: &FilterModels,
        history: &ScanHistory,
        which: &[usize],
        pose: impl Fn(usize) -> Pose2,
    ) -> (TileMap, ScanPoints) {
        let mut map = TileMap::default();
        let mut cloud = ScanPoints::default();
        self.taken.clear();
        for &k in which {
            let pose = in_cells(&models.config, pose(k));
            history.scans[k].unpack_into(&models.config, &mut self.points);
            cloud.gather(std::iter::once((&self.points, pose)), POINT_SPACING_CELLS, &mut self.taken);
            models.ray_update.apply(&mut map, &mut self.scratch, pose, &self.points.rays);
        }
        cloud.finish();
        (map, cloud)
    }
}

/// Selects poses from the end of a range backwards (or forwards), each at least `apart` m or half a radian from the previous one.
pub(crate) fn thinned(
    poses: &[Pose2],
    range: impl Iterator<Item = usize>,
    apart: f64,
    max: usize,
) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for k in range {
        let news = kept.last().is_none_or(|&last: &usize| {
            let step = poses[last].inverse() * poses[k];
            step.position().norm() >= apart || step.theta.abs() >= 0.5
        });
        if news {
            kept.push(k);
            if kept.len() == max {
                break;
            }
        }
    }
    kept
}
