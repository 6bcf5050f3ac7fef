//! Small map and cloud of points from some scans of the history.

use crate::loop_closing::scan_history::ScanHistory;
use crate::particle_config::ParticleConfig;
use crate::scan_match::scan_points::ScanPoints;
use std::collections::BTreeSet;
use trundle_core::Pose2;
use trundle_grid::tiles::{RayUpdate, RayUpdateScratch, TileMap};

/// Parts of the way as small maps and as clouds of hits.
#[derive(Debug, Default)]
pub(crate) struct Submaps {
    shape: ScanPoints,
    draw: RayUpdateScratch,
    taken: BTreeSet<(i32, i32)>,
}

/// Minimum distance of two points of a cloud [cells]. A nearer point is dropped. Source: ours.
const POINT_SPACING_CELLS: f64 = 3.0;

impl Submaps {
    /// The map that the scans `which` give at `poses` (m), with all hits of them, map frame.
    pub(crate) fn draw(
        &mut self,
        (config, ray_update): (&ParticleConfig, &RayUpdate),
        history: &ScanHistory,
        which: &[usize],
        pose: impl Fn(usize) -> Pose2,
    ) -> (TileMap, ScanPoints) {
        let mut map = TileMap::default();
        let mut cloud = ScanPoints::default();
        self.taken.clear();
        for &k in which {
            let pose = cells(config, pose(k));
            history.scans[k].unpack_into(config, &mut self.shape);
            cloud.gather(std::iter::once((&self.shape, pose)), POINT_SPACING_CELLS, &mut self.taken);
            ray_update.apply(&mut map, &mut self.draw, pose, &self.shape.rays);
        }
        cloud.finish();
        (map, cloud)
    }
}

/// Of the poses from the end of a range backwards (or onwards), those that are at least `apart` m or half a radian from the one before.
pub(crate) fn thinned(
    poses: &[Pose2],
    range: impl Iterator<Item = usize>,
    apart: f64,
    most: usize,
) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for k in range {
        let news = kept.last().is_none_or(|&last: &usize| {
            let step = poses[last].inverse() * poses[k];
            step.position().norm() >= apart || step.theta.abs() >= 0.5
        });
        if news {
            kept.push(k);
            if kept.len() == most {
                break;
            }
        }
    }
    kept
}

/// A pose in m in cells.
pub(crate) fn cells(config: &ParticleConfig, pose: Pose2) -> Pose2 {
    let per_metre = 1.0 / config.map.resolution;
    Pose2 { x: pose.x * per_metre, y: pose.y * per_metre, ..pose }
}
