//! The numbers of a camera file, of whatever form.

use super::depth_scale::checked_depth_scale;
use trundle_core::{Distortion, Invalid, PinholeCamera};

/// The numbers of a camera file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CameraFields {
    pub size: (usize, usize),
    pub focal: (f64, f64),
    pub centre: (f64, f64),
    pub lens: Distortion,
    /// Units a metre, where the file holds them.
    pub depth_scale: Option<f64>,
    /// Readout time, s.
    pub readout: f64,
}

impl CameraFields {
    /// The camera, where the numbers make one.
    pub(super) fn camera(&self) -> Result<PinholeCamera, Invalid> {
        self.depth_scale.map_or(Ok(1.0), checked_depth_scale)?;
        PinholeCamera::new(self.size, self.focal, self.centre, self.lens)?.with_readout(self.readout)
    }
}
