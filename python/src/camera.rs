//! The camera: intrinsics, lens, readout time and unit of depth.

use crate::errors::{io_error, value_error};
use crate::numbers::{numbers, wrong_type};
use pyo3::prelude::*;
use std::path::PathBuf;
use trundle::core::{Distortion, PinholeCamera, require_positive};
use trundle::io::{CameraModel, KINECT_V2_DEPTH_SCALE};

/// A pinhole camera with lens distortion, and the unit of its depth images.
///
/// `width`, `height`, `fx`, `fy`, `cx`, `cy` in px; `distortion` k1, k2, p1, p2, k3 in the order of OpenCV; `readout` s is the time between
/// first and last row of a rolling shutter; `depth_scale` is the number of units of uint16 depth images per metre, by default 1000
/// (millimetres).
///
/// >>> camera = trundle.Camera(640, 480, 525.0, 525.0, 319.5, 239.5, depth_scale=5000)
/// >>> camera.width, camera.fx, camera.depth_scale
/// (640, 525.0, 5000.0)
/// >>> trundle.Camera.named("freiburg1").cx
/// 318.6
#[pyclass(frozen, module = "trundle")]
pub struct Camera {
    /// The camera and its depth scale.
    pub model: CameraModel,
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (width, height, fx, fy, cx, cy, *, distortion=None, readout=0.0, depth_scale=None))]
    #[expect(clippy::too_many_arguments, reason = "the parameters of a camera, by name in Python")]
    fn new(
        width: usize,
        height: usize,
        fx: f64,
        fy: f64,
        cx: f64,
        cy: f64,
        distortion: Option<&Bound<'_, PyAny>>,
        readout: f64,
        depth_scale: Option<f64>,
    ) -> PyResult<Self> {
        let depth_scale = depth_scale.unwrap_or(KINECT_V2_DEPTH_SCALE);
        let lens = match distortion {
            Some(object) => numbers(object, "distortion", "5 numbers: k1, k2, p1, p2, k3")?,
            None => [0.0; 5],
        };
        let [k1, k2, p1, p2, k3] = lens;
        let lens = Distortion { k1, k2, p1, p2, k3 };
        let camera = PinholeCamera::new((width, height), (fx, fy), (cx, cy), lens)
            .and_then(|camera| camera.with_readout(readout))
            .map_err(value_error)?;
        require_positive("depth_scale", depth_scale, "units/m").map_err(value_error)?;
        Ok(Self { model: CameraModel { camera, depth_scale } })
    }

    /// The camera of a preset (freiburg1, freiburg2, freiburg3, kinect_v2) or of a file: TOML of trundle, YAML of ORB-SLAM or ROS, JSON of
    /// Open3D. The depth unit of a file without a depth scale is the millimetre.
    #[staticmethod]
    fn named(name: PathBuf) -> PyResult<Self> {
        let model = CameraModel::named(&name.to_string_lossy()).map_err(io_error)?;
        Ok(Self { model })
    }

    /// Columns, px.
    #[getter]
    fn width(&self) -> usize {
        self.model.camera.width()
    }

    /// Rows, px.
    #[getter]
    fn height(&self) -> usize {
        self.model.camera.height()
    }

    /// Focal length along x, px.
    #[getter]
    fn fx(&self) -> f64 {
        self.model.camera.fx()
    }

    /// Focal length along y, px.
    #[getter]
    fn fy(&self) -> f64 {
        self.model.camera.fy()
    }

    /// Principal point along x, px.
    #[getter]
    fn cx(&self) -> f64 {
        self.model.camera.cx()
    }

    /// Principal point along y, px.
    #[getter]
    fn cy(&self) -> f64 {
        self.model.camera.cy()
    }

    /// Lens: k1, k2, p1, p2, k3 in the order of OpenCV.
    #[getter]
    fn distortion(&self) -> (f64, f64, f64, f64, f64) {
        let Distortion { k1, k2, p1, p2, k3 } = self.model.camera.distortion();
        (k1, k2, p1, p2, k3)
    }

    /// Time between first and last row of a rolling shutter, s.
    #[getter]
    fn readout(&self) -> f64 {
        self.model.camera.readout()
    }

    /// Number of units of uint16 depth images per metre.
    #[getter]
    fn depth_scale(&self) -> f64 {
        self.model.depth_scale
    }

    /// The text of a camera file, to be read by `Camera.named`.
    fn to_toml(&self) -> String {
        self.model.to_toml()
    }

    fn __repr__(&self) -> String {
        let c = &self.model.camera;
        let scale = self.model.depth_scale;
        format!(
            "Camera({}, {}, {}, {}, {}, {}, depth_scale={scale})",
            c.width(),
            c.height(),
            c.fx(),
            c.fy(),
            c.cx(),
            c.cy()
        )
    }
}

/// A camera, or the name of one ([`Camera::named`]), with this depth scale if given.
pub fn camera_model(object: &Bound<'_, PyAny>, depth_scale: Option<f64>) -> PyResult<CameraModel> {
    let model = if let Ok(camera) = object.cast::<Camera>() {
        camera.get().model
    } else if let Ok(name) = object.extract::<PathBuf>() {
        Camera::named(name)?.model
    } else {
        return Err(wrong_type(object, "camera", "a Camera, or the name of a preset or file"));
    };
    let depth_scale = depth_scale.unwrap_or(model.depth_scale);
    require_positive("depth_scale", depth_scale, "units/m").map_err(value_error)?;
    Ok(CameraModel { depth_scale, ..model })
}
