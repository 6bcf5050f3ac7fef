//! Open3D's camera intrinsics: JSON.

use super::fields::CameraFields;
use super::matrix::{CameraMatrix, MatrixOrder};
use crate::IoError;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;
use trundle_core::Distortion;

/// The keys of the file, at its top or in a table `intrinsic`.
#[derive(Deserialize)]
struct Intrinsics {
    width: usize,
    height: usize,
    /// Column by column.
    intrinsic_matrix: Vec<f64>,
    #[serde(default)]
    depth_scale: Option<f64>,
}

/// The numbers of a file.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let mut value: Value = serde_json::from_str(text).map_err(|error| {
        IoError::line(path, error.line(), "no valid JSON, expected Open3D's camera intrinsics")
    })?;
    if let Some(inner) = value.get_mut("intrinsic").map(Value::take) {
        value = inner;
    }
    let file = Intrinsics::deserialize(value).map_err(|_| {
        IoError::malformed(
            path,
            "expected width, height (px) and intrinsic_matrix, 9 numbers, as Open3D writes them",
        )
    })?;
    let matrix = CameraMatrix::parse("intrinsic_matrix", &file.intrinsic_matrix, MatrixOrder::ColumnByColumn)
        .map_err(IoError::field(path))?;
    let fields = CameraFields {
        size: (file.width, file.height),
        focal: matrix.focal,
        centre: matrix.centre,
        lens: Distortion::default(),
        depth_scale: file.depth_scale,
        readout: None,
    };
    fields.camera().map_err(IoError::field(path))?;
    Ok(fields)
}
