//! Recorded sequences: folders of the TUM RGB-D benchmark, trajectories and laser logs.

use crate::arrays::rows;
use crate::errors::io_error;
use crate::geometry::{planar_array, pose2_array, trajectory_array};
use crate::numbers::seconds;
use crate::rgbd::Rgbd;
use crate::scan::Scan;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use std::path::PathBuf;
use trundle::io::{
    LaserLogOptions, TUM_DEPTH_SCALE, TumSequence as Sequence, read_laser_log as read_log,
    read_trajectory as read_poses, replace_file, trajectory_text,
};

/// A folder of the TUM RGB-D benchmark: a list of `Rgbd`, each read on access.
///
/// `depth_scale` is the number of units of depth images per metre, by default 5000; `max_difference` s is the largest difference of the
/// stamps of a frame's colour and depth image, by default 0.02.
///
/// >>> trundle.TumSequence("/no/such/folder")
/// Traceback (most recent call last):
/// ...
/// FileNotFoundError: cannot read /no/such/folder...
#[pyclass(frozen, module = "trundle")]
pub struct TumSequence {
    sequence: Sequence,
}

#[pymethods]
impl TumSequence {
    #[new]
    #[pyo3(signature = (folder, depth_scale=None, max_difference=None))]
    fn new(
        py: Python<'_>,
        folder: PathBuf,
        depth_scale: Option<f64>,
        max_difference: Option<f64>,
    ) -> PyResult<Self> {
        let depth_scale = depth_scale.unwrap_or(TUM_DEPTH_SCALE);
        let max_difference = max_difference.unwrap_or(Sequence::MAX_DIFFERENCE);
        let sequence =
            py.detach(|| Sequence::open(&folder, depth_scale, max_difference)).map_err(io_error)?;
        Ok(Self { sequence })
    }

    fn __len__(&self) -> usize {
        self.sequence.len()
    }

    /// Reads and decodes an image.
    fn __getitem__(&self, py: Python<'_>, index: isize) -> PyResult<Rgbd> {
        self.load(py, self.index(index)?)
    }

    fn __iter__(slf: Bound<'_, Self>) -> TumImages {
        TumImages { sequence: slf.unbind(), next: 0 }
    }

    /// Stamps of the images, s, (N,).
    fn stamps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let stamps = (0..self.sequence.len()).map(|i| seconds(self.sequence.stamp(i))).collect();
        crate::arrays::from_list(py, stamps)
    }

    /// `world_from_camera`: (N, 8), stamp s, x y z m, qx qy qz qw; None if the folder has no ground truth.
    #[getter]
    fn ground_truth<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.sequence.ground_truth().map(|poses| trajectory_array(py, poses)).transpose()
    }

    /// `odom_from_base`: (N, 4), stamp s, x m, y m, theta rad; None if the folder has no odometry.
    #[getter]
    fn odometry<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.sequence.odometry().map(|poses| planar_array(py, poses)).transpose()
    }

    fn __repr__(&self) -> String {
        format!("TumSequence({} images)", self.sequence.len())
    }
}

/// Iterator over the images of a sequence.
#[pyclass]
struct TumImages {
    sequence: Py<TumSequence>,
    next: usize,
}

#[pymethods]
impl TumImages {
    fn __iter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Rgbd>> {
        let sequence = self.sequence.get();
        if self.next >= sequence.sequence.len() {
            return Ok(None);
        }
        self.next += 1;
        sequence.load(py, self.next - 1).map(Some)
    }
}

impl TumSequence {
    fn load(&self, py: Python<'_>, index: usize) -> PyResult<Rgbd> {
        let image = py.detach(|| self.sequence.load(index)).map_err(|error| io_error(error.source))?;
        Ok(Rgbd { image })
    }

    fn index(&self, index: isize) -> PyResult<usize> {
        let count = self.sequence.len();
        let from_start = if index < 0 { index.checked_add_unsigned(count) } else { Some(index) };
        let found = from_start.and_then(|i| usize::try_from(i).ok()).filter(|i| *i < count);
        found.ok_or_else(|| PyIndexError::new_err(format!("image {index}, expected one of {count}")))
    }
}

/// Rows of a trajectory file (TUM, KITTI, EuRoC): (N, 8), stamp s, x y z m, qx qy qz qw.
#[pyfunction]
pub fn read_trajectory(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let poses = py.detach(|| read_poses(&path)).map_err(io_error)?;
    trajectory_array(py, &poses)
}

/// Writes rows of a trajectory, float64 (N, 8), as a TUM file, atomically.
///
/// >>> import numpy as np
/// >>> trundle.write_trajectory("poses.txt", np.array([[1.5, 0, 0, 0, 0, 0, 0, 1]]))
/// >>> trundle.read_trajectory("poses.txt")
/// array([[1.5, 0. , 0. , 0. , 0. , 0. , 0. , 1. ]])
#[pyfunction]
pub fn write_trajectory(py: Python<'_>, path: PathBuf, trajectory: &Bound<'_, PyAny>) -> PyResult<()> {
    let poses = crate::geometry::trajectory(&rows(trajectory, "trajectory")?, "trajectory")?;
    py.detach(|| replace_file(&path, trajectory_text(&poses).as_bytes())).map_err(io_error)
}

/// A scan of a log, with the odometry at its stamp.
type LoggedScan<'py> = (Bound<'py, PyArray1<f64>>, Scan);

/// Scans of a laser log, a CARMEN log or a ROS bag: a list of (odometry, `Scan`), the odometry (3,): x m, y m, theta rad.
#[pyfunction]
pub fn read_laser_log(py: Python<'_>, path: PathBuf) -> PyResult<Vec<LoggedScan<'_>>> {
    let log = py.detach(|| read_log(&path, &LaserLogOptions::default())).map_err(io_error)?;
    let entry =
        |entry: trundle::io::LaserLogScan| (pose2_array(py, entry.odom_from_base), Scan { scan: entry.scan });
    Ok(log.scans.into_iter().map(entry).collect())
}
