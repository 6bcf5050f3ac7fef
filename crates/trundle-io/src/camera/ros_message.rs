//! The camera of a camera_info message.

use super::fields::CameraFields;
use super::matrix::{CameraMatrix, MatrixOrder};
use super::ros_lens::lens_of;
use trundle_core::{Invalid, PinholeCamera};

/// The numbers of a camera_info message: size, camera matrix row by row, lens.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct InfoNumbers {
    pub(crate) size: (usize, usize),
    pub(crate) matrix: [f64; 9],
    pub(crate) model: String,
    pub(crate) lens: Vec<f64>,
}

/// The camera of the numbers.
///
/// # Errors
/// When the size or a number is not accepted, or the lens is not of model plumb_bob.
pub(crate) fn camera_of_info(info: &InfoNumbers) -> Result<PinholeCamera, Invalid> {
    let matrix = CameraMatrix::parse("camera matrix", &info.matrix, MatrixOrder::RowByRow)?;
    let lens = lens_of(Some(&info.model), &info.lens)
        .map_err(|expected| Invalid::new("distortion_model", &info.model, "", expected))?;
    let CameraMatrix { focal, centre } = matrix;
    CameraFields { size: info.size, focal, centre, lens, depth_scale: None, readout: None }.camera()
}
