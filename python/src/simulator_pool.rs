//! Several simulators with a laser, stepped by all cores: the vectorised environment's world.

use crate::arrays::{array, from_list, from_rows, slice};
use crate::errors::value_error;
use crate::scan::range_of;
use crate::sim_drive::drive;
use crate::simulator::{sim_config, simulator};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;
use trundle::core::{Invalid, Pose2, SensorEvent, Twist2};
use trundle::sim::{SimConfig, Simulator as Sim};

/// Simulated robots with a laser, one for each seed, stepped by all cores.
///
/// `scene`, `laser` and `noise` as for `Simulator`.
///
/// >>> import numpy as np
/// >>> pool = trundle.SimulatorPool("corridor-a", [1, 2, 3], "lds-01")
/// >>> pool.step(np.tile([0.1, 0.0], (3, 1)), duration=0.2)
/// >>> len(pool), pool.ranges().shape, pool.poses().shape
/// (3, (3, 360), (3, 3))
#[pyclass(module = "trundle")]
pub struct SimulatorPool {
    scene: String,
    config: SimConfig,
    worlds: Vec<World>,
}

/// A simulator and its newest ranges.
struct World {
    simulator: Sim,
    ranges: Vec<f32>,
}

#[pymethods]
impl SimulatorPool {
    #[new]
    #[pyo3(signature = (scene, seeds, laser, *, noise=true))]
    fn new(py: Python<'_>, scene: String, seeds: Vec<u64>, laser: &str, noise: bool) -> PyResult<Self> {
        let config = sim_config(None, Some(laser), noise)?;
        let worlds = py.detach(|| {
            seeds.par_iter().map(|seed| World::new(&scene, *seed, &config)).collect::<PyResult<Vec<World>>>()
        })?;
        Ok(Self { scene, config, worlds })
    }

    /// Restarts the worlds of these indices, each with its seed.
    fn reset(&mut self, py: Python<'_>, indices: Vec<usize>, seeds: Vec<u64>) -> PyResult<()> {
        let count = self.worlds.len();
        if indices.len() != seeds.len() || indices.iter().any(|index| *index >= count) {
            let problem = format!("{} indices and {} seeds", indices.len(), seeds.len());
            let expected = format!("as many of each, indices below {count}");
            return Err(value_error(Invalid::new("reset", problem, "", expected)));
        }
        let fresh = py.detach(|| {
            let make = |seed: &u64| World::new(&self.scene, *seed, &self.config);
            seeds.par_iter().map(make).collect::<PyResult<Vec<World>>>()
        })?;
        for (index, world) in indices.into_iter().zip(fresh) {
            self.worlds[index] = world;
        }
        Ok(())
    }

    /// Drives each robot with its row of `twists`, float64 (N, 2): v m/s, omega rad/s, for `duration` s. A robot with v = NaN is skipped.
    fn step(&mut self, py: Python<'_>, twists: &Bound<'_, PyAny>, duration: f64) -> PyResult<()> {
        let shape = format!("({}, 2)", self.worlds.len());
        let array = array::<f64, numpy::Ix2>(twists, "twists", &shape)?;
        if array.shape() != [self.worlds.len(), 2] {
            let found = array.shape();
            return Err(value_error(format!(
                "twists has shape {found:?}, expected a numpy array of dtype float64 and shape {shape}"
            )));
        }
        let twists = slice(&array, "twists")?.as_chunks::<2>().0.to_vec();
        py.detach(|| {
            let pairs = self.worlds.par_iter_mut().zip(twists).filter(|(_, [v, _])| !v.is_nan());
            pairs.map(|(world, [v, omega])| world.step(Twist2::new(v, omega), duration)).collect()
        })
    }

    /// Newest ranges, m, float32 (N, beams): infinity for a beam without a hit, NaN for an unknown range.
    fn ranges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let beams = self.worlds.first().map_or(0, |world| world.ranges.len());
        let all: Vec<f32> = self.worlds.iter().flat_map(|world| world.ranges.iter().copied()).collect();
        PyArray1::from_vec(py, all).reshape([self.worlds.len(), beams])
    }

    /// `world_from_base`, (N, 3): x m, y m, theta rad.
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        from_rows(py, self.worlds.iter().map(|world| row(world.simulator.true_pose())).collect())
    }

    /// Goals of the scenes, world frame, (N, 3): x m, y m, theta rad.
    fn goals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        from_rows(py, self.worlds.iter().map(|world| row(world.simulator.scene().goal)).collect())
    }

    /// Separate contacts of each robot so far, uint32 (N,).
    fn contacts<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        from_list(py, self.worlds.iter().map(|world| world.simulator.contacts()).collect())
    }

    /// Distance of each robot to the nearest obstacle, m, (N,).
    fn clearances<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        from_list(py, self.worlds.iter().map(|world| world.simulator.clearance()).collect())
    }

    /// Largest range of the laser, m.
    #[getter]
    fn range_max(&self) -> f64 {
        self.config.laser.as_ref().map_or(0.0, |laser| laser.range_max)
    }

    fn __len__(&self) -> usize {
        self.worlds.len()
    }
}

impl World {
    fn new(scene: &str, seed: u64, config: &SimConfig) -> PyResult<Self> {
        let beams = config.laser.as_ref().map_or(0, |laser| laser.beams);
        let simulator = simulator(scene, seed, None, config.clone())?;
        Ok(Self { simulator, ranges: vec![f32::NAN; beams] })
    }

    fn step(&mut self, twist: Twist2, duration: f64) -> PyResult<()> {
        let events = drive(&mut self.simulator, twist, duration).map_err(value_error)?;
        let scan = events.iter().rev().find_map(|event| match event {
            SensorEvent::Scan(scan) => Some(scan),
            _ => None,
        });
        if let Some(scan) = scan {
            self.ranges = scan.beams().iter().map(|beam| range_of(beam) as f32).collect();
        }
        Ok(())
    }
}

fn row(pose: Pose2) -> [f64; 3] {
    [pose.x, pose.y, pose.theta]
}
