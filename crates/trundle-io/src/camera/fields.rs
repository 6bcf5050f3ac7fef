//! The numbers of a camera file of any format.

use super::depth_scale::checked_depth_scale;
use trundle_core::{Distortion, FOCAL_LENGTH_PER_SIDE, Invalid, PinholeCamera};

/// The numbers of a camera file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CameraFields {
    pub size: (usize, usize),
    pub focal: (f64, f64),
    pub centre: (f64, f64),
    pub lens: Distortion,
    /// Units per metre, if the file holds them.
    pub depth_scale: Option<f64>,
    /// Readout time, s, if the file holds it.
    pub readout: Option<f64>,
}

impl CameraFields {
    /// The camera, if the numbers are valid.
    pub(super) fn camera(&self) -> Result<PinholeCamera, Invalid> {
        self.depth_scale.map_or(Ok(1.0), checked_depth_scale)?;
        let camera = PinholeCamera::new(self.size, self.focal, self.centre, self.lens)?;
        require_focal("fx", self.focal.0, self.size.0)?;
        require_focal("fy", self.focal.1, self.size.1)?;
        require_inside("cx", self.centre.0, self.size.0)?;
        require_inside("cy", self.centre.1, self.size.1)?;
        camera.with_readout(self.readout.unwrap_or(0.0))
    }
}

/// Refuses a focal length that no rectified camera has: it is in mm, or in widths of the image.
fn require_focal(name: &str, value: f64, side: usize) -> Result<(), Invalid> {
    let (low, high) = (FOCAL_LENGTH_PER_SIDE.0 * side as f64, FOCAL_LENGTH_PER_SIDE.1 * side as f64);
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let expected = format!("{low:.0} to {high:.0} px for images of {side} px: is it in pixels?");
    Err(Invalid::new(name, value, "px", expected))
}

/// Refuses a principal point outside the image.
fn require_inside(name: &str, value: f64, side: usize) -> Result<(), Invalid> {
    let last = side as f64 - 1.0;
    if (0.0..=last).contains(&value) {
        return Ok(());
    }
    let expected = format!("0 to {last} px, inside the image: is it of an image of another size?");
    Err(Invalid::new(name, value, "px", expected))
}
