//! The lens of ROS's camera_info: model and coefficients.

use trundle_core::Distortion;

/// Parts of the names of models that are not a pinhole camera, even with all numbers 0: the distance in the image is the angle from the
/// optical axis, not its tangent. Source: ROS REP 118's image_geometry, Kalibr.
const FISHEYE_MODELS: [&str; 5] = ["equidist", "fisheye", "kannala", "omni", "spherical"];

/// Accepted lenses, and the remedy for another lens.
const EXPECTED: &str = "plumb_bob with up to 5 numbers: rectify the images and give the rectified camera";

/// The lens of model plumb_bob: k1, k2, p1, p2, k3. Other models, except fisheyes, are accepted if all their additional numbers are 0.
///
/// # Errors
/// The accepted lens, if the lens is another.
pub(super) fn lens_of(model: Option<&str>, numbers: &[f64]) -> Result<Distortion, &'static str> {
    let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
    let is_pinhole = match model {
        None => true,
        Some("plumb_bob" | "rational_polynomial" | "") => numbers.iter().skip(5).all(|number| *number == 0.0),
        Some(model) => !is_fisheye(model) && numbers.iter().all(|number| *number == 0.0),
    };
    if !is_pinhole {
        return Err(EXPECTED);
    }
    Ok(Distortion { k1: at(0), k2: at(1), p1: at(2), p2: at(3), k3: at(4) })
}

/// Whether a lens model is a fisheye's.
fn is_fisheye(model: &str) -> bool {
    let model = model.to_lowercase();
    FISHEYE_MODELS.iter().any(|part| model.contains(part))
}
