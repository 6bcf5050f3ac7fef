//! Checks of cameras and image sizes.

use trundle_core::{Invalid, PinholeCamera};

/// Whether both cameras see the same rays in the same pixels; the readout time does not matter.
pub(super) fn is_same_lens(a: &PinholeCamera, b: &PinholeCamera) -> bool {
    let lens = |c: &PinholeCamera| (c.width(), c.height(), c.fx(), c.fy(), c.cx(), c.cy(), c.distortion());
    lens(a) == lens(b)
}

/// Refuses an image whose size differs from its camera's.
///
/// # Errors
/// When the sizes differ.
pub(super) fn check_size(
    place: &str,
    width: usize,
    height: usize,
    camera: &PinholeCamera,
) -> Result<(), Invalid> {
    if (width, height) == (camera.width(), camera.height()) {
        return Ok(());
    }
    let expected = format!("{} x {} as its camera", camera.width(), camera.height());
    Err(Invalid::new(format!("size of the {place}"), format!("{width} x {height}"), "px", expected))
}
