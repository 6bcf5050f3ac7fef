//! RGB-D images whose pixels numpy reads in place.

use crate::arrays::{color_image, depth_image};
use crate::errors::value_error;
use crate::numbers::{seconds, stamp};
use numpy::ndarray::{ArrayView2, ArrayView3};
use numpy::{PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use trundle::core::{RgbdImage, require_positive};
use trundle::io::KINECT_V2_DEPTH_SCALE;

/// A colour image and the depth image registered to it.
#[pyclass(frozen, module = "trundle")]
pub struct Rgbd {
    /// The image.
    pub image: RgbdImage,
}

#[pymethods]
impl Rgbd {
    #[new]
    #[pyo3(signature = (stamp, rgb, depth, depth_scale=KINECT_V2_DEPTH_SCALE))]
    fn new(
        stamp: f64,
        rgb: &Bound<'_, PyAny>,
        depth: &Bound<'_, PyAny>,
        depth_scale: f64,
    ) -> PyResult<Self> {
        require_positive("depth_scale", depth_scale, "units/m").map_err(value_error)?;
        Ok(Self { image: rgbd_image(stamp, rgb, depth, depth_scale)? })
    }

    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.image.stamp())
    }

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

    #[getter]
    fn depth<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let depth = slf.get().image.depth();
        let view = ArrayView2::from_shape((depth.height(), depth.width()), depth.data()).map_err(value_error)?;
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

/// An image of two arrays.
pub fn rgbd_image(
    seconds: f64,
    rgb: &Bound<'_, PyAny>,
    depth: &Bound<'_, PyAny>,
    depth_scale: f64,
) -> PyResult<RgbdImage> {
    let (color, depth) = (color_image(rgb)?, depth_image(depth, depth_scale)?);
    RgbdImage::new(stamp(seconds)?, color, depth).map_err(value_error)
}
