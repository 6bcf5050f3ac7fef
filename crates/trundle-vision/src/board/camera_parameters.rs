//! The parameters of a camera that a calibration estimates.

use trundle_core::{Distortion, Invalid, PinholeCamera, Vector2, Vector3};

/// Number of parameters of a camera. Source: ours.
pub(super) const PARAMETER_COUNT: usize = 9;

/// Intrinsics and lens: fx, fy, cx, cy (px), k1, k2, p1, p2, k3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraParameters(pub [f64; PARAMETER_COUNT]);

/// Coefficients of the lens that are estimated; the others are 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LensModel {
    /// k1, k2, p1, p2: enough for most lenses.
    #[default]
    FourCoefficients,
    /// k3 as well: wide lenses, and images with the board in the corners.
    FiveCoefficients,
}

impl LensModel {
    /// Number of parameters that are estimated.
    pub(super) fn parameters(self) -> usize {
        match self {
            Self::FourCoefficients => PARAMETER_COUNT - 1,
            Self::FiveCoefficients => PARAMETER_COUNT,
        }
    }
}

impl CameraParameters {
    /// Names, in order.
    pub const NAMES: [&'static str; PARAMETER_COUNT] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];

    /// The camera, of `width` x `height` px.
    ///
    /// # Errors
    /// When a focal length is not positive or a number is not finite.
    pub fn camera(&self, width: usize, height: usize) -> Result<PinholeCamera, Invalid> {
        let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = self.0;
        let lens = Distortion { k1, k2, p1, p2, k3 };
        PinholeCamera::new((width, height), (fx, fy), (cx, cy), lens)
    }

    /// Position of a point (camera frame, m) in the raw image, px: Brown and Conrady, as in OpenCV.
    pub(super) fn project(&self, p: Vector3) -> Vector2 {
        let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = self.0;
        let (x, y) = (p.x / p.z, p.y / p.z);
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let u = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        let v = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
        Vector2::new(fx * u + cx, fy * v + cy)
    }
}
