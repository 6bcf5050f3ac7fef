use super::{ScanMatchConfig, information::Information, surface_points::Sites};
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use trundle_core::{Pose2, Vector2};

/// A kernel density of this at a hit explains it as well as chance does; a hit on a wall has about 3.
const CHANCE: f64 = 0.3;
/// Curvature along a wall below this part of that across it is the unevenness of its cells.
const UNEVENNESS: f64 = 0.15;
const MOST_STEPS: usize = 12;
/// Steps shorter than this are none, m and rad.
const STILL: f64 = 1e-5;

/// What all hits say at a pose: information matrix, right-hand side, and how many hits the map explains.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vote {
    pub(crate) information: Matrix3<f64>,
    pub(crate) pull: Vector3<f64>,
    pub(crate) explained: f64,
}

/// Gauss-Newton on the kernel density of the sites: every hit is pulled to the kernel-weighted mean of the sites about it
/// (mean shift), across walls but not along them, as the spread of those sites tells. Directions that no hit holds are
/// not moved in.
pub(crate) fn refine(
    config: &ScanMatchConfig,
    sites: &Sites,
    points: &[Vector2],
    start: Pose2,
) -> (Pose2, Vote) {
    let mut pose = start;
    for _ in 0..MOST_STEPS {
        let vote = vote(config, sites, points, pose);
        let step = Information::new(config, &vote, points).solve(&vote.pull);
        pose = pose * Pose2::exp(step);
        if step.amax() < STILL {
            break;
        }
    }
    (pose, vote(config, sites, points, pose))
}

fn vote(config: &ScanMatchConfig, sites: &Sites, points: &[Vector2], pose: Pose2) -> Vote {
    let mut sum = Vote::default();
    let (s, c) = pose.theta.sin_cos();
    let map_from_base = Matrix2::new(c, -s, s, c);
    let per_variance = 1.0 / config.kernel_sigma.powi(2);
    for &point in points {
        let Some(pull) = pull(config, sites, pose.transform(point)) else { continue };
        // d(hit) / d(pose), right perturbation.
        let across = map_from_base * Vector2::new(-point.y, point.x);
        let jacobian = Matrix2x3::from_columns(&[
            map_from_base.column(0).into_owned(),
            map_from_base.column(1).into_owned(),
            across,
        ]);
        let weighted = jacobian.transpose() * pull.stiffness * (pull.explained * per_variance);
        sum.information += weighted * jacobian;
        sum.pull += weighted * pull.shift;
        sum.explained += pull.explained;
    }
    sum
}

struct Pull {
    /// To the mean of the sites, m.
    shift: Vector2,
    /// How much of it counts, by direction: 1 across a wall, 0 along it.
    stiffness: Matrix2<f64>,
    /// How likely the hit is one of the map's obstacles, 0 to 1.
    explained: f64,
}

fn pull(config: &ScanMatchConfig, sites: &Sites, hit: Vector2) -> Option<Pull> {
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
    Some(Pull { shift, stiffness: steadied(curvature), explained: density / (density + CHANCE) })
}

/// Without what the unevenness of a straight wall's cells feigns, and without negative curvature.
fn steadied(curvature: Matrix2<f64>) -> Matrix2<f64> {
    let mut eigen = curvature.symmetric_eigen();
    eigen.eigenvalues.apply(|v| *v = ((*v - UNEVENNESS) / (1.0 - UNEVENNESS)).clamp(0.0, 1.0));
    eigen.recompose()
}
