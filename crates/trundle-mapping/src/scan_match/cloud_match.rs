//! Match of a cloud of points with a map within a search region.

use crate::particle_config::ParticleConfig;
use crate::scan_match::branch_and_bound::{FoundPose, LookupBudget, Pyramid, Query};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::motion_prior::MotionPrior;
use crate::scan_match::pose_optimizer::PoseOptimizer;
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::Matrix3;
use trundle_core::{Hypotenuse, Pose2};
use trundle_grid::tiles::{TileMap, TileWindow};

/// A place where a cloud of hits fits a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CloudMatch {
    /// Pose: cells, rad.
    pub(crate) pose: Pose2,
    /// Inverse covariance from the hits (cells, rad), map frame; zero in degenerate directions.
    pub(crate) information: Matrix3<f64>,
    /// Part of the hits at obstacles.
    pub(crate) explained: f64,
    /// Number of directions without information.
    pub(crate) degenerate: usize,
    /// ln p(z | m, x), tempered, nats.
    pub(crate) log_likelihood: f64,
}

/// Maximum number of points of the search. Larger clouds are subsampled. Source: ours.
const MAX_SEARCH_POINTS: usize = 120;
/// Minimum distance of two places \[cells\]. Nearer places of similar heading count as one. Source: ours.
const MIN_PLACE_DISTANCE_CELLS: f64 = 12.0;
/// Minimum difference of heading of two places \[rad\]. Source: ours.
const MIN_PLACE_TURN_RAD: f64 = 0.12;

/// Minimum log-likelihood ratio of a place to the second-best place and to unknown ground [nats]. A lower ratio proves no
/// place. Source: ours.
pub(crate) const MIN_PROOF_NATS: f64 = 16.0;

/// Searches a cloud in a map.
pub(crate) struct CloudMatcher<'a> {
    pub(crate) config: &'a ParticleConfig,
    pub(crate) likelihood: &'a Likelihood,
    pub(crate) cloud: &'a ScanPoints,
}

impl CloudMatcher<'_> {
    /// The best places within `reach` (cells) and `turn_reach` of a guess, the best first, each refined to its local optimum.
    pub(crate) fn find(
        &self,
        map: &TileMap,
        guess: Pose2,
        covariance: &Matrix3<f64>,
        (reach, turn_reach): ((f64, f64), f64),
        max: usize,
    ) -> Vec<CloudMatch> {
        let Some(pyramid) = Pyramid::new(map) else { return Vec::new() };
        let all = LookupBudget::unlimited();
        self.find_in((&pyramid, map), guess, covariance, (reach, turn_reach), (max, &all))
    }

    /// At most `max` matches of the cloud in a map with a pyramid, within a budget.
    pub(crate) fn find_in(
        &self,
        (pyramid, map): (&Pyramid, &TileMap),
        guess: Pose2,
        covariance: &Matrix3<f64>,
        (reach, turn_reach): ((f64, f64), f64),
        (max, budget): (usize, &LookupBudget),
    ) -> Vec<CloudMatch> {
        let every = self.cloud.points.len().div_ceil(MAX_SEARCH_POINTS).max(1);
        let points: Vec<_> = self.cloud.points.iter().step_by(every).map(|p| (p.x, p.y)).collect();
        if points.is_empty() {
            return Vec::new();
        }
        let query = Query {
            gain: -self.config.outliers.ln() / self.config.correlation * every as f64,
            points: &points,
            guess,
            reach,
            turn_reach,
            turn_step: (2.0 / self.cloud.spread.lever).clamp(0.004, 0.05),
            sigma: (covariance[(0, 0)].sqrt(), covariance[(1, 1)].sqrt(), covariance[(2, 2)].sqrt()),
        };
        let mut places: Vec<FoundPose> = Vec::new();
        while places.len() < max {
            // A place below half of the best score is no competitor.
            let min = places.first().map_or(0.0, |best| 0.5 * best.score);
            let apart = (MIN_PLACE_DISTANCE_CELLS, MIN_PLACE_TURN_RAD);
            let Some(place) = pyramid.search(&query, &places, (apart, min), budget) else {
                break;
            };
            places.push(place);
        }
        let mut found: Vec<CloudMatch> =
            places.iter().map(|place| self.climb(map, place.pose, covariance)).collect();
        found.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
        found
    }

    /// The local optimum near a pose.
    pub(crate) fn climb(&self, map: &TileMap, start: Pose2, covariance: &Matrix3<f64>) -> CloudMatch {
        let optimizer =
            PoseOptimizer { config: self.config, likelihood: self.likelihood, points: self.cloud };
        let window = self.window(map, start);
        let corner = (f64::from(window.corner.0), f64::from(window.corner.1));
        let start = Pose2 { x: start.x - corner.0, y: start.y - corner.1, ..start };
        let prior = MotionPrior::with(start, *covariance);
        let optimum = optimizer.optimize(&window, &prior, start);
        let pose = Pose2::new(optimum.pose.x + corner.0, optimum.pose.y + corner.1, optimum.pose.theta);
        let all = self.cloud.points.len().max(1) as f64;
        let to_y = optimum.directions.pose_from_y.try_inverse().expect("invariant: a lever is positive");
        let in_y = optimum.directions.information(&optimum.equations) / self.config.correlation;
        CloudMatch {
            information: to_y.transpose() * in_y * to_y,
            explained: optimum.equations.normal.explained / all,
            degenerate: optimum.directions.degenerate,
            log_likelihood: self.likelihood.log_likelihood(&window, self.cloud, optimum.pose)
                / self.config.correlation,
            pose,
        }
    }

    /// Fit of the cloud at a pose: fractions explained and contradicted.
    pub(crate) fn fit(&self, map: &TileMap, pose: Pose2) -> (f64, f64) {
        let window = self.window(map, pose);
        let corner = (f64::from(window.corner.0), f64::from(window.corner.1));
        let equations = self.likelihood.equations(
            &window,
            self.cloud,
            Pose2 { x: pose.x - corner.0, y: pose.y - corner.1, ..pose },
        );
        let all = self.cloud.points.len().max(1) as f64;
        (equations.normal.explained / all, equations.contradicted / all)
    }

    fn window<'m>(&self, map: &'m TileMap, pose: Pose2) -> TileWindow<'m> {
        const MARGIN: f64 = 24.0;
        let far =
            self.cloud.points.iter().map(|p| f64::from(p.x.hypotenuse(p.y))).fold(0.0, f64::max) + MARGIN;
        let cell = |v: f64| v.floor() as i32;
        TileWindow::new(
            map,
            (cell(pose.x - far), cell(pose.y - far)),
            (cell(pose.x + far), cell(pose.y + far)),
        )
    }
}
