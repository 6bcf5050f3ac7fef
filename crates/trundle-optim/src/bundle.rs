use crate::bundle_system::{Normal, Step};
use crate::observation::{PointObservation, robust_cost};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PinholeCamera, Pose3, Vector3, require_positive};

/// How [`BundleProblem`] iterates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BundleConfig {
    /// Steps at most, 1 or more. Default 10.
    pub steps: usize,
    /// A relative decrease of the cost below this ends it. Default 1e-4: a local map is refined again soon.
    pub converged: f64,
    /// Levenberg-Marquardt damping at the start, relative to the diagonal, above 0. Default 1e-4.
    pub damping: f64,
}

impl Default for BundleConfig {
    fn default() -> Self {
        Self { steps: 10, converged: 1e-4, damping: 1e-4 }
    }
}

impl BundleConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When `steps` is zero or another number is not positive.
    pub fn validated(self) -> Result<Self, Invalid> {
        if self.steps == 0 {
            return Err(Invalid::new("bundle.steps", self.steps, "", "1 or more"));
        }
        require_positive("bundle.converged", self.converged, "")?;
        require_positive("bundle.damping", self.damping, "")?;
        Ok(self)
    }
}

/// A camera pose of a [`BundleProblem`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BundlePose {
    /// Where the camera is.
    pub world_from_camera: Pose3,
    /// Whether it must not move. Without any fixed pose the whole scene may drift along the gauge.
    pub fixed: bool,
}

/// Which pose saw which point, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BundleObservation {
    /// Index of the pose.
    pub pose: usize,
    /// Index of the point.
    pub point: usize,
    /// What it saw.
    pub seen: PointObservation,
}

/// Poses and points refined together: bundle adjustment by the Schur complement (Triggs et al. 2000).
///
/// Levenberg-Marquardt on the Huber loss. The points are eliminated, 3 x 3 each; the reduced camera system is dense, so
/// a step costs O(poses^3 + sum over points of (poses that see it)^2): meant for some tens of free poses.
#[derive(Debug, Clone)]
pub struct BundleProblem {
    camera: PinholeCamera,
    pub(crate) poses: Vec<BundlePose>,
    pub(crate) points: Vec<Vector3>,
    /// By rising point; equal points in the order given.
    pub(crate) observations: Vec<BundleObservation>,
    /// Where sorted observation i stood.
    order: Vec<usize>,
}

/// What [`BundleProblem::solve`] finds.
#[derive(Debug, Clone, PartialEq)]
pub struct BundleSolution {
    /// `world_from_camera` of every pose, fixed ones as they were.
    pub poses: Vec<Pose3>,
    /// Every point, world frame, m.
    pub points: Vec<Vector3>,
    /// Squared residual of every observation, in the order given; infinite behind a camera.
    pub chi2: Vec<f64>,
    /// Robust cost before.
    pub initial_cost: f64,
    /// Robust cost after.
    pub final_cost: f64,
    /// Steps tried.
    pub steps: usize,
}

impl BundleProblem {
    /// A problem over `poses`, `points` (world, m) and what was seen; pixels are rectified.
    ///
    /// # Errors
    /// When an observation names a pose or point that is not there.
    pub fn new(
        camera: PinholeCamera,
        poses: Vec<BundlePose>,
        points: Vec<Vector3>,
        observations: Vec<BundleObservation>,
    ) -> Result<Self, Invalid> {
        for seen in &observations {
            if seen.pose >= poses.len() || seen.point >= points.len() {
                let value = format!("pose {}, point {}", seen.pose, seen.point);
                let expected = format!("less than {} and {}", poses.len(), points.len());
                return Err(Invalid::new("observation", value, "", expected));
            }
        }
        let mut order: Vec<usize> = (0..observations.len()).collect();
        order.sort_by_key(|&i| observations[i].point);
        let observations = order.iter().map(|&i| observations[i]).collect();
        Ok(Self { camera, poses, points, observations, order })
    }

    /// Refines the free poses and all points.
    pub fn solve(mut self, config: &BundleConfig) -> BundleSolution {
        let initial_cost = self.cost(&self.poses, &self.points);
        let (mut cost, mut damping, mut steps) = (initial_cost, config.damping, 0);
        let mut normal = Normal::default();
        let mut fresh = false;
        while steps < config.steps {
            steps += 1;
            if !fresh {
                normal.build(&self, &self.camera);
                fresh = true;
            }
            let Some(step) = normal.solve(damping) else {
                damping *= 10.0;
                continue;
            };
            let (poses, points) = self.moved(&step);
            let moved_cost = self.cost(&poses, &points);
            if moved_cost > cost {
                damping *= 10.0;
                continue;
            }
            let gain = cost - moved_cost;
            (self.poses, self.points, cost) = (poses, points, moved_cost);
            (damping, fresh) = ((damping * 0.1).max(1e-9), false);
            if gain <= config.converged * cost {
                break;
            }
        }
        let chi2 = self.chi2();
        let poses = self.poses.iter().map(|p| p.world_from_camera).collect();
        BundleSolution { poses, points: self.points, chi2, initial_cost, final_cost: cost, steps }
    }

    fn moved(&self, step: &Step) -> (Vec<BundlePose>, Vec<Vector3>) {
        let mut free = step.poses.iter();
        let pose = |pose: &BundlePose| match pose.fixed {
            true => *pose,
            false => {
                let xi = free.next().expect("invariant: one step for each free pose");
                let world_from_camera = (pose.world_from_camera * Pose3::exp(*xi)).renormalized();
                BundlePose { world_from_camera, fixed: false }
            }
        };
        let poses = self.poses.iter().map(pose).collect();
        (poses, self.points.iter().zip(&step.points).map(|(p, d)| p + d).collect())
    }

    fn cost(&self, poses: &[BundlePose], points: &[Vector3]) -> f64 {
        let inverses: Vec<Pose3> = poses.iter().map(|p| p.world_from_camera.inverse()).collect();
        let cost = |o: &BundleObservation| {
            robust_cost(&self.camera, &o.seen, inverses[o.pose].transform(points[o.point]))
        };
        self.observations.iter().map(cost).sum()
    }

    fn chi2(&self) -> Vec<f64> {
        let mut chi2 = vec![0.0; self.observations.len()];
        for (o, &given) in self.observations.iter().zip(&self.order) {
            let p_camera = self.poses[o.pose].world_from_camera.inverse().transform(self.points[o.point]);
            chi2[given] = o.seen.chi2(&self.camera, p_camera);
        }
        chi2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InverseDepth;
    use nalgebra::Vector6;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use trundle_core::{Distortion, Vector2};

    const EXACT: BundleConfig = BundleConfig { steps: 30, converged: 1e-12, damping: 1e-4 };

    struct Scene {
        camera: PinholeCamera,
        poses: Vec<Pose3>,
        points: Vec<Vector3>,
        observations: Vec<BundleObservation>,
    }

    /// Six cameras on an arc around 80 points, every second observation with a depth.
    fn scene() -> Scene {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let camera =
            PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), Distortion::default()).unwrap();
        let pose =
            |i: usize| Pose3::exp(Vector6::new(0.15 * i as f64, 0.02, -0.1, 0.02, -0.06 * i as f64, 0.0));
        let poses: Vec<Pose3> = (0..6).map(pose).collect();
        let mut coordinate = |a: f64, b: f64| rng.random_range(a..b);
        let points: Vec<Vector3> = (0..80)
            .map(|_| Vector3::new(coordinate(-1.0, 1.5), coordinate(-0.8, 0.8), coordinate(1.5, 4.0)))
            .collect();
        let mut observations = Vec::new();
        for (i, pose) in poses.iter().enumerate() {
            for (j, point) in points.iter().enumerate() {
                let p = pose.inverse().transform(*point);
                let Some(pixel) = camera.project(p).filter(|px| camera.contains(*px)) else { continue };
                let depth = (j % 2 == 0).then_some(InverseDepth { value: 1.0 / p.z, sigma: 0.003 });
                let seen = PointObservation { pixel, pixel_sigma: 1.0, depth };
                observations.push(BundleObservation { pose: i, point: j, seen });
            }
        }
        Scene { camera, poses, points, observations }
    }

    fn perturbed(scene: &Scene, fixed: usize) -> BundleProblem {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let mut shake = |scale: f64| rng.random_range(-scale..scale);
        let pose = |(i, pose): (usize, &Pose3)| {
            let xi = Vector6::from_fn(|r, _| shake(if r < 3 { 0.05 } else { 0.03 }));
            let off = if i < fixed { Pose3::identity() } else { Pose3::exp(xi) };
            BundlePose { world_from_camera: *pose * off, fixed: i < fixed }
        };
        let poses = scene.poses.iter().enumerate().map(pose).collect();
        let points =
            scene.points.iter().map(|p| p + Vector3::new(shake(0.08), shake(0.08), shake(0.08))).collect();
        BundleProblem::new(scene.camera, poses, points, scene.observations.clone()).unwrap()
    }

    fn assert_recovered(scene: &Scene, solution: &BundleSolution, tolerance: f64) {
        for (found, truth) in solution.poses.iter().zip(&scene.poses) {
            assert!((found.inverse() * *truth).log().norm() < tolerance);
        }
        for (found, truth) in solution.points.iter().zip(&scene.points) {
            assert!((found - truth).norm() < tolerance);
        }
    }

    #[test]
    fn a_perturbed_scene_comes_back() {
        let scene = scene();
        let solution = perturbed(&scene, 1).solve(&EXACT);
        assert!(solution.initial_cost > 1e3 && solution.final_cost < 1e-9, "{}", solution.final_cost);
        assert_recovered(&scene, &solution, 1e-6);
    }

    #[test]
    fn fixed_poses_do_not_move_and_the_same_input_gives_the_same_bits() {
        let scene = scene();
        let problem = perturbed(&scene, 2);
        let solution = problem.clone().solve(&BundleConfig::default());
        assert_eq!(solution.poses[..2], scene.poses[..2]);
        assert_eq!(solution, problem.solve(&BundleConfig::default()));
    }

    #[test]
    fn outliers_do_not_pull_and_are_told_by_their_chi2() {
        let mut scene = scene();
        let wrong: Vec<usize> = (0..scene.observations.len()).filter(|i| i % 29 == 5).collect();
        for &i in &wrong {
            scene.observations[i].seen.pixel += Vector2::new(90.0, -70.0);
        }
        let solution = perturbed(&scene, 2).solve(&EXACT);
        for (i, chi2) in solution.chi2.iter().enumerate() {
            let bound = scene.observations[i].seen.chi2_bound();
            assert_eq!(*chi2 > bound, wrong.contains(&i), "observation {i}: {chi2}");
        }
        for (found, truth) in solution.poses.iter().zip(&scene.poses) {
            assert!((found.inverse() * *truth).log().norm() < 5e-3);
        }
    }

    #[test]
    fn a_point_that_nothing_determines_stays_finite() {
        let scene = scene();
        let mut problem = perturbed(&scene, 1);
        problem.points.push(Vector3::new(0.0, 0.0, 2.0));
        let solution = problem.solve(&BundleConfig::default());
        assert_eq!(solution.points.last(), Some(&Vector3::new(0.0, 0.0, 2.0)));
        assert!(solution.points.iter().all(|p| p.norm().is_finite()));
    }

    #[test]
    fn an_observation_of_nothing_is_refused() {
        let mut scene = scene();
        scene.observations[3].point = 80;
        let pose = BundlePose { world_from_camera: Pose3::identity(), fixed: true };
        let error =
            BundleProblem::new(scene.camera, vec![pose; 6], scene.points, scene.observations).unwrap_err();
        assert!(error.to_string().contains("point 80"), "{error}");
    }
}
