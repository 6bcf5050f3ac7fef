//! Refinement of a pose by Gauss-Newton on a kernel density.

use super::{ScanMatchConfig, information::Information};
use crate::scan_match::normal_equations::NormalEquations;
use crate::scan_match::point_spread::PointSpread;
use nalgebra::{Matrix2, Matrix2x3};
use trundle_core::{Pose2, Vector2};
use trundle_grid::SurfacePoints;

/// Kernel density of an outlier \[1\]. A hit with this density is explained with probability 0.5; a hit on a wall has a
/// density of about 3. Source: ours.
const OUTLIER_DENSITY: f64 = 0.3;
/// Curvature along a wall relative to that across it \[1\]. A smaller curvature comes from the unevenness of the wall's cells and counts as
/// zero. Source: ours.
const MIN_RELATIVE_CURVATURE: f64 = 0.15;
/// Maximum number of Gauss-Newton steps. After this number the last pose is returned. Source: ours.
const MAX_ITERATIONS: usize = 12;
/// Step length at which the iteration ends \[m, rad\]. Source: ours.
const MIN_STEP: f64 = 1e-5;

/// Minimum lever of the hits \[m\]. Hits nearer to each other do not determine the heading. Source: ours.
pub(crate) const MIN_LEVER_M: f64 = 0.1;

/// Gauss-Newton on the kernel density of the sites: each hit moves to the kernel-weighted mean of the sites around it (mean shift). The
/// spread of those sites limits the pull to the normal of a wall. Directions without information do not change.
pub(crate) fn refine(
    config: &ScanMatchConfig,
    sites: &SurfacePoints,
    points: &[Vector2],
    start: Pose2,
) -> (Pose2, NormalEquations) {
    let mut pose = start;
    let spread = PointSpread::new(points.iter().copied(), MIN_LEVER_M);
    for _ in 0..MAX_ITERATIONS {
        let equations = equations(config, sites, points, pose);
        let step = Information::new(config, &equations, &spread).solve(&equations.rhs);
        pose = pose * Pose2::exp(step);
        if step.amax() < MIN_STEP {
            break;
        }
    }
    (pose, equations(config, sites, points, pose))
}

fn equations(
    config: &ScanMatchConfig,
    sites: &SurfacePoints,
    points: &[Vector2],
    pose: Pose2,
) -> NormalEquations {
    let mut sum = NormalEquations::default();
    let (s, c) = pose.theta.sin_cos();
    let map_from_base = Matrix2::new(c, -s, s, c);
    let per_variance = 1.0 / config.kernel_sigma.powi(2);
    for &point in points {
        let Some(rhs) = rhs(config, sites, pose.transform(point)) else { continue };
        // d(hit) / d(pose), right perturbation.
        let across = map_from_base * Vector2::new(-point.y, point.x);
        let jacobian = Matrix2x3::from_columns(&[
            map_from_base.column(0).into_owned(),
            map_from_base.column(1).into_owned(),
            across,
        ]);
        let weighted = jacobian.transpose() * rhs.stiffness * (rhs.explained * per_variance);
        sum.information += weighted * jacobian;
        sum.rhs += weighted * rhs.shift;
        sum.explained += rhs.explained;
    }
    sum
}

struct PointResidual {
    /// Vector to the mean of the sites, m.
    shift: Vector2,
    /// Weight of the residual by direction: 1 across a wall, 0 along it.
    stiffness: Matrix2<f64>,
    /// Probability that the hit is an obstacle of the map, 0 to 1.
    explained: f64,
}

fn rhs(config: &ScanMatchConfig, sites: &SurfacePoints, hit: Vector2) -> Option<PointResidual> {
    let variance = config.kernel_sigma.powi(2);
    let reach = (3.0 * config.kernel_sigma / sites.resolution).ceil() as i32;
    let (mut density, mut first, mut second) = (0.0, Vector2::zeros(), Matrix2::zeros());
    for site in sites.near(hit, reach) {
        let to = site - hit;
        let kernel = (-0.5 * to.norm_squared() / variance).exp();
        density += kernel;
        first += to * kernel;
        second += to * to.transpose() * kernel;
    }
    if density < 1e-3 {
        return None;
    }
    let shift = first / density;
    let spread = second / density - shift * shift.transpose();
    // The Hessian of -ln(density), in units of 1 / variance.
    let curvature = Matrix2::identity() - spread / variance;
    Some(PointResidual {
        shift,
        stiffness: regularized(curvature),
        explained: density / (density + OUTLIER_DENSITY),
    })
}

/// The curvature without the part caused by the unevenness of a straight wall's cells, and without negative values.
fn regularized(curvature: Matrix2<f64>) -> Matrix2<f64> {
    let mut eigen = curvature.symmetric_eigen();
    eigen
        .eigenvalues
        .apply(|v| *v = ((*v - MIN_RELATIVE_CURVATURE) / (1.0 - MIN_RELATIVE_CURVATURE)).clamp(0.0, 1.0));
    eigen.recompose()
}
