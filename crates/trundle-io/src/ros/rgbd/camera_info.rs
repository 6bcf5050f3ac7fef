//! `sensor_msgs/msg/CameraInfo`: intrinsics and lens.

use crate::camera::{InfoNumbers, camera_of_info};
use crate::ros::cdr::{CdrError, CdrReader, Wire};
use crate::ros::messages::{header, types};
use trundle_core::{Invalid, PinholeCamera};

/// The used part of `sensor_msgs/msg/CameraInfo`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CameraInfo {
    pub(super) frame: String,
    numbers: InfoNumbers,
    /// The camera matrix of rectified images, 3 rows of 4.
    projection: [f64; 12],
    /// Pixels of the sensor that a pixel of the image covers, across and down; 0 and 1 mean one.
    binning: [u32; 2],
}

impl CameraInfo {
    pub(super) fn read(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::CAMERA_INFO, bytes, wire)?;
        let (_, frame) = header(&mut r)?;
        let (height, width) = (r.u32("height")? as usize, r.u32("width")? as usize);
        let model = r.string("distortion_model")?;
        let lens = r.f64_list("d")?;
        let matrix = r.f64s("k")?;
        r.f64s::<9>("r")?;
        let projection = r.f64s("p")?;
        let binning = [r.u32("binning_x")?, r.u32("binning_y")?];
        let numbers = InfoNumbers { size: (width, height), matrix, model, lens };
        Ok(Self { frame, numbers, projection, binning })
    }

    /// The camera of raw images, or of rectified ones, which have no distortion.
    ///
    /// # Errors
    /// When a number is not accepted, the lens is a fisheye's, or the sensor is binned.
    pub(super) fn camera(&self, is_rectified: bool) -> Result<PinholeCamera, Invalid> {
        if let Some(binning) = self.binning.iter().find(|binning| **binning > 1) {
            return Err(Invalid::new("binning", binning, "px", "0 or 1: give the camera with --camera"));
        }
        if !is_rectified {
            return camera_of_info(&self.numbers);
        }
        let [fx, skew, cx, _, a, fy, cy, _, b, c, scale, _] = self.projection;
        let numbers = InfoNumbers {
            matrix: [fx, skew, cx, a, fy, cy, b, c, scale],
            lens: Vec::new(),
            model: String::new(),
            ..self.numbers.clone()
        };
        camera_of_info(&numbers)
    }
}
