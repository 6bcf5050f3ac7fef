//! Intrinsics and extrinsics of librealsense2 in the project's terms.

use super::functions::{Extrinsics, Intrinsics};
use crate::camera::native::distortion_fit::{FittedDistortion, LensPair, fit, modified_brown_conrady};
use nalgebra::Matrix3;
use std::ffi::c_int;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3, Vector3};

const MODEL_NONE: c_int = 0;
const MODEL_MODIFIED_BROWN_CONRADY: c_int = 1;
const MODEL_INVERSE_BROWN_CONRADY: c_int = 2;
const MODEL_BROWN_CONRADY: c_int = 4;

/// A camera of the library, with the largest error of its distortion \[px\].
///
/// Brown-Conrady is the project's own model. Modified and inverse Brown-Conrady are fitted; all other models are refused. The library
/// computes both by the same formula: its function `rs2_deproject_pixel_to_point` inverts the modified one for the model named inverse.
///
/// # Errors
/// When a number is out of range, the model is that of a fisheye lens, or the error of the fit exceeds 0.5 px.
pub fn pinhole_camera(raw: &Intrinsics) -> Result<(PinholeCamera, f64), Invalid> {
    let size = (usize::try_from(raw.width).unwrap_or(0), usize::try_from(raw.height).unwrap_or(0));
    let focal = (f64::from(raw.fx), f64::from(raw.fy));
    let centre = (f64::from(raw.ppx), f64::from(raw.ppy));
    let rectified = PinholeCamera::new(size, focal, centre, Distortion::default())?;
    let lens = fitted(raw, &rectified)?;
    Ok((PinholeCamera::new(size, focal, centre, lens.distortion)?, lens.error_px))
}

fn fitted(raw: &Intrinsics, rectified: &PinholeCamera) -> Result<FittedDistortion, Invalid> {
    let [k1, k2, p1, p2, k3] = raw.coeffs.map(f64::from);
    let own = Distortion { k1, k2, p1, p2, k3 };
    match raw.model {
        _ if raw.coeffs == [0.0; 5] && raw.model <= MODEL_BROWN_CONRADY && raw.model != 3 => {
            Ok(FittedDistortion::exact(own))
        }
        MODEL_NONE => Ok(FittedDistortion::exact(Distortion::default())),
        MODEL_BROWN_CONRADY => Ok(FittedDistortion::exact(own)),
        MODEL_MODIFIED_BROWN_CONRADY | MODEL_INVERSE_BROWN_CONRADY => {
            fit(rectified, |n| LensPair { rectified: n, raw: modified_brown_conrady(own, n) })
        }
        fisheye => Err(Invalid::new(
            "distortion model of librealsense",
            fisheye,
            "",
            "0 to 2, or 4: no fisheye lens",
        )),
    }
}

/// The pose of the first stream's camera in the second's frame.
///
/// # Errors
/// When a number is not finite.
pub fn pose(raw: &Extrinsics) -> Result<Pose3, Invalid> {
    let rotation = Matrix3::from_column_slice(&raw.rotation.map(f64::from));
    let pose = Pose3::from_matrix(rotation, Vector3::from(raw.translation.map(f64::from)));
    if pose.is_finite() && raw.rotation.iter().any(|value| *value != 0.0) {
        return Ok(pose);
    }
    Err(Invalid::new("extrinsics of librealsense", format!("{raw:?}"), "", "a rotation and finite numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    fn raw(model: c_int, coeffs: [f32; 5]) -> Intrinsics {
        Intrinsics { width: 640, height: 480, ppx: 322.0, ppy: 241.0, fx: 610.0, fy: 611.0, model, coeffs }
    }

    const LENS: [f32; 5] = [-0.054, 0.066, -0.0007, 0.0003, -0.021];

    #[test]
    fn an_inverse_lens_distorts_by_the_modified_formula() {
        let (camera, error_px) = pinhole_camera(&raw(MODEL_INVERSE_BROWN_CONRADY, LENS)).unwrap();
        assert!(error_px < 0.1, "{error_px} px");
        let [k1, k2, p1, p2, k3] = LENS.map(f64::from);
        for pixel in [Vector2::new(0.0, 0.0), Vector2::new(639.0, 100.0), Vector2::new(300.0, 479.0)] {
            let n = Vector2::new((pixel.x - 322.0) / 610.0, (pixel.y - 241.0) / 611.0);
            let raw = modified_brown_conrady(Distortion { k1, k2, p1, p2, k3 }, n);
            let expected = Vector2::new(raw.x * 610.0 + 322.0, raw.y * 611.0 + 241.0);
            let found = camera.distort(pixel);
            assert!((found - expected).norm() < 0.1, "{found} {expected}");
        }
    }

    #[test]
    fn the_own_model_is_taken_as_it_is_and_a_fisheye_is_refused() {
        let (camera, error_px) = pinhole_camera(&raw(MODEL_BROWN_CONRADY, LENS)).unwrap();
        assert_eq!((camera.distortion().k1, error_px), (f64::from(LENS[0]), 0.0));
        assert!(pinhole_camera(&raw(3, [0.0; 5])).unwrap_err().to_string().contains("fisheye"));
        assert!(pinhole_camera(&raw(5, LENS)).unwrap_err().to_string().contains("fisheye"));
    }

    #[test]
    fn a_rotation_comes_column_by_column() {
        let quarter = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let found = pose(&Extrinsics { rotation: quarter, translation: [0.015, 0.0, 0.0] }).unwrap();
        let moved = found.transform(Vector3::new(1.0, 0.0, 2.0));
        assert!((moved - Vector3::new(0.015, 1.0, 2.0)).norm() < 1e-6, "{moved}");
    }
}
