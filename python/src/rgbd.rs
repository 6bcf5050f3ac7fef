//! RGB-D images, with pixels shared with numpy.

use crate::arrays::{color_image, depth_image};
use crate::errors::value_error;
use crate::numbers::{seconds, stamp};
use numpy::ndarray::{ArrayView2, ArrayView3};
use numpy::{PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use trundle::core::{RgbdImage, require_positive};
use trundle::io::KINECT_V2_DEPTH_SCALE;

/// A colour image and the depth image registered to it, pixel for pixel.
///
/// `stamp` s; `rgb` uint8 (height, width, 3); `depth` uint16 (height, width) in units of 1 / `depth_scale` m (by default mm), or float32 in
/// metres. A depth of 0, NaN or below 0 is missing. The arrays `rgb` and `depth` are read-only views of the image's pixels.
///
/// >>> import numpy as np
/// >>> image = trundle.Rgbd(0.5, np.zeros((4, 6, 3), np.uint8), np.full((4, 6), 1500, np.uint16))
/// >>> image.rgb.shape, image.depth.dtype, float(image.depth[0, 0])
/// ((4, 6, 3), dtype('float32'), 1.5)
#[pyclass(frozen, module = "trundle")]
pub struct Rgbd {
    /// The image.
    pub image: RgbdImage,
}

#[pymethods]
impl Rgbd {
    #[new]
    #[pyo3(signature = (stamp, rgb, depth, depth_scale=None))]
    fn new(
        stamp: f64,
        rgb: &Bound<'_, PyAny>,
        depth: &Bound<'_, PyAny>,
        depth_scale: Option<f64>,
    ) -> PyResult<Self> {
        let depth_scale = depth_scale.unwrap_or(KINECT_V2_DEPTH_SCALE);
        require_positive("depth_scale", depth_scale, "units/m").map_err(value_error)?;
        Ok(Self { image: rgbd_image(stamp, rgb, depth, depth_scale, PixelMemory::default())? })
    }

    /// When it was taken, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.image.stamp())
    }

    /// Colours, uint8 (height, width, 3): a read-only view of the image's pixels.
    #[getter]
    fn rgb<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let color = slf.get().image.color();
        let shape = (color.height(), color.width(), 3);
        let view = ArrayView3::from_shape(shape, color.data().as_flattened()).map_err(value_error)?;
        // SAFETY: the class is frozen and owns the pixels, and the array holds a reference to it.
        let array = unsafe { PyArray3::borrow_from_array(&view, slf.clone().into_any()) };
        array.try_readwrite().map_err(value_error)?.make_nonwriteable();
        Ok(array)
    }

    /// Depth along the optical axis, m, float32 (height, width), 0 for missing depth: a read-only view of the image's pixels.
    #[getter]
    fn depth<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let depth = slf.get().image.depth();
        let view =
            ArrayView2::from_shape((depth.height(), depth.width()), depth.data()).map_err(value_error)?;
        // SAFETY: as for the colours.
        let array = unsafe { PyArray2::borrow_from_array(&view, slf.clone().into_any()) };
        array.try_readwrite().map_err(value_error)?.make_nonwriteable();
        Ok(array)
    }

    fn __repr__(&self) -> String {
        let color = self.image.color();
        format!("Rgbd(stamp={}, {} x {} px)", self.stamp(), color.width(), color.height())
    }
}

/// Memory of the pixels of an image.
pub type PixelMemory = (Vec<[u8; 3]>, Vec<f32>);

/// An image of two arrays, in memory that may be reused from an earlier image.
pub fn rgbd_image(
    seconds: f64,
    rgb: &Bound<'_, PyAny>,
    depth: &Bound<'_, PyAny>,
    depth_scale: f64,
    memory: PixelMemory,
) -> PyResult<RgbdImage> {
    let (color, depth) = (color_image(rgb, memory.0)?, depth_image(depth, depth_scale, memory.1)?);
    RgbdImage::new(stamp(seconds)?, color, depth).map_err(value_error)
}
