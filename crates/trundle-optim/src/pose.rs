//! One camera pose against known points.

use crate::leverage::bounded;
use crate::observation::{PointObservation, camera_point_by_pose, robust_cost};
use crate::pose_prior::{Hold, PosePrior};
use nalgebra::{Matrix3x6, Matrix6, Vector6};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PinholeCamera, Pose3, Vector3, require_positive};

/// Iteration of [`PoseProblem`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PoseConfig {
    /// Number of rounds of optimisation and classification of inliers, 1 or more. Default 4 \[MurArtal17\].
    pub rounds: usize,
    /// Maximum number of steps per round, 1 or more. Default 10 \[MurArtal17\].
    pub steps: usize,
    /// Step length (m and rad) below which a round has converged, above 0. Default 1e-6: far below the resolution of pixels.
    pub converged: f64,
}

impl Default for PoseConfig {
    fn default() -> Self {
        Self { rounds: 4, steps: 10, converged: 1e-6 }
    }
}

impl PoseConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a count is zero or `converged` is not positive.
    pub fn validated(self) -> Result<Self, Invalid> {
        for (name, value) in [("pose.rounds", self.rounds), ("pose.steps", self.steps)] {
            if value == 0 {
                return Err(Invalid::new(name, value, "", "1 or more"));
            }
        }
        require_positive("pose.converged", self.converged, "")?;
        Ok(self)
    }
}

/// Number of points of one image whose errors are the same in the worst case: 8. A comparison with a prior multiplies the covariance of a
/// pose by this number; [`PoseSolution`] itself assumes independent errors. Source: docs/algorithms/slam.md.
pub const CORRELATED_POINTS: f64 = 8.0;

/// One camera pose against points that count as exact: motion-only bundle adjustment \[MurArtal17\].
///
/// Levenberg-Marquardt on the Huber loss. After each round every observation is classified by its chi-square, and the
/// next round runs over the inliers. Cost: linear in the observations, some microseconds each.
#[derive(Debug, Clone, Copy)]
pub struct PoseProblem<'a> {
    /// The camera; its distortion is not used, pixels are rectified.
    pub camera: &'a PinholeCamera,
    /// Points (world, m) with their measurements in the image.
    pub observations: &'a [(Vector3, PointObservation)],
    /// A prior of the pose, for example by wheels; fused with the solution of the points if both agree.
    pub prior: Option<PosePrior>,
    /// Whether the influence of single points is bounded, for matches without a prediction: see [`PoseProblem::solve`].
    pub bounded: bool,
}

/// Result of [`PoseProblem::solve`].
#[derive(Debug, Clone, PartialEq)]
pub struct PoseSolution {
    /// The refined pose.
    pub world_from_camera: Pose3,
    /// Whether observation i agrees at 95 % with the pose that the image alone gives.
    pub inliers: Vec<bool>,
    /// Number of inliers.
    pub inlier_count: usize,
    /// Whether a prior was given that contradicts the points.
    pub contradicts_prior: bool,
    /// Number of observations that agree with each other on another pose, which contradicts the prior: those of a thing that moves.
    pub moving: usize,
    /// Covariance of the pose as a right perturbation (m, rad), scaled up where residuals are larger than their sigmas promise; `None`
    /// when the inliers do not determine the pose.
    pub covariance: Option<Matrix6<f64>>,
}

impl PoseProblem<'_> {
    /// Rounds of optimising and re-classifying.
    pub(crate) fn by_image(&self, start: Pose3, config: &PoseConfig) -> PoseSolution {
        let mut inliers = vec![true; self.observations.len()];
        let pose = self.rounds(start, &mut inliers, None, config);
        self.summarise(pose, inliers)
    }

    /// The pose after rounds that begin with these inliers; `held` counts as a measurement.
    pub(crate) fn rounds(
        &self,
        start: Pose3,
        inliers: &mut [bool],
        held: Option<&Hold>,
        config: &PoseConfig,
    ) -> Pose3 {
        let mut pose = start;
        for _ in 0..config.rounds {
            let weights = self.weights(pose, inliers);
            pose = self.optimise(pose, &weights, held, config);
            if !self.classify(pose, inliers) {
                break;
            }
        }
        pose
    }

    /// Weight of each observation: 0 for an outlier.
    pub(crate) fn weights(&self, pose: Pose3, inliers: &[bool]) -> Vec<f64> {
        let mut weights: Vec<f64> = inliers.iter().map(|inlier| f64::from(u8::from(*inlier))).collect();
        if self.bounded {
            let shares = bounded(&self.rows(pose, &weights));
            weights.iter_mut().zip(shares).for_each(|(weight, share)| *weight *= share);
        }
        weights
    }

    /// The Jacobian of each observation's residual by the pose, in standard deviations; zero if it does not count.
    fn rows(&self, pose: Pose3, weights: &[f64]) -> Vec<Matrix3x6<f64>> {
        let camera_from_world = pose.inverse();
        let row = |((point, seen), weight): (&(Vector3, PointObservation), &f64)| {
            let p_camera = camera_from_world.transform(*point);
            let linear = seen.linearize(self.camera, p_camera)?;
            let weight = weight * seen.huber().weight(linear.residual.norm_squared());
            Some(linear.by_point * camera_point_by_pose(p_camera) * weight.sqrt())
        };
        self.observations.iter().zip(weights).map(|seen| row(seen).unwrap_or_default()).collect()
    }

    /// Levenberg-Marquardt over what counts.
    pub(crate) fn optimise(
        &self,
        start: Pose3,
        weights: &[f64],
        held: Option<&Hold>,
        config: &PoseConfig,
    ) -> Pose3 {
        let mut pose = start;
        let full_cost = |pose| self.cost(pose, weights) + held.map_or(0.0, |held| held.cost(pose));
        let mut cost = full_cost(pose);
        let mut damping = 1e-6;
        for _ in 0..config.steps {
            let (mut hessian, mut gradient) = self.normal_equations(pose, weights);
            if let Some(held) = held {
                hessian += held.information;
                gradient += held.information * held.offset(pose);
            }
            let damped = hessian + Matrix6::from_diagonal(&(hessian.diagonal().add_scalar(1e-9) * damping));
            let Some(cholesky) = damped.cholesky() else { break };
            let step = -cholesky.solve(&gradient);
            let candidate = (pose * Pose3::exp(step)).renormalized();
            let candidate_cost = full_cost(candidate);
            if candidate_cost < cost {
                (pose, cost) = (candidate, candidate_cost);
                damping = (damping * 0.1).max(1e-9);
            } else {
                damping = (damping * 100.0).max(1e-3);
            }
            if step.norm() < config.converged {
                break;
            }
        }
        pose
    }

    /// Classifies every observation. Returns whether any class changed.
    pub(crate) fn classify(&self, pose: Pose3, inliers: &mut [bool]) -> bool {
        let camera_from_world = pose.inverse();
        let mut changed = false;
        for ((point, seen), inlier) in self.observations.iter().zip(inliers) {
            let agrees = seen.chi2(self.camera, camera_from_world.transform(*point)) <= seen.chi2_bound();
            changed |= agrees != *inlier;
            *inlier = agrees;
        }
        changed
    }

    fn cost(&self, pose: Pose3, weights: &[f64]) -> f64 {
        let camera_from_world = pose.inverse();
        let cost =
            |(point, seen): &(_, _)| robust_cost(self.camera, seen, camera_from_world.transform(*point));
        self.counting(weights).map(|(seen, weight)| weight * cost(seen)).sum()
    }

    fn counting<'s>(
        &'s self,
        weights: &'s [f64],
    ) -> impl Iterator<Item = (&'s (Vector3, PointObservation), f64)> {
        self.observations.iter().zip(weights.iter().copied()).filter(|(_, weight)| *weight > 0.0)
    }

    /// J'WJ and J'Wr at `pose`.
    fn normal_equations(&self, pose: Pose3, weights: &[f64]) -> (Matrix6<f64>, Vector6<f64>) {
        let camera_from_world = pose.inverse();
        let (mut hessian, mut gradient) = (Matrix6::zeros(), Vector6::zeros());
        for ((point, seen), counts) in self.counting(weights) {
            let p_camera = camera_from_world.transform(*point);
            let Some(linear) = seen.linearize(self.camera, p_camera) else { continue };
            let weight = counts * seen.huber().weight(linear.residual.norm_squared());
            let jacobian = linear.by_point * camera_point_by_pose(p_camera);
            let weighted = jacobian.transpose() * weight;
            hessian += weighted * jacobian;
            gradient += weighted * linear.residual;
        }
        (hessian, gradient)
    }

    pub(crate) fn summarise(&self, pose: Pose3, inliers: Vec<bool>) -> PoseSolution {
        let weights = self.weights(pose, &inliers);
        let (information, _) = self.normal_equations(pose, &weights);
        let camera_from_world = pose.inverse();
        let (mut chi2, mut freedoms) = (0.0, -6.0);
        for ((point, seen), _) in self.counting(&weights) {
            chi2 += seen.chi2(self.camera, camera_from_world.transform(*point));
            freedoms += if seen.depth.is_some() { 3.0 } else { 2.0 };
        }
        let variance_factor = if freedoms > 0.0 { chi2 / freedoms } else { 1.0 };
        PoseSolution {
            world_from_camera: pose,
            inlier_count: inliers.iter().filter(|inlier| **inlier).count(),
            inliers,
            contradicts_prior: false,
            moving: 0,
            covariance: inverse(information).map(|inverse| inverse * variance_factor.max(1.0)),
        }
    }
}

fn inverse(information: Matrix6<f64>) -> Option<Matrix6<f64>> {
    let inverse = information.cholesky()?.inverse();
    inverse.iter().all(|v| v.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InverseDepth;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use trundle_core::{Distortion, Vector2};

    fn camera() -> PinholeCamera {
        PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), Distortion::default()).unwrap()
    }

    fn noise(rng: &mut ChaCha8Rng) -> f64 {
        (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
    }

    /// Points in a camera at `truth`, with `sigma` standard deviations of noise.
    fn scene(truth: Pose3, count: usize, sigma: f64, seed: u64) -> Vec<(Vector3, PointObservation)> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let camera = camera();
        let see = |i: usize| {
            let at = Vector2::new(rng.random_range(0.0..640.0), rng.random_range(0.0..480.0));
            let z = rng.random_range(0.6..5.0);
            let point = truth.transform(camera.unproject(at, z));
            let pixel = at + Vector2::new(noise(&mut rng), noise(&mut rng)) * sigma;
            let depth = InverseDepth { value: 1.0 / z + 0.003 * sigma * noise(&mut rng), sigma: 0.003 };
            (
                point,
                PointObservation { pixel, pixel_sigma: 1.0, depth: (!i.is_multiple_of(3)).then_some(depth) },
            )
        };
        (0..count).map(see).collect()
    }

    fn truth() -> Pose3 {
        Pose3::exp(Vector6::new(0.4, -0.2, 1.1, 0.3, -0.5, 0.2))
    }

    fn start() -> Pose3 {
        truth() * Pose3::exp(Vector6::new(0.08, -0.05, 0.06, 0.05, -0.06, 0.04))
    }

    fn gap(a: Pose3, b: Pose3) -> f64 {
        (a.inverse() * b).log().norm()
    }

    #[test]
    fn a_perturbed_pose_comes_back_exactly() {
        let observations = scene(truth(), 60, 0.0, 1);
        let problem =
            PoseProblem { camera: &camera(), observations: &observations, prior: None, bounded: false };
        let solution = problem.solve(start(), &PoseConfig::default());
        assert!(gap(solution.world_from_camera, truth()) < 1e-8);
        assert_eq!(solution.inlier_count, 60);
    }

    #[test]
    fn outliers_do_not_pull() {
        let mut observations = scene(truth(), 200, 0.0, 2);
        for (i, (_, seen)) in observations.iter_mut().enumerate().filter(|(i, _)| i % 3 == 0) {
            seen.pixel += Vector2::new(15.0 + i as f64, -12.0);
        }
        let problem =
            PoseProblem { camera: &camera(), observations: &observations, prior: None, bounded: false };
        let solution = problem.solve(start(), &PoseConfig::default());
        assert!(gap(solution.world_from_camera, truth()) < 1e-7);
        for (i, inlier) in solution.inliers.iter().enumerate() {
            assert_eq!(*inlier, i % 3 != 0, "observation {i}");
        }
    }

    /// Known to 1 mm and 1 mrad.
    fn known(world_from_camera: Pose3) -> PosePrior {
        PosePrior { world_from_camera, covariance: Matrix6::identity() * 1e-6 }
    }

    #[test]
    fn a_prior_compensates_for_a_poor_image() {
        let error = |prior: Option<PosePrior>| {
            let off = |seed| {
                let observations = scene(truth(), 12, 1.0, seed);
                let problem =
                    PoseProblem { camera: &camera(), observations: &observations, prior, bounded: false };
                gap(problem.solve(start(), &PoseConfig::default()).world_from_camera, truth())
            };
            (0..20).map(off).sum::<f64>()
        };
        assert!(error(Some(known(truth()))) < 0.5 * error(None));
    }

    #[test]
    fn a_prior_that_contradicts_the_image_is_ignored() {
        let observations = scene(truth(), 150, 1.0, 5);
        let solve = |prior| {
            PoseProblem { camera: &camera(), observations: &observations, prior, bounded: false }
                .solve(start(), &PoseConfig::default())
        };
        let slipped = truth() * Pose3::exp(Vector6::new(0.1, 0.0, 0.05, 0.0, 0.05, 0.0));
        assert!(solve(Some(known(slipped))).contradicts_prior);
        assert!(gap(solve(Some(known(slipped))).world_from_camera, solve(None).world_from_camera) < 1e-5);
    }

    #[test]
    fn the_prior_outweighs_a_thing_that_moves_but_not_the_whole_image() {
        // Many points in two fifths of the image, as on a poster that is carried past a plain wall.
        let mut observations = scene(truth(), 400, 1.0, 7);
        let thing = Pose3::exp(Vector6::new(0.3, 0.1, 0.0, 0.0, 0.0, 0.1));
        let is_on_it = |i: usize, seen: &PointObservation| (seen.pixel.x - 320.0).abs() < 128.0 && i > 0;
        observations = observations
            .into_iter()
            .enumerate()
            .filter(|(i, (_, seen))| is_on_it(*i, seen) || i.is_multiple_of(6))
            .map(|(i, (point, seen))| (if is_on_it(i, &seen) { thing.transform(point) } else { point }, seen))
            .collect();
        let still = |prior| {
            PoseProblem { camera: &camera(), observations: &observations, prior, bounded: false }
                .solve(start(), &PoseConfig::default())
        };
        assert!(gap(still(None).world_from_camera, truth()) > 0.1, "the thing has more points");
        let held = still(Some(known(truth())));
        assert!(!held.contradicts_prior && gap(held.world_from_camera, truth()) < 0.01);
        assert!(held.moving > held.inlier_count, "{} of {}", held.moving, held.inlier_count);
    }

    #[test]
    fn a_wrong_near_point_does_not_determine_the_pose() {
        let off = |seed| {
            let mut observations = scene(truth(), 80, 1.0, seed);
            for (i, (point, seen)) in observations.iter_mut().enumerate() {
                let p_camera = truth().inverse().transform(*point);
                // All points are outside the depth camera's range, except three whose map positions are wrong by 8 cm.
                let (range, aside) = if i < 3 { (0.1 + 0.03 * i as f64, 0.08) } else { (8.0, 0.0) };
                let p_camera = p_camera * range / p_camera.z + Vector3::x() * aside;
                (*point, seen.depth) = (truth().transform(p_camera), None);
            }
            let problem =
                PoseProblem { camera: &camera(), observations: &observations, prior: None, bounded: true };
            let beside = truth() * Pose3::exp(Vector6::new(0.08, 0.0, 0.0, 0.0, -0.01, 0.0));
            let solution = problem.solve(beside, &PoseConfig::default());
            assert_eq!(solution.inliers[..3], [false; 3], "seed {seed}");
            (truth().inverse() * solution.world_from_camera).translation.norm()
        };
        let mean = (0..10).map(off).sum::<f64>() / 10.0;
        assert!(mean < 0.04, "{mean} m off, 0.08 where the three decide");
    }

    #[test]
    fn the_covariance_is_consistent() {
        let (mut nees, runs) = (0.0, 60);
        for seed in 0..runs {
            let observations = scene(truth(), 150, 1.0, seed);
            let problem =
                PoseProblem { camera: &camera(), observations: &observations, prior: None, bounded: false };
            let solution = problem.solve(start(), &PoseConfig::default());
            let error = (truth().inverse() * solution.world_from_camera).log();
            nees += (error.transpose() * solution.covariance.unwrap().try_inverse().unwrap() * error)[0];
        }
        let mean = nees / runs as f64;
        assert!((4.5..9.0).contains(&mean), "normalised squared error {mean}, expected about 6");
    }

    #[test]
    fn nothing_seen_changes_nothing() {
        let solution = PoseProblem { camera: &camera(), observations: &[], prior: None, bounded: false }
            .solve(start(), &PoseConfig::default());
        assert_eq!(solution.world_from_camera, start());
        assert_eq!(solution.covariance, None);
        assert!(PoseConfig { rounds: 0, ..PoseConfig::default() }.validated().is_err());
    }
}
