//! Lens models of other makers as [`Distortion`].
//!
//! [`Distortion`] maps a point of a rectified image to the raw image. Some cameras report the opposite direction, or another formula. The
//! five coefficients are linear, so least squares over a grid of the image find them; the largest remaining error decides about acceptance.

use nalgebra::{DMatrix, DVector};
use trundle_core::{Distortion, Invalid, PinholeCamera, Vector2};

/// Points of the grid along each side of the image. Source: ours; 17 points find the maximum of a polynomial of degree 7 to 2 %.
const GRID_POINTS: usize = 17;
/// Largest error of fitted coefficients in the image: 0.5 px. A worse fit is refused. Source: ours, half the error that an undistorted
/// feature may have.
const MAX_FIT_ERROR_PX: f64 = 0.5;

/// A fitted distortion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedDistortion {
    /// The coefficients.
    pub distortion: Distortion,
    /// Largest distance between the fitted and the reported model in the image \[px\]; 0 for equal formulas.
    pub error_px: f64,
}

impl FittedDistortion {
    /// Coefficients that need no fit.
    pub fn exact(distortion: Distortion) -> Self {
        Self { distortion, error_px: 0.0 }
    }
}

/// A point of the image in both forms, normalized by the focal length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LensPair {
    /// Point in the rectified image.
    pub rectified: Vector2,
    /// Point in the raw image.
    pub raw: Vector2,
}

/// The coefficients for a lens whose model `pair` gives the two forms of a pixel. `camera` has the size, focal lengths and principal point.
///
/// # Errors
/// When the fitted model is off by more than 0.5 px somewhere in the image.
pub fn fit(camera: &PinholeCamera, pair: impl Fn(Vector2) -> LensPair) -> Result<FittedDistortion, Invalid> {
    let pairs: Vec<LensPair> = grid(camera).map(pair).collect();
    let distortion = solve(&pairs)?;
    let error_px = largest_error(camera, distortion, &pairs)?;
    if error_px <= MAX_FIT_ERROR_PX {
        return Ok(FittedDistortion { distortion, error_px });
    }
    Err(Invalid::new("error of the fitted distortion", format!("{error_px:.2}"), "px", "0.5 or less"))
}

/// Pixels over the whole image, normalized.
fn grid(camera: &PinholeCamera) -> impl Iterator<Item = Vector2> {
    let step = |size: usize| (size as f64 - 1.0) / (GRID_POINTS as f64 - 1.0);
    let (dx, dy) = (step(camera.width()), step(camera.height()));
    let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
    (0..GRID_POINTS * GRID_POINTS).map(move |n| {
        let (column, row) = ((n % GRID_POINTS) as f64 * dx, (n / GRID_POINTS) as f64 * dy);
        Vector2::new((column - cx) / fx, (row - cy) / fy)
    })
}

/// Least squares of `raw - rectified = J (k1, k2, p1, p2, k3)`.
fn solve(pairs: &[LensPair]) -> Result<Distortion, Invalid> {
    let mut jacobian = DMatrix::zeros(2 * pairs.len(), 5);
    let mut residual = DVector::zeros(2 * pairs.len());
    for (n, pair) in pairs.iter().enumerate() {
        let (x, y) = (pair.rectified.x, pair.rectified.y);
        let r2 = x * x + y * y;
        let rows = [
            [x * r2, x * r2 * r2, 2.0 * x * y, r2 + 2.0 * x * x, x * r2.powi(3)],
            [y * r2, y * r2 * r2, r2 + 2.0 * y * y, 2.0 * x * y, y * r2.powi(3)],
        ];
        for (axis, row) in rows.iter().enumerate() {
            row.iter().enumerate().for_each(|(column, value)| jacobian[(2 * n + axis, column)] = *value);
            residual[2 * n + axis] = pair.raw[axis] - pair.rectified[axis];
        }
    }
    let solution = jacobian.svd(true, true).solve(&residual, 1e-12);
    let k = solution
        .map_err(|reason| Invalid::new("distortion", reason, "", "coefficients that can be fitted"))?;
    Ok(Distortion { k1: k[0], k2: k[1], p1: k[2], p2: k[3], k3: k[4] })
}

fn largest_error(camera: &PinholeCamera, distortion: Distortion, pairs: &[LensPair]) -> Result<f64, Invalid> {
    let size = (camera.width(), camera.height());
    let focal = (camera.fx(), camera.fy());
    let fitted = PinholeCamera::new(size, focal, (0.0, 0.0), distortion)?;
    let pixel = |n: Vector2| Vector2::new(n.x * focal.0, n.y * focal.1);
    let errors = pairs.iter().map(|pair| (fitted.distort(pixel(pair.rectified)) - pixel(pair.raw)).norm());
    Ok(errors.fold(0.0, |largest, error| if error <= largest { largest } else { error }))
}

/// The Brown-Conrady polynomial of a normalized point.
pub fn brown_conrady(lens: Distortion, n: Vector2) -> Vector2 {
    let r2 = n.norm_squared();
    tangential(lens, n, radial(lens, n), r2)
}

/// The Brown-Conrady polynomial with the tangential part of the radially distorted point. Source: documentation of librealsense,
/// "Projection in RealSense SDK 2.0".
pub fn modified_brown_conrady(lens: Distortion, n: Vector2) -> Vector2 {
    let radial = radial(lens, n);
    tangential(lens, radial, radial, n.norm_squared())
}

fn radial(Distortion { k1, k2, k3, .. }: Distortion, n: Vector2) -> Vector2 {
    let r2 = n.norm_squared();
    n * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3)))
}

/// `base` with the tangential part at `n`; `r2` is the squared distance of the rectified point from the centre.
fn tangential(Distortion { p1, p2, .. }: Distortion, n: Vector2, base: Vector2, r2: f64) -> Vector2 {
    let xy = n.x * n.y;
    base + Vector2::new(
        2.0 * p1 * xy + p2 * (r2 + 2.0 * n.x * n.x),
        p1 * (r2 + 2.0 * n.y * n.y) + 2.0 * p2 * xy,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(distortion: Distortion) -> PinholeCamera {
        PinholeCamera::new((640, 480), (600.0, 601.0), (321.0, 243.0), distortion).unwrap()
    }

    fn normalized(camera: &PinholeCamera, pixel: Vector2) -> Vector2 {
        Vector2::new((pixel.x - camera.cx()) / camera.fx(), (pixel.y - camera.cy()) / camera.fy())
    }

    fn pixel(camera: &PinholeCamera, n: Vector2) -> Vector2 {
        Vector2::new(n.x * camera.fx() + camera.cx(), n.y * camera.fy() + camera.cy())
    }

    #[test]
    fn the_own_model_is_found_again() {
        let lens = Distortion { k1: 0.1, k2: -0.2, p1: 0.001, p2: -0.002, k3: 0.05 };
        let camera = camera(lens);
        let pair = |rectified| LensPair {
            rectified,
            raw: normalized(&camera, camera.distort(pixel(&camera, rectified))),
        };
        let found = fit(&camera, pair).unwrap();
        assert!(found.error_px < 1e-6, "{found:?}");
        assert!((found.distortion.k1 - lens.k1).abs() < 1e-6 && (found.distortion.p2 - lens.p2).abs() < 1e-6);
    }

    #[test]
    fn a_lens_without_such_a_form_is_refused() {
        let twisted =
            |rectified: Vector2| LensPair { rectified, raw: Vector2::new(rectified.x, rectified.x) };
        let refusal = fit(&camera(Distortion::default()), twisted).unwrap_err().to_string();
        assert!(refusal.contains("0.5 or less"), "{refusal}");
    }
}
