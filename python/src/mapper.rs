//! Maps of laser scans: at known poses, or by a particle filter over raw odometry.

use crate::errors::value_error;
use crate::geometry::{planar_array, pose2_array};
use crate::grid::OccupancyGrid;
use crate::numbers::pose2;
use crate::scan::Scan;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use trundle::mapping::{
    GridMapper as Grid, MapperConfig, ParticleConfig, ParticleMapper as Particles, ScanUpdate,
};

/// An occupancy grid from scans at known poses.
///
/// `resolution` m, the side of a cell; `max_range` m, beyond which rays are truncated; `half_extent` m, the largest distance of the map's
/// edge from its origin.
///
/// >>> import numpy as np
/// >>> mapper = trundle.GridMapper(resolution=0.05)
/// >>> scan = trundle.Scan(0.0, np.full(10, 2.0), 0.0, 0.002, range_max=10.0)
/// >>> for _ in range(4):
/// ...     hits, free, ignored = mapper.insert((0, 0, 0), scan)
/// >>> grid = mapper.grid()
/// >>> grid.at((2.01, 0.01)), grid.at((1.51, 0.01)), grid.at((2.51, 0.01))
/// (100, 0, -1)
#[pyclass(module = "trundle")]
pub struct GridMapper {
    mapper: Grid,
}

#[pymethods]
impl GridMapper {
    #[new]
    #[pyo3(signature = (resolution=0.05, *, max_range=None, half_extent=None))]
    fn new(resolution: f64, max_range: Option<f64>, half_extent: Option<f64>) -> PyResult<Self> {
        let mut config = MapperConfig::default();
        config.resolution = resolution;
        config.max_range = max_range.unwrap_or(config.max_range);
        config.half_extent = half_extent.unwrap_or(config.half_extent);
        Ok(Self { mapper: Grid::new(config).map_err(value_error)? })
    }

    /// Inserts a scan that was taken with the base at `pose` (x m, y m, theta rad, map frame).
    ///
    /// Returns the number of cells hit, of cells that beams passed, and of beams that end off the map.
    fn insert(
        &mut self,
        py: Python<'_>,
        pose: &Bound<'_, PyAny>,
        scan: &Bound<'_, Scan>,
    ) -> PyResult<(usize, usize, usize)> {
        let (pose, scan) = (pose2(pose, "pose")?, &scan.get().scan);
        let done = py.detach(|| self.mapper.insert(pose, scan));
        Ok((done.hits, done.free, done.ignored_beams))
    }

    /// A copy of the map.
    fn grid(&self) -> OccupancyGrid {
        OccupancyGrid { grid: self.mapper.grid().clone() }
    }

    /// Probabilities of occupancy of the map's cells, float32 (rows, columns), 0.5 for unknown cells.
    fn probabilities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let geometry = self.mapper.grid().geometry();
        let cells = PyArray1::from_vec(py, self.mapper.probabilities());
        cells.reshape([geometry.height, geometry.width])
    }

    /// Probability of occupancy at a point (x m, y m) of the map frame, 0.5 for an unknown cell.
    fn probability_at(&self, point: &Bound<'_, PyAny>) -> PyResult<f64> {
        Ok(self.mapper.probability_at(crate::numbers::point(point, "point")?))
    }

    fn __repr__(&self) -> String {
        let geometry = self.mapper.grid().geometry();
        format!("GridMapper({} x {} cells of {} m)", geometry.height, geometry.width, geometry.resolution)
    }
}

/// A map from scans and raw odometry, by a Rao-Blackwellised particle filter with loop closure. The base at the first scan is the map's
/// origin.
///
/// `seed` of the random numbers; `particles`, the number of particles; `resolution` m, the side of a cell.
///
/// >>> simulator = trundle.Simulator("room", 1, camera=None, laser="urg-04lx")
/// >>> mapper = trundle.ParticleMapper(seed=1)
/// >>> events = simulator.step((0.2, 0.1), duration=1.0)
/// >>> scans = [event for event in events if isinstance(event, trundle.Scan)]
/// >>> mapper.update((0, 0, 0), scans[0])
/// 'processed'
/// >>> mapper.grid().resolution, mapper.trajectory().shape
/// (0.05, (1, 4))
#[pyclass(module = "trundle")]
pub struct ParticleMapper {
    mapper: Particles,
}

#[pymethods]
impl ParticleMapper {
    #[new]
    #[pyo3(signature = (seed=0, *, particles=None, resolution=None))]
    fn new(seed: u64, particles: Option<usize>, resolution: Option<f64>) -> PyResult<Self> {
        let mut config = ParticleConfig::default();
        config.map.resolution = resolution.unwrap_or(config.map.resolution);
        config.particles = particles.unwrap_or(config.particles);
        Ok(Self { mapper: Particles::new(config, seed).map_err(value_error)? })
    }

    /// Processes a scan that was taken with the base at `odometry` (x m, y m, theta rad, the wheels' frame).
    ///
    /// Returns `processed`; `still` if the robot has hardly moved and the scan is not used; `refused` for an impossible odometry or stamp;
    /// `lost` or `found` after a map was loaded; `paused` if the last scans contradict the loaded map and are removed from it.
    fn update(
        &mut self,
        py: Python<'_>,
        odometry: &Bound<'_, PyAny>,
        scan: &Bound<'_, Scan>,
    ) -> PyResult<&'static str> {
        let (odometry, scan) = (pose2(odometry, "odometry")?, &scan.get().scan);
        Ok(match py.detach(|| self.mapper.update(odometry, scan)) {
            ScanUpdate::Still => "still",
            ScanUpdate::Refused(_) => "refused",
            ScanUpdate::Processed(_) => "processed",
            ScanUpdate::Lost(_) => "lost",
            ScanUpdate::Paused(_) => "paused",
            ScanUpdate::Found(_) => "found",
        })
    }

    /// Completes work in progress, as after the last scan of a log.
    fn finish(&mut self, py: Python<'_>) {
        py.detach(|| self.mapper.finish());
    }

    /// Pose of the best particle at the last processed scan, map frame, (3,): x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.mapper.pose())
    }

    /// Poses of the processed scans, map frame, (N, 4): stamp s, x m, y m, theta rad.
    fn trajectory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        planar_array(py, &self.mapper.trajectory())
    }

    /// A copy of the best particle's map.
    fn grid(&mut self, py: Python<'_>) -> OccupancyGrid {
        py.detach(|| OccupancyGrid { grid: self.mapper.grid().clone() })
    }

    fn __repr__(&self) -> String {
        format!("ParticleMapper({} poses)", self.mapper.trajectory().len())
    }
}
