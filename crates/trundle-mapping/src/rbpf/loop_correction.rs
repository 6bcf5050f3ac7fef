//! Loop closing of the filter: loop searches, the redraw of the corrected map, and thinning of the history.

use crate::filter_models::FilterModels;
use crate::loop_closing::crowded_places::crowded;
use crate::loop_closing::loop_closer::LoopCloser;
use crate::loop_closing::scan_history::{ScanHistory, every_second, number_after};
use crate::polish::polished;
use crate::rbpf::map_redraw::MapRedraw;
use crate::rbpf::particle_set::ParticleSet;
use crate::scan_match::scan_points::ScanPoints;
use crate::units::{in_cells, in_metres};
use trundle_core::Pose2;
use trundle_grid::tiles::{RayUpdateScratch, TileMap};

/// Cells redrawn with one scan: about ten times the cells that thirty particles update. A smaller number leaves the robot
/// longer in the uncorrected map. Source: ours.
const CELLS_PER_SCAN: usize = 4_000_000;
/// Minimum cost of a redrawn scan \[cells\]. Source: ours.
const MIN_SCAN_COST_CELLS: usize = 500;
/// Path length between two loop searches \[m\]. Source: ours.
const LOOP_SEARCH_INTERVAL_M: f64 = 2.0;

/// Stored scans of the run, the search for loops in them, and the redraw of a corrected map.
#[derive(Debug)]
pub(crate) struct LoopCorrector {
    pub(crate) history: ScanHistory,
    pub(crate) loop_closer: LoopCloser,
    /// Map along a corrected trajectory, in progress.
    pub(crate) redraw: Option<MapRedraw>,
    /// Number of stored scans above which redundant ones are dropped.
    crowded_at: usize,
}

/// Smallest number of stored scans at which redundant ones are dropped: a drive of a kilometre. Source: ours.
const MIN_CROWDED_SCANS: usize = 4000;

impl Default for LoopCorrector {
    fn default() -> Self {
        Self {
            history: ScanHistory::default(),
            loop_closer: LoopCloser::default(),
            redraw: None,
            crowded_at: MIN_CROWDED_SCANS,
        }
    }
}

impl LoopCorrector {
    /// Searches for a loop every 2 m of path; `driven` m are new. A closed loop corrects trajectory and map of the best particle. Some
    /// scans are redrawn with each call; then all particles continue from the corrected state. Returns the largest displacement of a pose,
    /// m, when a correction is complete.
    pub(crate) fn close_loops(
        &mut self,
        models: &FilterModels,
        set: &mut ParticleSet,
        driven: f64,
    ) -> Option<f64> {
        self.loop_closer.driven += driven;
        if self.redraw.is_some() {
            return self.advance_redraw(models, set, CELLS_PER_SCAN).1;
        }
        if self.loop_closer.driven < LOOP_SEARCH_INTERVAL_M {
            return None;
        }
        self.loop_closer.driven = 0.0;
        let poses: Vec<Pose2> = set.trajectory().into_iter().map(|(_, pose)| pose).collect();
        let closing = self.loop_closer.search(models, &mut self.history, &poses)?;
        if closing.farthest >= models.config.map.resolution {
            self.redraw =
                Some(MapRedraw { poses: closing.poses, farthest: closing.farthest, ..MapRedraw::default() });
        }
        None
    }

    /// Completes a redraw in progress.
    pub(crate) fn finish(&mut self, models: &FilterModels, set: &mut ParticleSet) {
        self.advance_redraw(models, set, usize::MAX);
    }

    /// Polishes the trajectory of the best particle, and redraws the map. Returns the largest displacement of a pose, m; `None` if the poses
    /// are kept, or `goes_on` ended it.
    pub(crate) fn polish(
        &mut self,
        models: &FilterModels,
        set: &mut ParticleSet,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<f64> {
        self.finish(models, set);
        let poses: Vec<Pose2> = set.trajectory().into_iter().map(|(_, pose)| pose).collect();
        let polished = polished(&models.config, &self.history, &poses, goes_on)?;
        let farthest = polished.iter().zip(&poses).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        self.history.replace_measurements(&polished);
        self.redraw = Some(MapRedraw { poses: polished, farthest, ..MapRedraw::default() });
        self.advance_redraw(models, set, usize::MAX).1
    }

    /// Redraws scans at their corrected poses for about `budget` cells. The particles take the new map when all scans are drawn.
    /// Returns the number of updated cells, and the largest displacement of a pose, m, when complete.
    pub(crate) fn advance_redraw(
        &mut self,
        models: &FilterModels,
        set: &mut ParticleSet,
        budget: usize,
    ) -> (usize, Option<f64>) {
        let Some(mut redraw) = self.redraw.take() else { return (0, None) };
        let mut cells = 0;
        while cells < budget && redraw.drawn < redraw.poses.len() {
            let pose = redraw.poses[redraw.drawn];
            cells += self.redraw_scan(models, &mut redraw, pose);
        }
        if redraw.drawn < redraw.poses.len() {
            self.redraw = Some(redraw);
            return (cells, None);
        }
        (cells, Some(self.apply_redraw(models, set, redraw)))
    }

    /// Bounds the number of stored scans by the area that they cover, and finally by `max_scans`.
    pub(crate) fn thin_history(&mut self, models: &FilterModels, set: &mut ParticleSet) {
        let (max_scans, stored) = (models.config.max_scans, self.history.scans.len());
        if stored > self.crowded_at {
            let poses: Vec<Pose2> = set.trajectory().into_iter().map(|(_, pose)| pose).collect();
            self.drop_scans(models, set, &crowded(&poses, set.first_pose_of_run));
            self.crowded_at = MIN_CROWDED_SCANS.max(2 * self.history.scans.len());
        }
        if self.history.scans.len() > max_scans {
            self.drop_scans(models, set, &every_second(self.history.scans.len(), max_scans / 2));
        }
    }

    /// Drops the stored scans for which `goes` is true.
    fn drop_scans(&mut self, models: &FilterModels, set: &mut ParticleSet, goes: &[bool]) {
        if !goes.contains(&true) {
            return;
        }
        // A redraw refers to scans by number.
        self.finish(models, set);
        let mut trajectory = set.trajectory();
        self.history.thin(&mut trajectory, goes);
        set.ancestry.thin(goes);
        set.first_pose_of_run = number_after(goes, set.first_pose_of_run);
        self.loop_closer.pending.clear();
    }

    /// Drops all stored scans but the first `count`, loops not yet accepted, and a redraw in progress.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.redraw = None;
        self.history.truncate(count);
        self.loop_closer.pending.clear();
    }

    /// Draws stored scan `k` at `pose` (cells) into `map`.
    pub(crate) fn draw_scan(&self, models: &FilterModels, map: &mut TileMap, k: usize, pose: Pose2) {
        let (mut points, mut scratch) = (ScanPoints::default(), RayUpdateScratch::default());
        self.history.scans[k].unpack_into(&models.config, &mut points);
        models.ray_update.apply(map, &mut scratch, pose, &points.rays);
    }

    /// Draws the next stored scan at `pose` (m). Returns its cost, cells.
    fn redraw_scan(&self, models: &FilterModels, redraw: &mut MapRedraw, pose: Pose2) -> usize {
        self.history.scans[redraw.drawn].unpack_into(&models.config, &mut redraw.points);
        redraw.drawn += 1;
        let pose = in_cells(&models.config, pose);
        models.ray_update.apply(&mut redraw.map, &mut redraw.scratch, pose, &redraw.points.rays)
            + MIN_SCAN_COST_CELLS
    }

    /// Moves all particles to the corrected trajectory. Scans newer than the correction keep their poses relative to its end.
    fn apply_redraw(&self, models: &FilterModels, set: &mut ParticleSet, mut redraw: MapRedraw) -> f64 {
        let mut trajectory = set.trajectory();
        let corrected = redraw.poses.len();
        let moved = redraw.poses[corrected - 1] * trajectory[corrected - 1].1.inverse();
        for (k, (_, pose)) in trajectory.iter_mut().enumerate() {
            *pose = if k < corrected { redraw.poses[k] } else { moved * *pose };
            if k >= corrected {
                self.redraw_scan(models, &mut redraw, *pose);
            }
        }
        let last = trajectory.last().expect("invariant: a corrected trajectory has poses").1;
        let pose = in_cells(&models.config, last);
        debug_assert!(in_metres(&models.config, pose).distance(&last) < 1e-6, "cells and metres agree");
        set.collapse(trajectory, pose, &redraw.map);
        redraw.farthest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_closing::stored_scan::StoredScan;
    use crate::particle_config::ParticleConfig;
    use nalgebra::Matrix3;
    use trundle_core::{Beam, Scan, Stamp, Vector2};

    /// Three particles after `scans` along a straight path, with a redraw along a turned one.
    fn corrected(models: &FilterModels, scans: usize) -> (LoopCorrector, ParticleSet) {
        let (mut loops, mut set) = (LoopCorrector::default(), ParticleSet::new(3));
        let beams = (0..90).map(|k| Beam::Hit { range: 3.0 + 0.01 * f64::from(k % 7) }).collect();
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), -1.5, 0.03, beams).unwrap();
        let mut points = ScanPoints::default();
        points.set(&models.config, &scan);
        let path: Vec<_> = (0..scans)
            .map(|k| (Stamp::from_nanos(k as i64), Pose2::new(0.05 * k as f64, 0.0, 0.0)))
            .collect();
        path.iter().for_each(|_| {
            loops.history.push(StoredScan::new(&models.config, &points), Matrix3::identity() * 1e-4)
        });
        let turn = |pose: Pose2| Pose2::new(0.0, 0.0, 0.1) * pose;
        let poses = path[..scans - 5].iter().map(|(_, pose)| turn(*pose)).collect();
        set.ancestry.replace(path);
        loops.redraw = Some(MapRedraw { poses, farthest: 1.0, ..MapRedraw::default() });
        (loops, set)
    }

    #[test]
    fn the_cost_of_a_redraw_step_does_not_grow_with_the_run_and_steps_give_the_map_of_one_redraw() {
        const BUDGET: usize = 20_000;
        let models = FilterModels::new(ParticleConfig::default()).unwrap();
        for scans in [40, 400] {
            let ((mut sliced, mut set), (mut once, mut other)) =
                (corrected(&models, scans), corrected(&models, scans));
            let (mut max, mut slices, mut all) = (0, 0, 0);
            loop {
                let (cells, done) = sliced.advance_redraw(&models, &mut set, BUDGET);
                (max, slices, all) = (max.max(cells), slices + 1, all + cells);
                if done.is_some() {
                    break;
                }
            }
            once.finish(&models, &mut other);
            assert!(max < BUDGET + 5_000, "{max} cells in one step");
            assert!(slices >= all / (BUDGET + 5_000), "{slices} steps");
            assert!(once.redraw.is_none());
            let mut changed = 0;
            set.best().map.changed_tiles(&TileMap::default(), |at, tile| {
                changed += 1;
                let same = tile.is_some_and(|tile| tile.bytes().eq(other.best().map.tile(at).bytes()));
                assert!(same, "tile {at:?}");
            });
            assert!(changed > 0);
            // Scans newer than the correction keep their poses relative to its end.
            let end = Pose2::new(0.0, 0.0, 0.1) * Pose2::new(0.05 * (scans - 1) as f64, 0.0, 0.0);
            assert!(in_metres(&models.config, set.best().pose).distance(&end) < 1e-6);
            assert_eq!(set.trajectory().len(), scans);
        }
    }
}
