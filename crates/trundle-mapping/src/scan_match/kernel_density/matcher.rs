//! Scan matcher against a grid map.

use super::{
    ScanMatchConfig,
    information::Information,
    matched_map::MatchedMap,
    refinement::{MIN_LEVER_M, refine},
    window_search::search,
};
use crate::scan_match::point_spread::{PointSpread, thinned};
use nalgebra::Matrix3;
use trundle_core::{Invalid, Pose2, Scan, Vector2};
use trundle_grid::{LikelihoodField, SurfacePoints};

/// Matches scans with the map.
///
/// Problem: the pose near a guess at which a scan agrees best with the map, and its covariance. First, all poses of a small window are
/// scored on a likelihood field, coarse to fine. Then Gauss-Newton on the kernel density of the map's obstacles refines the pose to less
/// than a cell. An obstacle is the mean of the hits in an occupied cell, which makes the result nearly independent of the cell size. The
/// information matrix at the optimum gives the covariance. Directions hardly determined by the hits, as along a bare corridor, retain the
/// guess with its large covariance. Cost: window poses x hits look-ups, then about 80 cells per hit and step.
///
/// | symbol | here | unit |
/// |---|---|---|
/// | likelihood field | exp(-d^2 / 2 `search_sigma`^2) | |
/// | kernel | exp(-d^2 / 2 `kernel_sigma`^2) | |
/// | covariance | `inflation`^2 (J' A J / `kernel_sigma`^2)^-1 | m^2, rad^2 |
#[derive(Debug, Clone)]
pub struct ScanMatcher {
    config: ScanMatchConfig,
}

/// Result of a scan match.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanMatch {
    /// `map_from_base`.
    pub pose: Pose2,
    /// Covariance as a right perturbation (x m, y m, theta rad).
    pub covariance: Matrix3<f64>,
    /// Part of the hits on known ground that the map explains, 0 to 1.
    pub score: f64,
    /// Whether some direction was not determined; the pose equals the guess in that direction.
    pub degenerate: bool,
}

impl ScanMatcher {
    /// A matcher.
    ///
    /// # Errors
    /// When the configuration is out of range.
    pub fn new(config: ScanMatchConfig) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()? })
    }

    /// The pose near `guess` (`map_from_base`) at which `scan` fits the map (a [`GridMapper`](crate::GridMapper) as `&mapper`). `None` if too few hits are on known ground, the map explains
    /// too few of them, or the fit leaves the window.
    pub fn refine<'m>(&self, map: impl Into<MatchedMap<'m>>, scan: &Scan, guess: Pose2) -> Option<ScanMatch> {
        let map = map.into();
        if !guess.is_finite() {
            return None;
        }
        let config = &self.config;
        let hits: Vec<Vector2> = scan.hits().collect();
        let points: Vec<Vector2> = thinned(hits.iter().copied(), config.spacing).map(|k| hits[k]).collect();
        if points.len() < config.min_points {
            return None;
        }
        let surface_points = self.surface_points(&map, &points, guess)?;
        let start =
            search(config, &LikelihoodField::new(&surface_points, config.search_sigma), &points, guess);
        let (end, equations) = refine(config, &surface_points, &points, start);

        let spread = PointSpread::new(points.iter().copied(), MIN_LEVER_M);
        let information = Information::new(config, &equations, &spread);
        let displacement = information.held(&(guess.inverse() * end).log());
        let pose = guess * Pose2::exp(displacement);
        let reach = config.window + 3.0 * config.search_sigma;
        let is_known = |&&p: &&Vector2| map.is_known(pose.transform(p), &surface_points, reach);
        let known = points.iter().filter(is_known).count();
        let score = (equations.explained / known.max(1) as f64).min(1.0);
        let (shift, turn) = (displacement.xy().norm(), displacement.z.abs());
        let in_window = shift <= 2.0 * config.window && turn <= 1.5 * config.window_deg.to_radians();
        (known >= config.min_points && score >= config.min_score && in_window).then(|| ScanMatch {
            pose,
            covariance: information.covariance(config),
            score,
            degenerate: information.is_degenerate(),
        })
    }

    fn surface_points(
        &self,
        map: &MatchedMap<'_>,
        points: &[Vector2],
        guess: Pose2,
    ) -> Option<SurfacePoints> {
        let config = &self.config;
        let there: Vec<Vector2> = points.iter().map(|&p| guess.transform(p)).collect();
        let farthest = points.iter().map(Vector2::norm).fold(0.0, f64::max);
        let swing = farthest * config.window_deg.to_radians();
        let margin = 2.0 * config.window + 1.5 * swing + 3.0 * config.search_sigma;
        map.surface_points(&there, margin)
    }
}
