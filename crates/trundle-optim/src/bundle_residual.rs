//! The residual of an observed point in a bundle problem, and its robust loss.

use crate::bundle_layout::Measurement;
use crate::observation::{COST_BEHIND_CAMERA, MIN_PROJECTION_DEPTH_M};
use trundle_core::{PinholeCamera, Pose3};

/// A camera pose in the numbers of the residuals.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    /// Rotation of `camera_from_world`, by rows.
    pub rotation: [[f64; 3]; 3],
    translation: [f64; 3],
    /// Row of the reduced system; [`FIXED_ROW`] for a fixed pose.
    pub row: u32,
}

/// The row of a pose that does not move.
pub(crate) const FIXED_ROW: u32 = u32::MAX;

impl View {
    pub fn of(world_from_camera: &Pose3, row: u32) -> Self {
        let inverse = world_from_camera.inverse();
        let r = inverse.rotation_matrix();
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| r[(i, j)]));
        Self { rotation, translation: inverse.translation.into(), row }
    }

    /// A point of the world in the camera's frame, m.
    #[inline(always)]
    pub fn camera_point(&self, p: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| dot(&self.rotation[i], p) + self.translation[i])
    }
}

/// Focal lengths, px.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Lens {
    pub fx: f64,
    pub fy: f64,
}

impl Lens {
    pub fn of(camera: &PinholeCamera) -> Self {
        Self { fx: camera.fx(), fy: camera.fy() }
    }

    /// Squared residual of a point in a camera; infinite behind the lens.
    #[inline(always)]
    pub fn chi2(&self, view: &View, seen: &Measurement, point: &[f64; 3]) -> f64 {
        let p = view.camera_point(point);
        if p[2] < MIN_PROJECTION_DEPTH_M {
            return f64::INFINITY;
        }
        let r = self.residual(seen, &p, 1.0 / p[2]);
        dot(&r, &r)
    }

    /// The residual of a point in the camera's frame: pixel and inverse depth, in sigmas.
    #[inline(always)]
    pub fn residual(&self, seen: &Measurement, p: &[f64; 3], inverse: f64) -> [f64; 3] {
        [
            (self.fx * p[0] * inverse - seen.pixel[0]) * seen.per_px,
            (self.fy * p[1] * inverse - seen.pixel[1]) * seen.per_px,
            (inverse - seen.inverse_depth) * seen.per_depth,
        ]
    }
}

/// The Huber loss of a squared residual, and its derivative.
#[inline(always)]
pub(crate) fn robust(chi2: f64, bound: f64) -> (f64, f64) {
    if chi2 <= bound {
        return (chi2, 1.0);
    }
    if chi2 == f64::INFINITY {
        return (COST_BEHIND_CAMERA, 0.0);
    }
    let (residual, threshold) = (chi2.sqrt(), bound.sqrt());
    ((threshold * (2.0 * residual - threshold)).min(COST_BEHIND_CAMERA), threshold / residual)
}

/// The Huber loss while poses and points are refined.
#[inline(always)]
pub(crate) fn refining(chi2: f64, seen: &Measurement) -> (f64, f64) {
    robust(chi2, seen.bound)
}

/// The loss by which the result is certain: what may link two parts by chance does not count.
#[inline(always)]
pub(crate) fn certain(chi2: f64, seen: &Measurement) -> (f64, f64) {
    if seen.is_certain { robust(chi2, seen.bound) } else { (0.0, 0.0) }
}

/// The product of two vectors.
#[inline(always)]
pub(crate) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product of two vectors.
#[inline(always)]
pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
