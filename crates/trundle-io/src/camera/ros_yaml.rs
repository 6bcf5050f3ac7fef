//! ROS's camera_info as YAML: what camera_calibration writes, and what `ros2 topic echo` prints.

use super::fields::CameraFields;
use super::image_side::image_side;
use super::matrix::{CameraMatrix, MatrixOrder};
use super::ros_lens::lens_of;
use crate::IoError;
use crate::yaml_document::{YamlDocument, YamlValue};
use std::path::Path;
use trundle_core::Distortion;

/// The numbers of a camera_info file.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let document = YamlDocument::parse(path, text)?;
    let numbers = document.numbers(
        document.first_of(&["camera_matrix.data", "K", "k"]),
        "the 9 numbers of the camera matrix",
    )?;
    let matrix = CameraMatrix::parse("camera_matrix", &numbers, MatrixOrder::RowByRow)
        .map_err(|invalid| document.invalid(invalid))?;
    let fields = CameraFields {
        size: (
            image_side(&document, &["image_width", "width"])?,
            image_side(&document, &["image_height", "height"])?,
        ),
        focal: matrix.focal,
        centre: matrix.centre,
        lens: lens(&document)?,
        depth_scale: None,
        readout: None,
    };
    fields.camera().map_err(IoError::field(path))?;
    Ok(fields)
}

/// The lens of model plumb_bob: k1, k2, p1, p2, k3. Other models, except fisheyes, are accepted if all their additional numbers are 0.
fn lens(document: &YamlDocument<'_>) -> Result<Distortion, IoError> {
    let key = document.first_of(&["distortion_coefficients.data", "D", "d"]);
    let numbers = if document.get(key).is_some() {
        document.numbers(key, "the numbers of the lens")?
    } else {
        Vec::new()
    };
    let model = match document.get("distortion_model") {
        Some(YamlValue::Text(model)) => Some(model.as_str()),
        Some(_) => Some(UNNAMED_MODEL),
        None => None,
    };
    lens_of(model, &numbers).map_err(|expected| {
        let found = document.get("distortion_model").cloned().unwrap_or(YamlValue::Null(()));
        document.wrong("distortion_model", &found, expected)
    })
}

/// A model whose name is not text: its lens is accepted if all numbers are 0.
const UNNAMED_MODEL: &str = "unnamed";
