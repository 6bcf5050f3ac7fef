use super::{
    ParticleConfig, ScanShape,
    chance::Chance,
    coarse::{CoarseSearch, SearchPrior},
    directions::Directions,
    likelihood::{Likelihood, Vote},
};
use crate::tiles::{TileMap, TileWindow};
use nalgebra::{Cholesky, Matrix3, Vector3};
use trundle_core::{Pose2, wrap_angle};

/// The improved proposal of \[Grisetti07\] for one particle.
///
/// The pose is looked for by correlation, coarse to fine, then by Gauss-Newton on the field of nearest obstacles with
/// the odometry as prior; about the optimum poses are sampled in an ellipsoid as wide as the two together allow;
/// weighted by p(z | m, x) p(x | x', u) they give mean, covariance and, summed up, the particle's new weight. The pose is drawn
/// from that Gaussian. Directions that the scan does not hold stay with the odometry's Gaussian.
#[derive(Debug)]
pub(crate) struct Proposer<'a> {
    pub(crate) config: &'a ParticleConfig,
    pub(crate) likelihood: &'a Likelihood,
    pub(crate) shape: &'a ScanShape,
    /// Covariance of the motion, base frame before it: cells, rad.
    pub(crate) motion_covariance: Matrix3<f64>,
}

/// Where a particle goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proposal {
    /// Cells, rad.
    pub(crate) pose: Pose2,
    /// ln of the sum of the samples' weights.
    pub(crate) log_weight: f64,
    /// Part of the points that the map explains, 0 to 1.
    pub(crate) explained: f64,
    /// Directions left to the odometry, 0 to 3.
    pub(crate) degenerate: usize,
    /// Covariance of the drawn Gaussian (cells, cells, rad), map frame.
    pub(crate) covariance: Matrix3<f64>,
}

const MOST_STEPS: usize = 12;
/// Steps shorter than this are none, cells.
const STILL: f64 = 0.003;
/// Candidates of the coarse search that are refined.
const CANDIDATES: usize = 3;
/// Radius of the ellipsoid of samples, sigmas.
const SPREAD: f64 = 2.5;
/// Less than this part of the points on known obstacles: there is nothing to match.
const LEAST_EXPLAINED: f64 = 0.1;

/// An optimum of the posterior.
struct Optimum {
    pose: Pose2,
    vote: Vote,
    directions: Directions,
    log_posterior: f64,
}

impl Proposer<'_> {
    /// What of a log-weight counts for the particle.
    pub(crate) fn weight_scale(&self) -> f64 {
        1.0 / self.config.weight_correlation
    }

    /// Draws the pose of a particle that stood at `before` and should have come to `guess` (cells, rad, of the map).
    pub(crate) fn propose(
        &self,
        map: &TileMap,
        search: &mut CoarseSearch,
        before: Pose2,
        guess: Pose2,
        chance: &mut Chance,
    ) -> Proposal {
        let window = self.window(map, guess);
        let corner = (f64::from(window.corner.0), f64::from(window.corner.1));
        let local = Pose2 { x: guess.x - corner.0, y: guess.y - corner.1, ..guess };
        let prior = self.prior(before.theta);
        let optimum = self.optimum(&window, search, local, &prior);
        let mut proposal = self.sample(&window, local, &prior, &optimum, chance);
        proposal.pose =
            Pose2::new(proposal.pose.x + corner.0, proposal.pose.y + corner.1, proposal.pose.theta);
        proposal
    }

    /// The tiles that the scan can reach near `guess`.
    fn window<'m>(&self, map: &'m TileMap, guess: Pose2) -> TileWindow<'m> {
        let (s, c) = guess.theta.sin_cos();
        let (mut low, mut high) = ((guess.x, guess.y), (guess.x, guess.y));
        for p in &self.shape.points {
            let (px, py) = (f64::from(p.x), f64::from(p.y));
            let (x, y) = (guess.x + c * px - s * py, guess.y + s * px + c * py);
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
        }
        const MARGIN: f64 = 12.0;
        let cell = |v: f64| v.floor() as i32;
        TileWindow::new(
            map,
            (cell(low.0 - MARGIN), cell(low.1 - MARGIN)),
            (cell(high.0 + MARGIN), cell(high.1 + MARGIN)),
        )
    }

    /// The inverse covariance of the odometry's guess, map frame, for a motion that began at heading `theta`.
    fn prior(&self, theta: f64) -> Matrix3<f64> {
        let (s, c) = theta.sin_cos();
        let turn = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        let covariance = turn * self.motion_covariance * turn.transpose();
        covariance.try_inverse().expect("invariant: the least sigmas of the odometry are positive")
    }

    fn optimum(
        &self,
        window: &TileWindow<'_>,
        search: &mut CoarseSearch,
        guess: Pose2,
        prior: &Matrix3<f64>,
    ) -> Optimum {
        let covariance = &self.motion_covariance;
        let about = SearchPrior {
            information: *prior,
            sigma: covariance[(0, 0)].max(covariance[(1, 1)]).sqrt(),
            sigma_turn: covariance[(2, 2)].sqrt(),
            gain: -self.config.outliers.ln() / self.config.correlation,
        };
        let starts = search.search(window, self.shape, guess, &about);
        let mut best: Option<Optimum> = None;
        for &(_, start) in starts.iter().take(CANDIDATES) {
            let found = self.climb(window, guess, prior, start);
            if best.as_ref().is_none_or(|best| found.log_posterior > best.log_posterior) {
                best = Some(found);
            }
        }
        best.expect("invariant: the search returns a pose for each heading")
    }

    /// Gauss-Newton on hits and odometry together.
    fn climb(&self, window: &TileWindow<'_>, guess: Pose2, prior: &Matrix3<f64>, start: Pose2) -> Optimum {
        let mut pose = start;
        let mut vote = self.likelihood.vote(window, self.shape, pose);
        let directions = Directions::new(self.shape, pose, &vote, self.config.degenerate_below);
        for _ in 0..MOST_STEPS {
            let scale = 1.0 / self.config.correlation;
            let information = directions.information(&vote) * scale + directions.to_y(prior);
            let back = prior * difference(guess, pose);
            let pull = directions.pull(&vote) * scale + directions.pose_from_y.transpose() * back;
            let Some(factor) = Cholesky::new(information) else { break };
            let step = factor.solve(&pull);
            let x = directions.pose_from_y * step;
            pose = Pose2 { x: pose.x + x.x, y: pose.y + x.y, theta: pose.theta + x.z };
            vote = self.likelihood.vote(window, self.shape, pose);
            if step.amax() < STILL {
                break;
            }
        }
        let directions = Directions::new(self.shape, pose, &vote, self.config.degenerate_below);
        Optimum { log_posterior: self.log_posterior(window, guess, prior, pose), pose, vote, directions }
    }

    /// ln p(z | m, x) p(x | x', u), but for a constant.
    fn log_posterior(&self, window: &TileWindow<'_>, guess: Pose2, prior: &Matrix3<f64>, pose: Pose2) -> f64 {
        let off = difference(pose, guess);
        self.likelihood.log_likelihood(window, self.shape, pose) / self.config.correlation
            - 0.5 * off.dot(&(prior * off))
    }

    fn sample(
        &self,
        window: &TileWindow<'_>,
        guess: Pose2,
        prior: &Matrix3<f64>,
        optimum: &Optimum,
        chance: &mut Chance,
    ) -> Proposal {
        let Optimum { pose: top, vote, directions, .. } = optimum;
        let explained = vote.explained / self.shape.points.len().max(1) as f64;
        let lost = explained < LEAST_EXPLAINED;
        let held = if lost { Matrix3::zeros() } else { directions.held };
        let centre = if lost { guess } else { *top };
        let odometry = directions.to_y(prior);
        let hits =
            if lost { Matrix3::zeros() } else { directions.information(vote) / self.config.correlation };
        let shape =
            Cholesky::new(hits + odometry).expect("invariant: the odometry's information is positive");
        // Columns of `spread` are one sigma long.
        let spread = shape.inverse().cholesky().expect("invariant: the inverse of a positive matrix").l();
        let moved = |y: Vector3<f64>| {
            let x = directions.pose_from_y * y;
            Pose2 { x: centre.x + x.x, y: centre.y + x.y, theta: centre.theta + x.z }
        };

        let mut samples = [(0.0, Vector3::zeros()); MOST_SAMPLES];
        let count = self.config.samples.min(MOST_SAMPLES);
        let mut greatest = f64::NEG_INFINITY;
        for pair in samples[..count].chunks_mut(2) {
            let y = spread * chance.in_ball() * SPREAD;
            for (sample, y) in pair.iter_mut().zip([y, -y]) {
                *sample = (self.log_posterior(window, guess, prior, moved(y)), y);
                greatest = greatest.max(sample.0);
            }
        }
        let samples = &samples[..count];
        let (mut sum, mut mean) = (0.0, Vector3::zeros());
        for (log, y) in samples {
            let w = (log - greatest).exp();
            sum += w;
            mean += y * w;
        }
        mean /= sum;
        let mut covariance = Matrix3::zeros();
        for (log, y) in samples {
            let off = y - mean;
            covariance += off * off.transpose() * ((log - greatest).exp() / sum);
        }
        // What is not held stays with the odometry, whatever the samples feign.
        let free = Matrix3::identity() - held;
        let mean = held * mean;
        let odometry_covariance =
            odometry.try_inverse().expect("invariant: the odometry's covariance exists");
        let covariance = held * covariance * held + free * odometry_covariance * free;
        let least = shape.inverse() * LEAST_COVARIANCE;
        let covariance = covariance + least;
        let draw = Cholesky::new(covariance).expect("invariant: a sum with a positive matrix").l();
        let to_pose = directions.pose_from_y;
        Proposal {
            pose: moved(mean + draw * chance.normal3()),
            log_weight: greatest + (sum / count as f64).ln() + spread.determinant().ln(),
            explained,
            degenerate: if lost { 3 } else { directions.degenerate },
            covariance: to_pose * covariance * to_pose.transpose(),
        }
    }
}

/// Most samples.
const MOST_SAMPLES: usize = 500;
/// Part of the Laplace covariance that is drawn from at least: a fit to few samples may be flat.
const LEAST_COVARIANCE: f64 = 0.05;

fn difference(to: Pose2, from: Pose2) -> Vector3<f64> {
    Vector3::new(to.x - from.x, to.y - from.y, wrap_angle(to.theta - from.theta))
}
