//! The result of tracking an image.

use crate::geometry::{matrix, pose3_array};
use crate::numbers::seconds;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyTuple};
use trundle::slam::{TrackReport, Tracking};

/// Result of tracking an image; unpacks to pose, state and covariance, in this order.
///
/// >>> simulator = trundle.Simulator("room", seed=1)
/// >>> image = next(event for event in simulator.step((0, 0)) if isinstance(event, trundle.Rgbd))
/// >>> track = trundle.RgbdSlam(simulator.camera).track_rgbd(image)
/// >>> track.state, track.is_located, track.is_keyframe, track.inliers <= track.matches <= track.features
/// ('ok', True, True, True)
#[pyclass(frozen, module = "trundle")]
pub struct Track {
    /// The report of the frame.
    pub report: TrackReport,
}

#[pymethods]
impl Track {
    /// Stamp of the image, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.report.stamp)
    }

    /// `visual_from_camera`, homogeneous matrix (4, 4), m: the camera in the frame of the first camera.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        pose3_array(py, self.report.visual_from_camera)
    }

    /// Tracking state: `ok`; `weak` (located by few landmarks); `dead_reckoning` (not located, the last pose moved by the odometry); `lost`
    /// (not located).
    #[getter]
    fn state(&self) -> &'static str {
        match self.report.tracking {
            Tracking::Ok => "ok",
            Tracking::Weak => "weak",
            Tracking::DeadReckoning => "dead_reckoning",
            Tracking::Lost => "lost",
        }
    }

    /// Covariance of the pose as a right perturbation (m, m, m, rad, rad, rad), (6, 6).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.report.covariance)
    }

    /// Whether the pose comes from the image.
    #[getter]
    fn is_located(&self) -> bool {
        self.report.tracking.is_located()
    }

    /// Features found in the image.
    #[getter]
    fn features(&self) -> usize {
        self.report.features
    }

    /// Features matched with landmarks.
    #[getter]
    fn matches(&self) -> usize {
        self.report.matches
    }

    /// Matches that agree with the pose at 95 %.
    #[getter]
    fn inliers(&self) -> usize {
        self.report.inliers
    }

    /// Keyframes in the map after the image.
    #[getter]
    fn keyframes(&self) -> usize {
        self.report.keyframes
    }

    /// Landmarks in the map after the image.
    #[getter]
    fn landmarks(&self) -> usize {
        self.report.landmarks
    }

    /// Whether the image became a keyframe.
    #[getter]
    fn is_keyframe(&self) -> bool {
        self.report.new_keyframe
    }

    /// Whether the pose was found by a similar keyframe, without the motion.
    #[getter]
    fn is_relocalised(&self) -> bool {
        self.report.relocalised
    }

    /// Whether a loop was closed since the last image.
    #[getter]
    fn closed_loop(&self) -> bool {
        self.report.closed_loop.is_some()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        let parts = [
            self.pose(py)?.into_any(),
            self.state().into_pyobject(py)?.into_any(),
            self.covariance(py)?.into_any(),
        ];
        PyTuple::new(py, parts)?.try_iter()
    }

    fn __repr__(&self) -> String {
        let p = self.report.visual_from_camera.translation;
        format!(
            "Track(stamp={}, state='{}', at ({:.3}, {:.3}, {:.3}) m)",
            self.stamp(),
            self.state(),
            p.x,
            p.y,
            p.z
        )
    }
}
