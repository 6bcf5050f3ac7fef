//! The homography from a plane to an image.

use super::board_view::BoardPoint;
use nalgebra::{DMatrix, Matrix3, SymmetricEigen};
use trundle_core::Vector2;

/// `pixel ~ H * board` by the direct linear transform on normalised points; `None` for fewer than four points or of points on a line.
pub(super) fn homography(points: &[BoardPoint]) -> Option<Matrix3<f64>> {
    if points.len() < 4 {
        return None;
    }
    let (board, pixel) = (normalization(points, |p| p.board)?, normalization(points, |p| p.pixel)?);
    let mut equations = DMatrix::zeros(2 * points.len(), 9);
    for (i, point) in points.iter().enumerate() {
        let p = board * point.board.push(1.0);
        let q = pixel * point.pixel.push(1.0);
        for c in 0..3 {
            equations[(2 * i, c)] = p[c];
            equations[(2 * i, 6 + c)] = -q.x * p[c];
            equations[(2 * i + 1, 3 + c)] = p[c];
            equations[(2 * i + 1, 6 + c)] = -q.y * p[c];
        }
    }
    let eigen = SymmetricEigen::new(equations.transpose() * &equations);
    let h = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let h = pixel.try_inverse()? * Matrix3::from_row_slice(h.as_slice()) * board;
    (h.iter().all(|value| value.is_finite()) && h[(2, 2)].abs() > f64::EPSILON).then(|| h / h[(2, 2)])
}

/// Moves points to mean 0 and mean distance 1.
fn normalization(points: &[BoardPoint], of: impl Fn(&BoardPoint) -> Vector2) -> Option<Matrix3<f64>> {
    let count = points.len() as f64;
    let mean = points.iter().map(&of).sum::<Vector2>() / count;
    let spread = points.iter().map(|p| (of(p) - mean).norm()).sum::<f64>() / count;
    let scale = 1.0 / spread;
    (spread > 0.0)
        .then(|| Matrix3::new(scale, 0.0, -scale * mean.x, 0.0, scale, -scale * mean.y, 0.0, 0.0, 1.0))
}
