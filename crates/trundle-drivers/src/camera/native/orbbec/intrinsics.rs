//! Intrinsics and extrinsics of OrbbecSDK in the project's terms.

use super::functions::{Extrinsic, Intrinsic, LensDistortion};
use crate::camera::native::distortion_fit::{
    FittedDistortion, LensPair, brown_conrady, fit, modified_brown_conrady,
};
use nalgebra::Matrix3;
use std::ffi::c_int;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3, Vector2, Vector3};

const MODEL_NONE: c_int = 0;
const MODEL_MODIFIED_BROWN_CONRADY: c_int = 1;
const MODEL_INVERSE_BROWN_CONRADY: c_int = 2;
const MODEL_BROWN_CONRADY: c_int = 3;
const MODEL_BROWN_CONRADY_K6: c_int = 4;
/// Metres in a millimetre. Source: SI.
const M_PER_MM: f64 = 1e-3;

/// A camera of the library, with the largest error of its distortion \[px\].
///
/// # Errors
/// When a number is out of range, the model is that of a fisheye lens, or the error of the fit exceeds 0.5 px.
pub fn pinhole_camera(raw: Intrinsic, lens: LensDistortion) -> Result<(PinholeCamera, f64), Invalid> {
    let side = |pixels: i16| usize::try_from(pixels).unwrap_or(0);
    let size = (side(raw.width), side(raw.height));
    let (focal, centre) = ((f64::from(raw.fx), f64::from(raw.fy)), (f64::from(raw.cx), f64::from(raw.cy)));
    let rectified = PinholeCamera::new(size, focal, centre, Distortion::default())?;
    let fitted = fitted(lens, &rectified)?;
    Ok((PinholeCamera::new(size, focal, centre, fitted.distortion)?, fitted.error_px))
}

fn fitted(lens: LensDistortion, rectified: &PinholeCamera) -> Result<FittedDistortion, Invalid> {
    let [k1, k2, k3, k4, k5, k6] = lens.k.map(f64::from);
    let [p1, p2] = lens.p.map(f64::from);
    let own = Distortion { k1, k2, p1, p2, k3 };
    let is_polynomial = [k4, k5, k6] == [0.0; 3];
    match lens.model {
        MODEL_NONE => Ok(FittedDistortion::exact(Distortion::default())),
        MODEL_BROWN_CONRADY => Ok(FittedDistortion::exact(own)),
        MODEL_BROWN_CONRADY_K6 if is_polynomial => Ok(FittedDistortion::exact(own)),
        MODEL_BROWN_CONRADY_K6 => {
            fit(rectified, |n| LensPair { rectified: n, raw: rational(own, [k4, k5, k6], n) })
        }
        MODEL_MODIFIED_BROWN_CONRADY => {
            fit(rectified, |n| LensPair { rectified: n, raw: modified_brown_conrady(own, n) })
        }
        MODEL_INVERSE_BROWN_CONRADY => {
            fit(rectified, |n| LensPair { rectified: brown_conrady(own, n), raw: n })
        }
        fisheye => Err(Invalid::new("distortion model of OrbbecSDK", fisheye, "", "0 to 4: no fisheye lens")),
    }
}

/// The Brown-Conrady model with a denominator of three coefficients. Source: OpenCV, "Camera Calibration and 3D Reconstruction".
fn rational(lens: Distortion, [k4, k5, k6]: [f64; 3], n: Vector2) -> Vector2 {
    let r2 = n.norm_squared();
    let radial_only = Distortion { p1: 0.0, p2: 0.0, ..lens };
    let tangential = brown_conrady(lens, n) - brown_conrady(radial_only, n);
    brown_conrady(radial_only, n) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6))) + tangential
}

/// The pose of the source stream's camera in the target's frame.
///
/// # Errors
/// When the numbers are not a pose.
pub fn pose(raw: &Extrinsic) -> Result<Pose3, Invalid> {
    let rotation = Matrix3::from_row_slice(&raw.rotation.map(f64::from));
    let translation = Vector3::from(raw.translation.map(f64::from)) * M_PER_MM;
    let pose = Pose3::from_matrix(rotation, translation);
    if pose.is_finite() && raw.rotation.iter().any(|value| *value != 0.0) {
        return Ok(pose);
    }
    Err(Invalid::new("extrinsics of OrbbecSDK", format!("{raw:?}"), "", "a rotation and finite numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAW: Intrinsic = Intrinsic { fx: 610.0, fy: 611.0, cx: 322.0, cy: 241.0, width: 640, height: 480 };

    fn lens(model: c_int) -> LensDistortion {
        LensDistortion { k: [0.08, -0.1, 0.04, 0.01, -0.02, 0.005], p: [0.0004, -0.0003], model }
    }

    #[test]
    fn a_rational_lens_is_fitted() {
        let (camera, error_px) = pinhole_camera(RAW, lens(MODEL_BROWN_CONRADY_K6)).unwrap();
        assert!(error_px > 0.0 && error_px < 0.2, "{error_px} px");
        let (k1, k2, k3) = (f64::from(0.08_f32), f64::from(-0.1_f32), f64::from(0.04_f32));
        let (x, y) = ((600.0 - 322.0) / 610.0, (50.0 - 241.0) / 611.0);
        let r2: f64 = x * x + y * y;
        let radial = (1.0 + k1 * r2 + k2 * r2.powi(2) + k3 * r2.powi(3))
            / (1.0 + 0.01 * r2 - 0.02 * r2.powi(2) + 0.005 * r2.powi(3));
        let column = 322.0 + 610.0 * (x * radial + 2.0 * 0.0004 * x * y - 0.0003 * (r2 + 2.0 * x * x));
        let found = camera.distort(Vector2::new(600.0, 50.0)).x;
        assert!((found - column).abs() < 0.2, "{found} {column}");
    }

    #[test]
    fn an_inverse_lens_undistorts_by_the_polynomial() {
        let (camera, _) = pinhole_camera(RAW, lens(MODEL_INVERSE_BROWN_CONRADY)).unwrap();
        let own = Distortion { k1: 0.08, k2: -0.1, p1: 0.0004, p2: -0.0003, k3: 0.04 };
        let n = Vector2::new((10.0 - 322.0) / 610.0, (20.0 - 241.0) / 611.0);
        let expected = brown_conrady(own, n);
        let found = camera.undistort(Vector2::new(10.0, 20.0));
        let expected = Vector2::new(expected.x * 610.0 + 322.0, expected.y * 611.0 + 241.0);
        assert!((found - expected).norm() < 0.3, "{found} {expected}");
    }

    #[test]
    fn millimetres_row_by_row_become_a_pose() {
        let raw = Extrinsic {
            rotation: [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            translation: [-14.0, 1.0, 2.0],
        };
        let moved = pose(&raw).unwrap().transform(Vector3::new(1.0, 0.0, 2.0));
        assert!((moved - Vector3::new(-0.014, 1.001, 2.002)).norm() < 1e-6, "{moved}");
        assert!(pose(&Extrinsic::default()).is_err());
    }
}
