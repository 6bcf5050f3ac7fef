//! A bundle problem: poses, points and observations.

use crate::observation::PointObservation;
use crate::pose_graph::PoseConstraint;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PinholeCamera, Pose3, Vector3, require_positive};

/// Iteration of [`BundleProblem`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct BundleConfig {
    /// Maximum number of steps of one bundle adjustment, 1 or more. Default 10; in `slam.mapping.bundle` 5 (ours).
    pub steps: usize,
    /// Relative decrease of the cost below which the adjustment has converged, above 0. Default 1e-4: a local map is refined again soon.
    pub converged: f64,
    /// Levenberg-Marquardt damping at the start, relative to the diagonal, above 0. Default 1e-4 (ours).
    pub damping: f64,
    /// Whether the covariances of the poses are computed at the end, at the cost of one or two steps. Default false (ours): only
    /// an adjustment of the whole map needs them.
    pub covariances: bool,
}

impl Default for BundleConfig {
    fn default() -> Self {
        Self { steps: 10, converged: 1e-4, damping: 1e-4, covariances: false }
    }
}

impl BundleConfig {
    /// Returns a valid configuration unchanged.
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
    /// Pose of the camera.
    pub world_from_camera: Pose3,
    /// Whether the pose is constant. Without any fixed pose the whole scene may drift along the gauge.
    pub fixed: bool,
}

/// Observation of a point from a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BundleObservation {
    /// Index of the pose.
    pub pose: usize,
    /// Index of the point.
    pub point: usize,
    /// The measurement.
    pub seen: PointObservation,
}

/// Poses and points to be refined together; `BundleSolver` does it.
#[derive(Debug, Clone)]
pub struct BundleProblem {
    pub(crate) camera: PinholeCamera,
    pub(crate) poses: Vec<BundlePose>,
    pub(crate) points: Vec<Vector3>,
    pub(crate) observations: Vec<BundleObservation>,
    pub(crate) constraints: Vec<PoseConstraint>,
    /// Empty if all poses are of one part.
    pub(crate) parts: Vec<usize>,
}

/// Result of [`BundleProblem::solve`].
#[derive(Debug, Clone, PartialEq)]
pub struct BundleSolution {
    /// `world_from_camera` of every pose; fixed ones are unchanged.
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
    /// A problem over `poses`, `points` (world, m) and their observations; pixels are rectified.
    ///
    /// # Errors
    /// When an observation refers to a pose or point that does not exist.
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
        Ok(Self { camera, poses, points, observations, constraints: Vec::new(), parts: Vec::new() })
    }

    /// This problem with further measurements between poses, for example by wheels or of the floor. Each has the Huber loss as a whole,
    /// with the bound at 95 %: a wrong constraint, for example by slip, has at most the influence of one at the bound.
    ///
    /// # Errors
    /// When a constraint refers to a pose that does not exist, connects a pose to itself, or has a number that is not finite.
    pub fn with_constraints(self, constraints: Vec<PoseConstraint>) -> Result<Self, Invalid> {
        for (i, constraint) in constraints.iter().enumerate() {
            constraint.check(i, self.poses.len())?;
        }
        Ok(Self { constraints, ..self })
    }

    /// This problem for poses in several parts, numbered by `parts`, whose common points may be wrong matches. Links between two parts count in
    /// the refinement, but reduce no covariance.
    ///
    /// # Errors
    /// When the number of parts differs from the number of poses.
    pub fn with_parts(self, parts: Vec<usize>) -> Result<Self, Invalid> {
        if parts.len() != self.poses.len() {
            return Err(Invalid::new(
                "parts",
                parts.len(),
                "",
                format!("{}, one per pose", self.poses.len()),
            ));
        }
        Ok(Self { parts, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InverseDepth;
    use crate::bundle_solver::BundleSolver;
    use nalgebra::Vector6;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use trundle_core::{Distortion, Vector2};

    const EXACT: BundleConfig =
        BundleConfig { steps: 30, converged: 1e-12, damping: 1e-4, covariances: false };

    #[derive(Clone)]
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
        let solution = problem.solve(&BundleConfig::default());
        assert_eq!(solution.poses[..2], scene.poses[..2]);
        assert_eq!(solution, problem.solve(&BundleConfig::default()));
    }

    #[test]
    fn slices_and_used_buffers_change_no_bit() {
        let scene = scene();
        let (problem, config) = (perturbed(&scene, 2), BundleConfig::default());
        let whole = problem.solve(&config);
        let mut solver = BundleSolver::default();
        for work in [1, 700, 7, usize::MAX >> 1] {
            // Another problem of another size in between.
            solver.begin(&perturbed(&scene, 5), &config);
            solver.advance(2 * work);
            solver.begin(&problem, &config);
            while !solver.advance(work) {}
            assert_eq!((solver.poses(), solver.points()), (&whole.poses[..], &whole.points[..]));
            assert_eq!((solver.chi2(), solver.cost()), (&whole.chi2[..], whole.final_cost));
        }
    }

    /// Exact measurements between the poses of a scene.
    fn measured(scene: &Scene, from: usize, to: usize, sigma: f64) -> PoseConstraint {
        let information = nalgebra::Matrix6::identity() * sigma.powi(-2);
        PoseConstraint { from, to, from_to: scene.poses[from].inverse() * scene.poses[to], information }
    }

    #[test]
    fn constraints_hold_poses_without_points_and_a_wrong_one_pulls_little() {
        let mut scene = scene();
        // The last two poses have no points in common with the others.
        scene.observations.retain(|seen| seen.pose < 4);
        let constraints = vec![measured(&scene, 3, 4, 0.01), measured(&scene, 5, 4, 0.01)];
        let problem = perturbed(&scene, 1).with_constraints(constraints.clone()).unwrap();
        assert_recovered(&scene, &problem.solve(&EXACT), 1e-6);
        let mut slipped = measured(&scene, 0, 2, 0.02);
        slipped.from_to = slipped.from_to * Pose3::exp(Vector6::new(0.5, 0.0, 0.0, 0.0, 0.2, 0.0));
        let problem = perturbed(&scene, 1).with_constraints([&constraints[..], &[slipped]].concat()).unwrap();
        let off = (scene.poses[2].inverse() * problem.solve(&EXACT).poses[2]).log().norm();
        assert!(off > 1e-9 && off < 0.01, "{off}");
    }

    #[test]
    fn chance_links_between_parts_do_not_reduce_covariances() {
        let mut scene = scene();
        // The last two poses observe only three points of the first four.
        let known: Vec<usize> = scene.observations.iter().filter(|o| o.pose < 4).map(|o| o.point).collect();
        scene.observations.retain(|o| o.pose < 4 || !known.contains(&o.point) || o.point < 3);
        let constraints = vec![measured(&scene, 3, 4, 0.3), measured(&scene, 5, 4, 0.01)];
        let tied = perturbed(&scene, 1).with_constraints(constraints).unwrap();
        let sigma = |problem: &BundleProblem| {
            let mut solver = BundleSolver::default();
            solver.begin(problem, &BundleConfig { covariances: true, ..EXACT });
            solver.finish();
            let covariance = solver.covariance(4).expect("the tie holds it");
            (solver.poses()[4], covariance.fixed_view::<3, 3>(0, 0).trace().sqrt())
        };
        let (with_links, known) = sigma(&tied);
        let (with_parts, by_ties) = sigma(&tied.clone().with_parts(vec![0, 0, 0, 0, 1, 1]).unwrap());
        assert_eq!(with_links, with_parts);
        assert!(known < 0.1 && by_ties > 0.5, "{known} m by the links, {by_ties} m by the ties");
        assert!(tied.with_parts(vec![0; 5]).unwrap_err().to_string().contains("parts"));
    }

    #[test]
    fn a_constraint_to_a_missing_pose_is_refused() {
        let scene = scene();
        let nowhere = PoseConstraint { to: 9, ..measured(&scene, 0, 1, 0.1) };
        let error = perturbed(&scene, 1).with_constraints(vec![nowhere]).unwrap_err().to_string();
        assert!(error.contains("from 0 to 9"), "{error}");
    }

    /// A long row of cameras, in which few share points: the reduced system is sparse.
    #[test]
    fn many_poses_are_refined_as_few_are() {
        let camera = scene().camera;
        let count = 100;
        let truth =
            |i: usize| Pose3::exp(Vector6::new(0.2 * i as f64, 0.0, 0.0, 0.0, 0.02 * (i % 7) as f64, 0.0));
        let point = |j: usize| {
            Vector3::new(0.05 * j as f64, 0.5 - 0.1 * (j % 11) as f64, 2.0 + 0.1 * (j % 13) as f64)
        };
        let mut observations = Vec::new();
        for i in 0..count {
            for j in 0..400 {
                let p = truth(i).inverse().transform(point(j));
                let Some(pixel) = camera.project(p).filter(|px| camera.contains(*px)) else { continue };
                let depth = Some(InverseDepth { value: 1.0 / p.z, sigma: 0.003 });
                let seen = PointObservation { pixel, pixel_sigma: 1.0, depth };
                observations.push(BundleObservation { pose: i, point: j, seen });
            }
        }
        let off = |i: usize| Pose3::exp(Vector6::from_fn(|r, _| 0.01 * ((i * 7 + r * 5) % 11) as f64 - 0.05));
        let poses = (0..count)
            .map(|i| BundlePose {
                world_from_camera: if i == 0 { truth(0) } else { truth(i) * off(i) },
                fixed: i == 0,
            })
            .collect();
        let problem = BundleProblem::new(camera, poses, (0..400).map(point).collect(), observations).unwrap();
        let solution = problem.solve(&EXACT);
        for (i, pose) in solution.poses.iter().enumerate() {
            assert!((pose.inverse() * truth(i)).log().norm() < 1e-5, "pose {i}");
        }
    }

    /// The error of a pose over many noisy scenes, by the covariance that the solver gives it: six on average.
    #[test]
    fn covariances_agree_with_the_inverse_of_the_full_system() {
        let scene = scene();
        let (mut sum, runs) = (0.0, 100);
        for seed in 0..runs {
            let mut rng = ChaCha8Rng::seed_from_u64(100 + seed);
            let mut noise = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
            let mut noisy = scene.clone();
            for o in &mut noisy.observations {
                o.seen.pixel += Vector2::new(noise(), noise());
                o.seen.depth = o.seen.depth.map(|d| InverseDepth { value: d.value + d.sigma * noise(), ..d });
            }
            let mut solver = BundleSolver::default();
            solver
                .begin(&perturbed(&noisy, 1), &BundleConfig { covariances: true, converged: 1e-6, ..EXACT });
            solver.finish();
            let error = (scene.poses[5].inverse() * solver.poses()[5]).log();
            let covariance = solver.covariance(5).expect("a covariance");
            sum += error.dot(&(covariance.try_inverse().unwrap() * error));
            assert!(solver.covariance(0).is_none(), "it is fixed");
            // The points are not known exactly: the pose is less certain than with exact points.
            let own = solver.information(5).unwrap().try_inverse().unwrap();
            assert!((covariance - own).symmetric_eigenvalues().min() > -1e-12);
        }
        // The chi-square of 600 degrees of freedom is within 534 and 670 at 95 %.
        let mean = sum / runs as f64;
        assert!((5.34..6.70).contains(&mean), "normalised squared error {mean}");
    }

    #[test]
    fn outliers_do_not_pull_and_are_found_by_their_chi2() {
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
    fn an_observation_of_a_missing_point_is_refused() {
        let mut scene = scene();
        scene.observations[3].point = 80;
        let pose = BundlePose { world_from_camera: Pose3::identity(), fixed: true };
        let error =
            BundleProblem::new(scene.camera, vec![pose; 6], scene.points, scene.observations).unwrap_err();
        assert!(error.to_string().contains("point 80"), "{error}");
    }
}
