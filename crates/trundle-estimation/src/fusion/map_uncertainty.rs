//! Uncertainty of the map: of the poses at which its parts were drawn.

use crate::fusion::pose_uncertainty::PoseUncertainty;
use std::collections::{BTreeMap, BTreeSet};
use trundle_core::{Pose2, Vector2};

/// Side of a tile \[m\]: below it, parts of a wall are drawn at the same time. Source: ours.
const TILE_SIDE_M: f64 = 0.5;
/// Share of a scan in the uncertainty of a tile: about ten scans replace the hits of earlier ones. Source: ours.
const REDRAWN_SHARE: f64 = 0.1;

/// For each tile of the map, the uncertainty of the poses at which the tile was drawn.
///
/// A scan match compares a scan with the map. If the map was drawn at a pose with an error, the matched pose has the same error, and further
/// matches do not reduce it. The error of a part of the map is a rigid motion `exp(e)` in the map frame, with `e` of zero mean and the
/// tile's uncertainty (x m, y m, theta rad). The tiles of a loaded map are certain: it defines the frame.
#[derive(Debug, Clone, Default)]
pub struct MapUncertainty {
    tiles: BTreeMap<[i32; 2], PoseUncertainty>,
}

impl MapUncertainty {
    /// A map whose present content is certain at these points, map frame, m.
    pub fn of_certain(points: impl Iterator<Item = Vector2>) -> Self {
        Self { tiles: points.filter_map(tile_of).map(|tile| (tile, PoseUncertainty::default())).collect() }
    }

    /// Records hits (map frame, m) that were drawn at a pose of this uncertainty.
    pub fn note(&mut self, pose: Pose2, drawn: &PoseUncertainty, hits: impl Iterator<Item = Vector2>) {
        let in_map = drawn.in_map(&pose);
        // A scan counts once in each tile.
        for tile in hits.filter_map(tile_of).collect::<BTreeSet<_>>() {
            let known = self.tiles.entry(tile).or_insert(in_map);
            known.covariance += (in_map.covariance - known.covariance) * REDRAWN_SHARE;
            known.scale_error += (in_map.scale_error - known.scale_error) * REDRAWN_SHARE;
        }
    }

    /// Uncertainty of the map at a pose that is matched by these hits (map frame, m): the mean of their tiles. `None` where nothing is
    /// recorded: the map then has no wall that a scan could match.
    pub fn at(&self, pose: Pose2, hits: impl Iterator<Item = Vector2>) -> Option<PoseUncertainty> {
        let mut sum = PoseUncertainty::default();
        let mut count = 0.0;
        for tile in hits.filter_map(tile_of).filter_map(|tile| self.tiles.get(&tile)) {
            sum.covariance += tile.covariance;
            sum.scale_error += tile.scale_error;
            count += 1.0;
        }
        let mean =
            PoseUncertainty { covariance: sum.covariance / count, scale_error: sum.scale_error / count };
        (count > 0.0).then(|| mean.at_pose(&pose))
    }
}

/// The tile of a point; `None` for a point that no map holds.
fn tile_of(point: Vector2) -> Option<[i32; 2]> {
    let index = point.map(|value| (value / TILE_SIDE_M).floor());
    let is_valid = index.iter().all(|i| i.abs() < f64::from(i32::MAX));
    is_valid.then(|| [index.x as i32, index.y as i32])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    fn variances(position: f64, heading: f64) -> PoseUncertainty {
        let covariance = Matrix3::from_diagonal(&Vector3::new(position, position, heading));
        PoseUncertainty { covariance, scale_error: Vector3::zeros() }
    }

    fn scale_error(turn: f64) -> PoseUncertainty {
        PoseUncertainty { scale_error: Vector3::new(0.0, 0.0, turn), ..PoseUncertainty::default() }
    }

    /// The largest difference of two uncertainties.
    fn difference(a: PoseUncertainty, b: PoseUncertainty) -> f64 {
        (a.covariance - b.covariance).abs().max().max((a.scale_error - b.scale_error).abs().max())
    }

    fn wall(x: f64) -> impl Iterator<Item = Vector2> {
        (0..40).map(move |i| Vector2::new(x, 0.05 * f64::from(i)))
    }

    #[test]
    fn a_match_with_a_wall_is_no_better_than_the_pose_that_drew_it() {
        let mut map = MapUncertainty::default();
        let drawn_at = Pose2::new(1.0, 0.5, 0.7);
        map.note(drawn_at, &variances(4e-4, 9e-4), wall(3.2));
        let here = map.at(drawn_at, wall(3.2)).unwrap();
        assert!(difference(here, variances(4e-4, 9e-4)) < 1e-12, "{here:?}");
        // From 2 m beside it, the error of the heading displaces the matched pose.
        let beside = map.at(Pose2::new(1.0, 2.5, 0.0), wall(3.2)).unwrap().total();
        assert!((beside[(0, 0)] - (4e-4 + 4.0 * 9e-4)).abs() < 1e-12, "{beside}");
        assert!((beside[(2, 2)] - 9e-4).abs() < 1e-12);
    }

    #[test]
    fn each_scan_replaces_a_tenth_of_the_uncertainty_of_a_wall() {
        let (pose, mut map) = (Pose2::IDENTITY, MapUncertainty::default());
        let heading = |map: &MapUncertainty| map.at(pose, wall(2.2)).unwrap().total()[(2, 2)];
        map.note(pose, &variances(1e-4, 1e-4), wall(2.2));
        assert!((heading(&map) - 1e-4).abs() < 1e-12, "the first scan draws it");
        map.note(pose, &variances(1e-2, 1e-2), wall(2.2));
        assert!((heading(&map) - 1.09e-3).abs() < 1e-9, "a less certain one: {}", heading(&map));
        (0..50).for_each(|_| map.note(pose, &variances(1e-6, 1e-6), wall(2.2)));
        assert!(heading(&map) < 1e-5, "fifty certain ones: {}", heading(&map));
    }

    #[test]
    fn a_wall_has_the_position_of_the_poses_that_drew_it_last() {
        let mut map = MapUncertainty::default();
        let (far, near) = (Pose2::new(-8.0, 0.5, 0.0), Pose2::new(1.0, 0.5, 0.0));
        map.note(far, &scale_error(0.01), wall(2.2));
        // Drawn from far away, the position of the wall at the near pose has an error of 9 cm; the near pose has none.
        let beside = |map: &MapUncertainty| map.at(near, wall(2.2)).unwrap().scale_error.y.abs();
        assert!((beside(&map) - 0.09).abs() < 1e-9, "{}", beside(&map));
        (0..50).for_each(|_| map.note(near, &scale_error(0.01), wall(2.2)));
        assert!(beside(&map) < 0.001, "{}", beside(&map));
    }

    #[test]
    fn the_errors_of_a_scale_are_averaged_with_their_signs() {
        let (pose, mut map) = (Pose2::IDENTITY, MapUncertainty::default());
        map.note(pose, &scale_error(0.02), wall(2.2));
        map.note(pose, &scale_error(-0.02), wall(-2.2));
        let seen = |hits: Vec<Vector2>| map.at(pose, hits.into_iter()).unwrap().scale_error.z;
        assert!((seen(wall(2.2).collect()) - 0.02).abs() < 1e-12);
        assert!(seen(wall(2.2).chain(wall(-2.2)).collect()).abs() < 1e-12);
    }

    #[test]
    fn a_loaded_map_is_certain_and_an_unknown_place_has_no_uncertainty() {
        let mut map = MapUncertainty::of_certain(wall(2.2));
        assert_eq!(map.at(Pose2::IDENTITY, wall(2.2)), Some(PoseUncertainty::default()));
        assert_eq!(map.at(Pose2::IDENTITY, wall(9.0)), None);
        assert_eq!(map.at(Pose2::IDENTITY, std::iter::empty()), None);
        let nowhere = [f64::NAN, f64::INFINITY, 1e300].map(|x| Vector2::new(x, 0.0));
        map.note(Pose2::IDENTITY, &variances(1e-2, 1e-2), nowhere.into_iter());
        assert_eq!(map.at(Pose2::IDENTITY, nowhere.into_iter()), None);
    }
}
