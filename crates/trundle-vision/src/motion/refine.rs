//! Refines a pose by reprojection.

use super::residual::{Mover, Observation};
use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PinholeCamera, Pose3, Vector2, Vector3, require_positive};

/// Chi-square with two degrees of freedom at 95 %. Source: the chi-square distribution.
const CHI2_95_2: f64 = 5.991;

/// How [`refine_pose_by_reprojection`] iterates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RefineConfig {
    /// Steps at most, 1 or more. Default 10 \[MurArtal17\].
    pub steps: usize,
    /// Standard deviation of a reprojection, px, positive; 2.4 times it the loss turns linear. Default 1.5: a corner of the
    /// middle octaves.
    pub pixel_sigma: f64,
    /// A step shorter than this (m and rad) is the last, positive. Default 1e-7: far below what pixels resolve.
    pub converged: f64,
}

impl Default for RefineConfig {
    fn default() -> Self {
        Self { steps: 10, pixel_sigma: 1.5, converged: 1e-7 }
    }
}

impl RefineConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When `steps` is zero or another number is not positive.
    pub fn validated(self) -> Result<Self, Invalid> {
        if self.steps == 0 {
            return Err(Invalid::new("refine.steps", 0, "", "1 or more"));
        }
        require_positive("refine.pixel_sigma", self.pixel_sigma, "px")?;
        require_positive("refine.converged", self.converged, "")?;
        Ok(self)
    }
}

/// The pose near `b_from_a` with the smallest reprojection errors of `points_a` (camera frame a, m) to their rectified `pixels_b`, by
/// Gauss-Newton on the Huber loss. `camera` is that of image b. A step that increases the cost is rejected.
///
/// `None` if the points do not determine a pose: fewer than three, or degenerate. Panics when the slices differ in length.
pub fn refine_pose_by_reprojection(
    b_from_a: Pose3,
    points_a: &[Vector3],
    pixels_b: &[Vector2],
    camera: &PinholeCamera,
    config: &RefineConfig,
) -> Option<Pose3> {
    assert_eq!(points_a.len(), pixels_b.len(), "invariant: every point has its pixel");
    let per_px = 1.0 / config.pixel_sigma;
    let observe =
        |(&point, &pixel)| Observation { point, pixel, per_px, depth: 0.0, per_m: 0.0, bound: CHI2_95_2 };
    let observations: Vec<Observation> = points_a.iter().zip(pixels_b).map(observe).collect();
    gauss_newton(b_from_a, &observations, camera, config.steps, config.converged)
}

/// Gauss-Newton on the Huber loss from `b_from_a`, until a step is short, makes it worse, or `steps` are done. `None` when
/// the observations do not determine a pose.
pub(crate) fn gauss_newton(
    b_from_a: Pose3,
    observations: &[Observation],
    camera: &PinholeCamera,
    steps: usize,
    converged: f64,
) -> Option<Pose3> {
    (observations.len() >= 3).then_some(())?;
    let mut pose = b_from_a;
    let mut cost = robust_cost(pose, observations, camera);
    for _ in 0..steps {
        let (hessian, gradient) = normal_equations(pose, observations, camera);
        let step = -solve(hessian, &gradient)?;
        let candidate = (pose * Pose3::exp(step)).renormalized();
        let candidate_cost = robust_cost(candidate, observations, camera);
        // Also false for NaN.
        if candidate_cost <= cost {
            (pose, cost) = (candidate, candidate_cost);
        } else {
            break;
        }
        if step.norm() < converged {
            break;
        }
    }
    Some(pose)
}

/// The solution of `hessian * x = gradient`; `None` if the hessian is singular to working precision. Metres and rad are
/// brought to one measure by the hessian's diagonal.
fn solve(hessian: Matrix6<f64>, gradient: &Vector6<f64>) -> Option<Vector6<f64>> {
    let scale = hessian.diagonal().map(|d| 1.0 / d.sqrt());
    scale.iter().all(|s| s.is_finite()).then_some(())?;
    let scaling = Matrix6::from_diagonal(&scale);
    let cholesky = (scaling * hessian * scaling).cholesky()?;
    (cholesky.l_dirty().diagonal().min() > 1e-6).then(|| scaling * cholesky.solve(&(scaling * gradient)))
}

/// Huber's loss over all observations.
fn robust_cost(pose: Pose3, observations: &[Observation], camera: &PinholeCamera) -> f64 {
    let mover = Mover::from(pose);
    let loss = |o: &Observation| {
        let chi2 = o.chi2(camera, mover.transform(o.point));
        if chi2 <= o.bound { chi2 } else { 2.0 * (o.bound * chi2).sqrt() - o.bound }
    };
    observations.iter().map(loss).sum()
}

/// J'WJ and J'Wr, the weights being the derivative of Huber's loss.
fn normal_equations(
    pose: Pose3,
    observations: &[Observation],
    camera: &PinholeCamera,
) -> (Matrix6<f64>, Vector6<f64>) {
    let mover = Mover::from(pose);
    let (mut hessian, mut gradient) = (Matrix6::zeros(), Vector6::zeros());
    for observation in observations {
        let p_b = mover.transform(observation.point);
        let Some(residual) = observation.residual(camera, p_b) else { continue };
        let jacobian = observation.jacobian(camera, &mover.rotation, p_b);
        let weight = (observation.bound / residual.norm_squared()).sqrt().min(1.0);
        hessian += jacobian.transpose() * jacobian * weight;
        gradient += jacobian.transpose() * residual * weight;
    }
    (hessian, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn scene(count: usize) -> Vec<Vector3> {
        let camera = PinholeCamera::kinect_v2();
        let pixel = |i: usize| Vector2::new((i * 97 % 500) as f64, (i * 61 % 420) as f64);
        (0..count).map(|i| camera.unproject(pixel(i), 1.0 + (i * 31 % 17) as f64 / 5.0)).collect()
    }

    fn seen(points: &[Vector3], b_from_a: Pose3) -> Vec<Vector2> {
        let camera = PinholeCamera::kinect_v2();
        points.iter().map(|p| camera.project(b_from_a.transform(*p)).unwrap()).collect()
    }

    fn refined(points: &[Vector3], pixels: &[Vector2]) -> Option<Pose3> {
        let camera = PinholeCamera::kinect_v2();
        refine_pose_by_reprojection(Pose3::identity(), points, pixels, &camera, &RefineConfig::default())
    }

    proptest! {
        #[test]
        fn finds_the_pose_that_the_pixels_show(tangent in prop::array::uniform6(-0.15..0.15)) {
            let points = scene(40);
            let truth = Pose3::exp(Vector6::from(tangent));
            let found = refined(&points, &seen(&points, truth)).unwrap();
            prop_assert!((found.inverse() * truth).log().norm() < 1e-7);
        }

        #[test]
        fn some_wrong_pixels_do_little_harm(tangent in prop::array::uniform6(-0.05..0.05)) {
            let points = scene(60);
            let truth = Pose3::exp(Vector6::from(tangent));
            let mut pixels = seen(&points, truth);
            pixels.iter_mut().step_by(6).for_each(|p| p.x += 60.0);
            let found = refined(&points, &pixels).unwrap();
            prop_assert!((found.inverse() * truth).log().norm() < 0.02);
        }
    }

    #[test]
    fn points_that_do_not_determine_a_pose_give_none() {
        let points = scene(2);
        assert_eq!(refined(&points, &seen(&points, Pose3::identity())), None);
        let same = [scene(1)[0]; 9];
        assert_eq!(refined(&same, &seen(&same, Pose3::identity())), None);
        assert_eq!(refined(&[Vector3::repeat(f64::NAN); 5], &[Vector2::zeros(); 5]), None);
    }

    #[test]
    fn broken_configurations_are_refused_by_name() {
        let error = RefineConfig { steps: 0, ..Default::default() }.validated().unwrap_err();
        assert_eq!(error.field, "refine.steps");
        let error = RefineConfig { pixel_sigma: f64::NAN, ..Default::default() }.validated().unwrap_err();
        assert_eq!(error.field, "refine.pixel_sigma");
    }
}
