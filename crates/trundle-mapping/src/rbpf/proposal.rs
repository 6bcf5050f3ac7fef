//! Improved proposal distribution of one particle.

use crate::particle_config::ParticleConfig;
use crate::rbpf::absolute_pose::AbsolutePose;
use crate::rbpf::odometry_noise::Innovation;
use crate::rbpf::rng::ParticleRng;
use crate::scan_match::branch_and_bound::{LookupBudget, Pyramid, Query};
use crate::scan_match::coarse_search::{CoarseSearch, SearchPrior};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::motion_prior::MotionPrior;
use crate::scan_match::pose_optimizer::{Optimum, PoseOptimizer, difference};
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::{Cholesky, Matrix3, Vector3};
use trundle_core::{Hypotenuse, Pose2};
use trundle_grid::tiles::{Tile, TileMap, TileWindow};

/// The improved proposal of \[Grisetti07\] for one particle.
///
/// A correlative search, coarse to fine, finds the pose; then Gauss-Newton on the field of nearest obstacles refines it with the
/// odometry as prior. Poses are sampled about the optimum in an ellipsoid as wide as scan and odometry together allow. Weighted by
/// p(z | m, x) p(x | x', u) they give mean, covariance and, as their sum, the particle's new weight. The pose is drawn from that
/// Gaussian. Directions that the scan does not determine keep the odometry's Gaussian.
#[derive(Debug)]
pub(crate) struct Proposer<'a> {
    pub(crate) config: &'a ParticleConfig,
    pub(crate) likelihood: &'a Likelihood,
    pub(crate) points: &'a ScanPoints,
    /// Covariance of the motion, base frame before it: cells, rad.
    pub(crate) motion_covariance: Matrix3<f64>,
    /// Pose of the robot by odometry without drift.
    pub(crate) anchor: Option<AbsolutePose>,
    /// Mean ln p(z | m, x) of a point in the last scans.
    pub(crate) expected_log_likelihood: f64,
}

/// Proposed pose of a particle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proposal {
    /// Drawn pose: cells, rad.
    pub(crate) pose: Pose2,
    /// ln of the sum of the samples' weights.
    pub(crate) log_weight: f64,
    /// Part of the points that the map explains, 0 to 1.
    pub(crate) explained: f64,
    /// Fraction of the points on free ground without a near obstacle, 0 to 1.
    pub(crate) contradicted: f64,
    /// Mean ln p(z | m, x) of the points at the optimum.
    pub(crate) per_point: f64,
    /// Whether the step's odometry counted as wrong.
    pub(crate) slipped: bool,
    /// Number of directions determined by the odometry alone, 0 to 3.
    pub(crate) degenerate: usize,
    /// Covariance of the drawn Gaussian (cells, cells, rad), map frame.
    pub(crate) covariance: Matrix3<f64>,
    /// Difference between match and odometry, if the match determines all directions.
    pub(crate) innovation: Option<Innovation>,
}

/// Minimum distance of two starts of the optimisation \[cells\]. Nearer starts count as one. Source: ours.
const MIN_START_DISTANCE_CELLS: f64 = 5.0;
/// Maximum score deficit of a second start against the best [nats]. A worse start is not optimised. Source: ours.
const MAX_START_DEFICIT_NATS: f64 = 2.0;
/// Radius of the ellipsoid of samples \[sigmas\]. Source: ours.
const SAMPLE_RADIUS_SIGMAS: f64 = 2.5;
/// Maximum number of points of a wide search. Larger scans are subsampled. Source: ours.
const MAX_SEARCH_POINTS: usize = 80;
/// Reach of a wide search \[sigmas\]. Source: ours.
const WIDE_SEARCH_SIGMAS: f64 = 3.0;
/// Minimum fraction of points at known obstacles \[1\]. Below it the pose follows the odometry alone. Source: ours.
const MIN_EXPLAINED: f64 = 0.1;

/// An optimum with the tiles of its search.
struct Attempt<'m> {
    window: TileWindow<'m>,
    /// The window's corner, cells of the map.
    corner: (f64, f64),
    prior: MotionPrior,
    optimum: Optimum,
    contradicted: f64,
}

impl Proposer<'_> {
    /// Fraction of a log-weight that counts for the particle.
    pub(crate) fn weight_scale(&self) -> f64 {
        1.0 / self.config.weight_correlation
    }

    /// Draws the pose of a particle that moved from `before` to `guess` by the odometry (cells, rad, of the map).
    ///
    /// There are two hypotheses. First: the odometry's error is within its covariance. Second: wheels slipped or messages were lost
    /// (`slip_rate`), and the robot is near the odometry's path. The second is tested at the poses `far`, where it would be likelier with a
    /// usual fit of the scan. `far` is the result of [`Proposer::far`] for one of the particles with almost the same past.
    pub(crate) fn propose(
        &self,
        (map, far): (&TileMap, &[Pose2]),
        search: &mut CoarseSearch,
        (before, guess): (Pose2, Pose2),
        rng: &mut ParticleRng,
    ) -> Proposal {
        let near = self.attempt(map, search, self.near(before, guess));
        let slip = self.slip(before, guess);
        let rate = self.config.slip_rate.ln();
        if !far.is_empty() && self.needed(&near, &slip).is_some() {
            let far = self.climb_far(map, slip, far.iter().map(|place| before * *place));
            if far.optimum.log_posterior + rate > near.optimum.log_posterior {
                return self.sample(&far, rate, rng);
            }
        }
        self.sample(&near, 0.0, rng)
    }

    /// Poses of a particle from `before` that are far from the odometry's pose and fit the scan, in the frame of `before`. Empty if the
    /// scan fits near the odometry, or nowhere.
    pub(crate) fn far(
        &self,
        map: &TileMap,
        search: &mut CoarseSearch,
        (before, guess): (Pose2, Pose2),
    ) -> Vec<Pose2> {
        let near = self.attempt(map, search, self.near(before, guess));
        let slip = self.slip(before, guess);
        let Some(needed) = self.needed(&near, &slip) else { return Vec::new() };
        let back = before.inverse();
        self.search_far(map, &slip, needed).into_iter().map(|place| back * place).collect()
    }

    fn optimizer(&self) -> PoseOptimizer<'_> {
        PoseOptimizer { config: self.config, likelihood: self.likelihood, points: self.points }
    }

    fn near(&self, before: Pose2, guess: Pose2) -> MotionPrior {
        let prior = MotionPrior::new(guess, before.theta, &self.motion_covariance);
        match &self.anchor {
            Some(anchor) => prior.fused(anchor.pose, &anchor.covariance),
            None => prior,
        }
    }

    fn slip(&self, before: Pose2, guess: Pose2) -> MotionPrior {
        let config = self.config;
        MotionPrior::slipped(before, guess, config.slip_shift / config.map.resolution, config.slip_turn)
    }

    /// The log-posterior (without the normalisation of the slip's prior) above which a far place is likelier; `None` if a scan with
    /// expected_log_likelihood cannot reach it.
    fn needed(&self, near: &Attempt<'_>, slip: &MotionPrior) -> Option<f64> {
        let expected_log_likelihood =
            self.expected_log_likelihood * self.points.points.len() as f64 / self.config.correlation;
        let needed = near.optimum.log_posterior - self.config.slip_rate.ln() - 0.5 * slip.log_determinant;
        (expected_log_likelihood > needed).then_some(needed)
    }

    /// The best poses under a wide prior, by branch and bound: at most two that can have the log-posterior `needed` (without the prior's
    /// normalisation).
    fn search_far(&self, map: &TileMap, prior: &MotionPrior, needed: f64) -> Vec<Pose2> {
        let window = self.window(map, prior);
        let (cols, rows) = window.size();
        let low = (window.corner.0 >> Tile::BITS, window.corner.1 >> Tile::BITS);
        let high = (low.0 + cols as i32 - 1, low.1 + rows as i32 - 1);
        let Some(pyramid) = Pyramid::of(map, low, high) else { return Vec::new() };
        let every = self.points.points.len().div_ceil(MAX_SEARCH_POINTS).max(1);
        let points: Vec<_> = self.points.points.iter().step_by(every).map(|p| (p.x, p.y)).collect();
        let sigma = |k: usize| prior.covariance[(k, k)].sqrt();
        let query = Query {
            points: &points,
            guess: prior.guess,
            reach: (WIDE_SEARCH_SIGMAS * sigma(0), WIDE_SEARCH_SIGMAS * sigma(1)),
            turn_reach: (WIDE_SEARCH_SIGMAS * sigma(2)).min(std::f64::consts::PI),
            turn_step: (2.0 / self.points.spread.lever).clamp(0.01, 0.05),
            sigma: (sigma(0), sigma(1), sigma(2)),
            gain: -self.config.outliers.ln() / self.config.correlation * every as f64,
        };
        // An outlier point scores as a point on unknown ground.
        let unseen =
            0.5 * self.config.outliers.ln() * self.points.points.len() as f64 / self.config.correlation;
        let min = (needed - unseen).max(0.0);
        let (mut places, apart) = (Vec::new(), (2.0 * MIN_START_DISTANCE_CELLS, 0.2));
        while places.len() < 2
            && let Some(place) = pyramid.search(&query, &places, (apart, min), &LookupBudget::unlimited())
        {
            places.push(place);
        }
        places.into_iter().map(|place| place.pose).collect()
    }

    /// The best local optimum near these places.
    fn climb_far<'m>(
        &self,
        map: &'m TileMap,
        prior: MotionPrior,
        places: impl Iterator<Item = Pose2>,
    ) -> Attempt<'m> {
        let window = self.window(map, &prior);
        let corner = (f64::from(window.corner.0), f64::from(window.corner.1));
        let local = |pose: Pose2| Pose2 { x: pose.x - corner.0, y: pose.y - corner.1, ..pose };
        let prior = MotionPrior { guess: local(prior.guess), ..prior };
        let optimum = places
            .map(|place| self.optimizer().optimize(&window, &prior, local(place)))
            .reduce(|best, next| if next.log_posterior > best.log_posterior { next } else { best })
            .expect("invariant: there is a place");
        self.attempted(window, corner, prior, optimum)
    }

    /// The best pose under a prior (cells of the map).
    fn attempt<'m>(&self, map: &'m TileMap, search: &mut CoarseSearch, prior: MotionPrior) -> Attempt<'m> {
        let window = self.window(map, &prior);
        let corner = (f64::from(window.corner.0), f64::from(window.corner.1));
        let guess = Pose2 { x: prior.guess.x - corner.0, y: prior.guess.y - corner.1, ..prior.guess };
        let prior = MotionPrior { guess, ..prior };
        let optimum = self.optimum(&window, search, &prior);
        self.attempted(window, corner, prior, optimum)
    }

    fn attempted<'m>(
        &self,
        window: TileWindow<'m>,
        corner: (f64, f64),
        prior: MotionPrior,
        optimum: Optimum,
    ) -> Attempt<'m> {
        let contradicted = optimum.equations.contradicted / self.points.points.len().max(1) as f64;
        Attempt { window, corner, prior, optimum, contradicted }
    }

    /// The tiles that the scan can reach under a prior.
    fn window<'m>(&self, map: &'m TileMap, prior: &MotionPrior) -> TileWindow<'m> {
        let guess = prior.guess;
        let (mut low, mut high) = ((guess.x, guess.y), (guess.x, guess.y));
        let turns = prior.covariance[(2, 2)] > 0.1;
        let (s, c) = guess.theta.sin_cos();
        for p in &self.points.points {
            let (px, py) = (f64::from(p.x), f64::from(p.y));
            let (dx, dy) = (c * px - s * py, s * px + c * py);
            let far = px.hypotenuse(py);
            let (right, up) = if turns { (far, far) } else { (dx, dy) };
            let (left, down) = if turns { (-far, -far) } else { (dx, dy) };
            low = (low.0.min(guess.x + left), low.1.min(guess.y + down));
            high = (high.0.max(guess.x + right), high.1.max(guess.y + up));
        }
        const MARGIN: f64 = 16.0;
        let cell = |v: f64| v.floor() as i32;
        TileWindow::new(
            map,
            (cell(low.0 - MARGIN), cell(low.1 - MARGIN)),
            (cell(high.0 + MARGIN), cell(high.1 + MARGIN)),
        )
    }

    fn optimum(&self, window: &TileWindow<'_>, search: &mut CoarseSearch, prior: &MotionPrior) -> Optimum {
        let about = SearchPrior {
            information: prior.information,
            sigma: prior.covariance[(0, 0)].max(prior.covariance[(1, 1)]).sqrt(),
            sigma_turn: prior.covariance[(2, 2)].sqrt(),
            gain: -self.config.outliers.ln() / self.config.correlation,
        };
        let starts = search.search(window, self.points, prior.guess, (&about, MAX_START_DEFICIT_NATS));
        let (first, top) = starts[0];
        // Another start is used when its likelihood is nearly as high and its pose is different.
        let elsewhere = |p: &Pose2| {
            let off = difference(*p, top);
            off.xy().amax() > MIN_START_DISTANCE_CELLS
                || off.z.abs() * self.points.spread.lever > MIN_START_DISTANCE_CELLS
        };
        let second = starts
            .iter()
            .find(|(score, p)| first - score < MAX_START_DEFICIT_NATS && elsewhere(p))
            .map(|s| s.1);
        let best = self.optimizer().optimize(window, prior, top);
        let rival = second.map(|start| self.optimizer().optimize(window, prior, start));
        match rival {
            Some(rival) if rival.log_posterior > best.log_posterior => rival,
            _ => best,
        }
    }

    fn sample(&self, attempt: &Attempt<'_>, log_rate: f64, rng: &mut ParticleRng) -> Proposal {
        let Attempt { window, corner, prior, optimum, .. } = attempt;
        let Optimum { pose: top, equations, directions, .. } = optimum;
        let explained = equations.normal.explained / self.points.points.len().max(1) as f64;
        let lost = explained < MIN_EXPLAINED;
        let held = if lost { Matrix3::zeros() } else { directions.held };
        let centre = if lost { prior.guess } else { *top };
        let odometry = directions.in_y(&prior.information);
        let hits =
            if lost { Matrix3::zeros() } else { directions.information(equations) / self.config.correlation };
        let shape =
            Cholesky::new(hits + odometry).expect("invariant: the odometry's information is positive");
        // Columns of `spread` are one sigma long.
        let spread = shape.inverse().cholesky().expect("invariant: the inverse of a positive matrix").l();
        let moved = |y: Vector3<f64>| {
            let x = directions.pose_from_y * y;
            Pose2 { x: centre.x + x.x, y: centre.y + x.y, theta: centre.theta + x.z }
        };

        let optimizer = self.optimizer();
        let mut samples = [(0.0, Vector3::zeros()); MAX_SAMPLES];
        let count = self.config.samples.min(MAX_SAMPLES);
        let mut greatest = f64::NEG_INFINITY;
        for pair in samples[..count].chunks_mut(2) {
            let y = spread * rng.in_ball() * SAMPLE_RADIUS_SIGMAS;
            for (sample, y) in pair.iter_mut().zip([y, -y]) {
                *sample = (optimizer.log_posterior(window, prior, moved(y)), y);
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
        // Directions without information keep the odometry, independent of the samples.
        let free = Matrix3::identity() - held;
        let mean = held * mean;
        let odometry_covariance =
            odometry.try_inverse().expect("invariant: the odometry's covariance exists");
        let covariance = held * covariance * held + free * odometry_covariance * free;
        let min = shape.inverse() * MIN_COVARIANCE_FRACTION;
        let covariance = covariance + min;
        let draw = Cholesky::new(covariance).expect("invariant: a sum with a positive matrix").l();
        let to_pose = directions.pose_from_y;
        let pose = moved(mean + draw * rng.normal3());
        Proposal {
            pose: Pose2::new(pose.x + corner.0, pose.y + corner.1, pose.theta),
            log_weight: log_rate + greatest + (sum / count as f64).ln() + spread.determinant().ln(),
            explained,
            contradicted: attempt.contradicted,
            per_point: self.likelihood.log_likelihood(window, self.points, *top)
                / self.points.points.len().max(1) as f64,
            slipped: log_rate < 0.0,
            degenerate: if lost { 3 } else { directions.degenerate },
            covariance: to_pose * covariance * to_pose.transpose(),
            innovation: self.innovation(attempt).filter(|_| !lost && log_rate == 0.0),
        }
    }

    /// Estimate of the odometry's step by the hits alone. At the optimum x of hits (information H) and odometry (P, at g) the gradients
    /// cancel: H (m - x) = P (x - g) gives the hits' own optimum m.
    fn innovation(&self, attempt: &Attempt<'_>) -> Option<Innovation> {
        let Attempt { prior, optimum, .. } = attempt;
        if optimum.directions.degenerate > 0 {
            return None;
        }
        let hits = (optimum.equations.normal.information / self.config.correlation).try_inverse()?;
        let off = difference(optimum.pose, prior.guess);
        let off = off + hits * (prior.information * off);
        let (s, c) = prior.guess.theta.sin_cos();
        let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
        let open = (turn * hits * turn.transpose()).diagonal();
        Some(Innovation { off: turn * off, open })
    }
}

/// Maximum number of samples. Source: range of `samples`.
const MAX_SAMPLES: usize = 500;
/// Minimum covariance of the drawn Gaussian, as a fraction of the Laplace covariance \[1\]. A covariance from few samples
/// may be singular. Source: ours.
const MIN_COVARIANCE_FRACTION: f64 = 0.05;
