//! RGB-D SLAM: image arrays in, poses out.

use crate::arrays::from_rows;
use crate::camera::camera_model;
use crate::errors::{io_error, value_error};
use crate::geometry::{pose3, trajectory_array};
use crate::numbers::pose2;
use crate::rgbd::{PixelMemory, Rgbd, rgbd_image};
use crate::track::Track;
use numpy::{PyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use trundle::core::{CameraMotion, Pose2, Pose3, RgbdImage};
use trundle::estimation::OdometryConfig;
use trundle::io::{CameraModel, IoError, TumSequence, replace_file};
use trundle::slam::{Mode, RgbdSlam as Slam, SlamConfig};

/// RGB-D SLAM with a landmark map, loop closure and relocalisation.
///
/// `camera` is a `Camera`, or the name of a preset or file; `depth_scale` is the number of units of uint16 depth per metre, by default the
/// camera's; `seed` is the seed of the random samples; `base_from_camera` (4, 4) m is the camera's mount, for odometry of the base. The
/// first camera is at the identity.
///
/// >>> import numpy as np
/// >>> simulator = trundle.Simulator("room", seed=1)
/// >>> slam = trundle.RgbdSlam(simulator.camera)
/// >>> for event in simulator.step((0.2, 0.1), duration=0.2):
/// ...     if isinstance(event, trundle.Rgbd):
/// ...         pose, state, covariance = slam.track(event.rgb, event.depth, event.stamp)
/// >>> state, pose.shape, covariance.shape, slam.trajectory().shape
/// ('ok', (4, 4), (6, 6), (4, 8))
/// >>> slam.points().shape[0] > 100
/// True
#[pyclass(module = "trundle")]
pub struct RgbdSlam {
    slam: Slam,
    model: CameraModel,
    base_from_camera: Option<Pose3>,
    /// `odom_from_base` at the last image.
    last_odometry: Option<Pose2>,
    /// Memory of the last image, for reuse.
    memory: PixelMemory,
}

#[pymethods]
impl RgbdSlam {
    #[new]
    #[pyo3(signature = (camera, depth_scale=None, seed=0, *, base_from_camera=None))]
    fn new(
        camera: &Bound<'_, PyAny>,
        depth_scale: Option<f64>,
        seed: u64,
        base_from_camera: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let model = camera_model(camera, depth_scale)?;
        let slam = Slam::new(model.camera, config(seed)).map_err(value_error)?;
        Self::with(slam, model, base_from_camera)
    }

    /// Continues with the maps of a file from `save`. The state is `lost` until a place is recognised.
    #[staticmethod]
    #[pyo3(signature = (path, camera, depth_scale=None, seed=0, *, base_from_camera=None))]
    fn load(
        py: Python<'_>,
        path: PathBuf,
        camera: &Bound<'_, PyAny>,
        depth_scale: Option<f64>,
        seed: u64,
        base_from_camera: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let model = camera_model(camera, depth_scale)?;
        let slam = py.detach(|| {
            let bytes = read_bytes(&path).map_err(io_error)?;
            let problem = |error| value_error(format!("{}: {error}", path.display()));
            Slam::load(&bytes, model.camera, config(seed)).map_err(problem)
        })?;
        Self::with(slam, model, base_from_camera)
    }

    /// Tracks an image: `pose, state, covariance = slam.track(...)`, or a `Track` with more.
    ///
    /// `rgb` uint8 (height, width, 3); `depth` uint16 (height, width) in units of 1 / `depth_scale` m, or float32 in metres; `stamp` s.
    /// `odometry` is the pose of the base by its wheels, (3,): x m, y m, theta rad; or the camera's motion since the last image, (4, 4), m.
    #[pyo3(signature = (rgb, depth, stamp, odometry=None))]
    fn track(
        &mut self,
        py: Python<'_>,
        rgb: &Bound<'_, PyAny>,
        depth: &Bound<'_, PyAny>,
        stamp: f64,
        odometry: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Track> {
        let memory = std::mem::take(&mut self.memory);
        let image = rgbd_image(stamp, rgb, depth, self.model.depth_scale, memory)?;
        let track = self.step(py, &image, odometry);
        let (color, depth) = image.into_images();
        self.memory = (color.into_data(), depth.into_data());
        track
    }

    /// Tracks an `Rgbd` like `track`, without a copy of its pixels.
    #[pyo3(signature = (image, odometry=None))]
    fn track_rgbd(
        &mut self,
        py: Python<'_>,
        image: &Bound<'_, Rgbd>,
        odometry: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Track> {
        self.step(py, &image.get().image, odometry)
    }

    /// Poses of all located images by the present map, `visual_from_camera`: (N, 8), stamp s, x y z m, qx qy qz qw.
    fn trajectory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        trajectory_array(py, &self.slam.trajectory())
    }

    /// Poses of the keyframes, `visual_from_camera`: (N, 8), stamp s, x y z m, qx qy qz qw.
    fn keyframes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let poses: Vec<_> = self.slam.keyframes().map(|(_, stamp, pose)| (stamp, pose)).collect();
        trajectory_array(py, &poses)
    }

    /// Landmarks in the frame of the first camera, m: (N, 3).
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        from_rows(py, self.slam.landmarks().map(Into::into).collect::<Vec<[f64; 3]>>())
    }

    /// Completes the refinement of the map, which `track` does in slices between images.
    fn finish(&mut self, py: Python<'_>) {
        py.detach(|| self.slam.finish_refining());
    }

    /// Declares the pose unknown, after the camera was carried away. The state is `lost` until a place is recognised.
    fn kidnapped(&mut self) {
        self.slam.kidnapped();
        self.last_odometry = None;
    }

    /// Whether the maps change; False for localization only.
    #[getter]
    fn mapping(&self) -> bool {
        self.slam.mode() == Mode::Mapping
    }

    #[setter]
    fn set_mapping(&mut self, mapping: bool) {
        self.slam.set_mode(if mapping { Mode::Mapping } else { Mode::Localisation });
    }

    /// Settings of the camera that the images contradict, one sentence each.
    fn calibration_issues(&self) -> Vec<String> {
        self.slam.calibration_issues().iter().map(ToString::to_string).collect()
    }

    /// Writes all maps to a file, atomically.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| replace_file(&path, &self.slam.save())).map_err(io_error)
    }

    fn __repr__(&self) -> String {
        let (keyframes, landmarks) = (self.slam.keyframes().count(), self.slam.landmarks().count());
        format!("RgbdSlam({keyframes} keyframes, {landmarks} landmarks)")
    }
}

impl RgbdSlam {
    fn with(slam: Slam, model: CameraModel, mount: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let base_from_camera = mount.map(|mount| pose3(mount, "base_from_camera")).transpose()?;
        Ok(Self { slam, model, base_from_camera, last_odometry: None, memory: PixelMemory::default() })
    }

    fn step(
        &mut self,
        py: Python<'_>,
        image: &RgbdImage,
        odometry: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Track> {
        self.require_size(image)?;
        let prior = odometry.map(|odometry| self.prior(odometry)).transpose()?.flatten();
        let report = py.detach(|| self.slam.step(image, prior));
        Ok(Track { report })
    }

    fn require_size(&self, image: &RgbdImage) -> PyResult<()> {
        let (found, camera) = (image.color(), &self.model.camera);
        if (found.width(), found.height()) == (camera.width(), camera.height()) {
            return Ok(());
        }
        Err(value_error(format!(
            "image has {} x {} px, expected {} x {} px as the camera",
            found.width(),
            found.height(),
            camera.width(),
            camera.height()
        )))
    }

    /// The camera's motion since the last image: given as (4, 4), or by the base's odometry (3,).
    fn prior(&mut self, odometry: &Bound<'_, PyAny>) -> PyResult<Option<CameraMotion>> {
        if odometry.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() == 2) {
            return Ok(Some(pose3(odometry, "odometry")?.into()));
        }
        let odom_from_base = pose2(odometry, "odometry")?;
        let Some(base_from_camera) = self.base_from_camera else {
            return Err(value_error(
                "odometry of the base (x, y, theta) needs the camera's mount: RgbdSlam(..., base_from_camera=...), \
                 or give the camera's motion since the last image, shape (4, 4)",
            ));
        };
        let last = self.last_odometry.replace(odom_from_base);
        Ok(last.map(|last| {
            let motion = last.inverse() * odom_from_base;
            CameraMotion::of_base((motion, OdometryConfig::default().by_wheels(&motion)), base_from_camera)
        }))
    }
}

fn config(seed: u64) -> SlamConfig {
    let mut config = SlamConfig::default();
    config.seed = seed;
    config
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, IoError> {
    std::fs::read(path).map_err(|source| IoError::System { path: path.to_owned(), action: "read", source })
}

/// SLAM on a folder of the TUM RGB-D benchmark, without Python between the images: rows of the trajectory, (N, 8).
///
/// The result is bit-identical to `RgbdSlam.track` on each image of a `TumSequence`.
#[pyfunction]
#[pyo3(signature = (folder, camera, depth_scale=None, seed=0))]
pub fn slam_folder<'py>(
    py: Python<'py>,
    folder: PathBuf,
    camera: &Bound<'_, PyAny>,
    depth_scale: Option<f64>,
    seed: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let model = camera_model(camera, depth_scale)?;
    let poses = py.detach(|| {
        let sequence = TumSequence::open(&folder, model.depth_scale, TumSequence::MAX_DIFFERENCE)
            .map_err(io_error)?
            .with_size(model.camera.width(), model.camera.height());
        let mut slam = Slam::new(model.camera, config(seed)).map_err(value_error)?;
        for image in sequence.frames() {
            slam.step(&image.map_err(|error| io_error(error.source))?, None);
        }
        PyResult::Ok(slam.trajectory())
    })?;
    trajectory_array(py, &poses)
}
