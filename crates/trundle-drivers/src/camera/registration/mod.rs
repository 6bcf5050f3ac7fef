//! Depth and colour of different cameras brought into one image.
//!
//! **Problem.** Depth and colour come from two lenses a few centimetres apart, with different sizes, focal lengths and distortion.
//! [`RgbdImage`] needs both pixel for pixel.
//!
//! **Idea.** Each depth pixel is a small square facing the depth camera. It is projected into the output camera, and the nearest square is
//! visible in each output pixel (a z-buffer). Neighbours on one surface share their edges, which prevents holes if the output has more
//! pixels. Depth within a square follows the slope to the neighbours. Colour is sampled along the same rays without depth, because the
//! output camera has the optical centre of the colour camera.
//!
//! **Cost.** One projection a depth pixel and one comparison a covered output pixel; no memory after the first frame.
//!
//! Source: splatting by the projected footprint, \[Westover90\]; the z-buffer, \[Catmull74\].

mod checks;
mod color_map;
mod footprints;
mod projection;

use self::checks::{check_size, is_same_lens};
use self::{color_map::ColorMap, footprints::Footprints, projection::Projection};
use crate::camera::CameraInfo;
use trundle_core::{ColorImage, DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Stamp};

/// Registers the depth and colour of one camera into one output camera.
#[derive(Debug, Clone)]
pub struct Registration {
    output: PinholeCamera,
    color: ColorMap,
    depth: DepthRegistration,
}

impl Registration {
    /// A registration for the streams of a camera; the result is an image of the camera `output`. `output` has the optical centre and the
    /// direction of the colour camera. `None` is the colour camera itself with its distortion.
    pub fn new(info: &CameraInfo, output: Option<PinholeCamera>) -> Self {
        let output = output.unwrap_or(info.color.camera);
        let depth = DepthRegistration::new(info.depth.camera, info.color_from_depth, output);
        Self { output, color: ColorMap::new(info.color.camera, output), depth }
    }

    /// The camera of the result.
    pub fn output(&self) -> &PinholeCamera {
        &self.output
    }

    /// The registered image, taken at `stamp`.
    ///
    /// # Errors
    /// When the size of an image differs from its camera's.
    pub fn register(
        &mut self,
        stamp: Stamp,
        color: &ColorImage,
        depth: &DepthImage,
    ) -> Result<RgbdImage, Invalid> {
        let mut colors = ColorImage::filled(self.output.width(), self.output.height(), [0; 3]);
        let mut depths = DepthImage::filled(self.output.width(), self.output.height(), 0.0);
        self.color.remap(color, &mut colors)?;
        self.depth.register(depth, &mut depths)?;
        RgbdImage::new(stamp, colors, depths)
    }
}

/// Moves the depth image of one camera into another camera.
#[derive(Debug, Clone)]
pub struct DepthRegistration {
    output: PinholeCamera,
    /// `None` if both cameras are the same.
    moved: Option<(Projection, Footprints)>,
}

impl DepthRegistration {
    /// From `depth` into `output`. `output_from_depth` is the pose of the depth camera in the output camera's frame; `None` means equal
    /// poses, as for registered depth.
    pub fn new(depth: PinholeCamera, output_from_depth: Option<Pose3>, output: PinholeCamera) -> Self {
        let is_same = output_from_depth.is_none() && is_same_lens(&depth, &output);
        let pose = output_from_depth.unwrap_or_default();
        let moved =
            || (Projection::new(&depth, pose, output), Footprints::new(depth.width(), depth.height()));
        Self { output, moved: (!is_same).then(moved) }
    }

    /// Writes the moved depth \[m\] into `moved`, which has the size of the output camera; 0 if no depth pixel lands.
    ///
    /// # Errors
    /// When the size of `depth` differs from the depth camera's, or that of `moved` from the output camera's.
    pub fn register(&mut self, depth: &DepthImage, moved: &mut DepthImage) -> Result<(), Invalid> {
        check_size("registered depth image", moved.width(), moved.height(), &self.output)?;
        let Some((projection, footprints)) = &mut self.moved else {
            check_size("depth image", depth.width(), depth.height(), &self.output)?;
            moved.data_mut().copy_from_slice(depth.data());
            return Ok(());
        };
        check_size("depth image", depth.width(), depth.height(), projection.depth_camera())?;
        projection.project(depth, footprints);
        footprints.splat(depth, moved);
        Ok(())
    }
}
