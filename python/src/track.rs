//! The result of tracking an image.

use crate::geometry::{matrix, pose3_array};
use crate::numbers::seconds;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyTuple};
use trundle::slam::{TrackReport, Tracking};

/// Pose, state and covariance of an image, in this order when unpacked.
#[pyclass(frozen, module = "trundle")]
pub struct Track {
    /// The report of the frame.
    pub report: TrackReport,
}

#[pymethods]
impl Track {
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.report.stamp)
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        pose3_array(py, self.report.visual_from_camera)
    }

    #[getter]
    fn state(&self) -> &'static str {
        match self.report.tracking {
            Tracking::Ok => "ok",
            Tracking::Weak => "weak",
            Tracking::DeadReckoning => "dead_reckoning",
            Tracking::Lost => "lost",
        }
    }

    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.report.covariance)
    }

    #[getter]
    fn is_located(&self) -> bool {
        self.report.tracking.is_located()
    }

    #[getter]
    fn features(&self) -> usize {
        self.report.features
    }

    #[getter]
    fn matches(&self) -> usize {
        self.report.matches
    }

    #[getter]
    fn inliers(&self) -> usize {
        self.report.inliers
    }

    #[getter]
    fn keyframes(&self) -> usize {
        self.report.keyframes
    }

    #[getter]
    fn landmarks(&self) -> usize {
        self.report.landmarks
    }

    #[getter]
    fn is_keyframe(&self) -> bool {
        self.report.new_keyframe
    }

    #[getter]
    fn is_relocalised(&self) -> bool {
        self.report.relocalised
    }

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
