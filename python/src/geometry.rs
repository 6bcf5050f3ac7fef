//! Poses as arrays: (3,) in the plane, (4, 4) in space, rows of a TUM trajectory.

use crate::arrays::{array, from_list, from_rows, slice};
use crate::errors::value_error;
use crate::numbers::{seconds, stamp};
use nalgebra::{Matrix3, Quaternion, SMatrix, UnitQuaternion};
use numpy::{PyArray1, PyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use trundle::core::{Invalid, Pose2, Pose3, Stamp, Twist2, Vector3, require_finite};

/// Largest deviation of a rotation matrix from an orthonormal one, and of a quaternion's norm from 1. Source: the tolerance of TUM files,
/// 0.02.
const MAX_ROTATION_ERROR: f64 = 0.02;

/// x m, y m, theta rad.
pub fn pose2_array(py: Python<'_>, pose: Pose2) -> Bound<'_, PyArray1<f64>> {
    from_list(py, vec![pose.x, pose.y, pose.theta])
}

/// v m/s, omega rad/s.
pub fn twist_array(py: Python<'_>, twist: Twist2) -> Bound<'_, PyArray1<f64>> {
    from_list(py, vec![twist.v, twist.omega])
}

/// A square matrix of shape (N, N).
pub fn matrix<'py, const N: usize>(
    py: Python<'py>,
    matrix: &SMatrix<f64, N, N>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    from_rows(py, (0..N).map(|i| std::array::from_fn(|j| matrix[(i, j)])).collect::<Vec<[f64; N]>>())
}

/// A homogeneous matrix of shape (4, 4), m.
pub fn pose3_array(py: Python<'_>, pose: Pose3) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let (rotation, translation) = (pose.rotation_matrix(), pose.translation);
    let row = |i: usize| [rotation[(i, 0)], rotation[(i, 1)], rotation[(i, 2)], translation[i]];
    from_rows(py, vec![row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]])
}

/// A pose from a homogeneous matrix of shape (4, 4), float64, m.
///
/// # Errors
/// `TypeError` and `ValueError` for another dtype or shape; `ValueError` for NaN, and if the upper left part is no rotation.
pub fn pose3(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Pose3> {
    let array = array::<f64, numpy::Ix2>(object, name, "(4, 4)")?;
    let &[4, 4] = array.shape() else {
        let found = array.shape();
        return Err(value_error(format!(
            "{name} has shape {found:?}, expected a numpy array of dtype float64 and shape (4, 4)"
        )));
    };
    let at = slice(&array, name)?.as_chunks::<4>().0.to_vec();
    for number in at.as_flattened() {
        require_finite(name, *number, "").map_err(value_error)?;
    }
    let rotation = Matrix3::from_fn(|i, j| at[i][j]);
    let error = (rotation.transpose() * rotation - Matrix3::identity()).amax();
    if error > MAX_ROTATION_ERROR || rotation.determinant() < 0.0 || at[3] != [0.0, 0.0, 0.0, 1.0] {
        let expected = "a rotation in the upper left, and 0 0 0 1 as the last row";
        return Err(value_error(Invalid::new(format!("{name}[:3, :3]"), "no rotation", "", expected)));
    }
    Ok(Pose3::from_matrix(rotation, Vector3::new(at[0][3], at[1][3], at[2][3])))
}

/// Rows of a TUM trajectory, shape (N, 8): stamp s, x y z m, qx qy qz qw.
pub fn trajectory_array<'py>(
    py: Python<'py>,
    poses: &[(Stamp, Pose3)],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let row = |(stamp, pose): &(Stamp, Pose3)| {
        let (p, q) = (pose.translation, pose.rotation.coords);
        [seconds(*stamp), p.x, p.y, p.z, q.x, q.y, q.z, q.w]
    };
    from_rows(py, poses.iter().map(row).collect())
}

/// Rows of planar poses, shape (N, 4): stamp s, x m, y m, theta rad.
pub fn planar_array<'py>(py: Python<'py>, poses: &[(Stamp, Pose2)]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let row = |(stamp, pose): &(Stamp, Pose2)| [seconds(*stamp), pose.x, pose.y, pose.theta];
    from_rows(py, poses.iter().map(row).collect())
}

/// A trajectory of such rows.
///
/// # Errors
/// `ValueError` for an invalid stamp or quaternion, with the row.
pub fn trajectory(rows: &[[f64; 8]], name: &str) -> PyResult<Vec<(Stamp, Pose3)>> {
    let pose = |(i, row): (usize, &[f64; 8])| {
        let [seconds, x, y, z, qx, qy, qz, qw] = *row;
        let rotation = Quaternion::new(qw, qx, qy, qz);
        let norm = rotation.norm();
        if (norm - 1.0).abs() > MAX_ROTATION_ERROR || norm.is_nan() {
            let field = format!("norm of the quaternion in row {i} of {name}");
            let expected = "1: columns are stamp s, x y z m, qx qy qz qw";
            return Err(value_error(Invalid::new(field, norm, "", expected)));
        }
        Ok((stamp(seconds)?, Pose3::new(UnitQuaternion::new_normalize(rotation), Vector3::new(x, y, z))))
    };
    rows.iter().enumerate().map(pose).collect()
}
