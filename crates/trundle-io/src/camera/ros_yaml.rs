//! ROS's camera_info as YAML: what camera_calibration writes, and what `ros2 topic echo` prints.

use super::fields::CameraFields;
use super::image_side::image_side;
use super::matrix::{CameraMatrix, MatrixOrder};
use crate::IoError;
use crate::yaml_document::{YamlDocument, YamlValue};
use std::path::Path;
use trundle_core::Distortion;

/// Parts of the names of models whose image is no pinhole camera's, also with all numbers 0: there the angle from the optical
/// axis, not its tangent, is the distance in the image. Source: ROS REP 118's image_geometry, Kalibr.
const FISHEYE_MODELS: [&str; 5] = ["equidist", "fisheye", "kannala", "omni", "spherical"];

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
        readout: 0.0,
    };
    fields.camera().map_err(IoError::field(path))?;
    Ok(fields)
}

/// Whether a lens model is a fisheye's.
fn is_fisheye(model: &str) -> bool {
    let model = model.to_lowercase();
    FISHEYE_MODELS.iter().any(|part| model.contains(part))
}

/// The lens of model plumb_bob: k1, k2, p1, p2, k3. Other models but fisheyes pass where all that they add is 0.
fn lens(document: &YamlDocument<'_>) -> Result<Distortion, IoError> {
    let key = document.first_of(&["distortion_coefficients.data", "D", "d"]);
    let numbers = if document.get(key).is_some() {
        document.numbers(key, "the numbers of the lens")?
    } else {
        Vec::new()
    };
    let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
    let is_pinhole = match document.get("distortion_model") {
        Some(YamlValue::Text(model))
            if model == "plumb_bob" || model == "rational_polynomial" || model.is_empty() =>
        {
            numbers.iter().skip(5).all(|number| *number == 0.0)
        }
        Some(YamlValue::Text(model)) if is_fisheye(model) => false,
        Some(_) => numbers.iter().all(|number| *number == 0.0),
        None => true,
    };
    match document.get("distortion_model") {
        Some(model) if !is_pinhole => {
            let expected = "plumb_bob with up to 5 numbers: rectify the images and give the rectified camera";
            Err(document.wrong("distortion_model", model, expected))
        }
        _ => Ok(Distortion { k1: at(0), k2: at(1), p1: at(2), p2: at(3), k3: at(4) }),
    }
}
