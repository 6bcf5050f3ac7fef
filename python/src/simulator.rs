//! The simulator: a Kobuki with camera and laser in a scene.

use crate::camera::Camera;
use crate::errors::{app_error, value_error};
use crate::event_kinds::event_object;
use crate::geometry::{pose2_array, pose3_array};
use crate::numbers::{pose2, seconds, twist};
use crate::rgbd::Rgbd;
use crate::scan::Scan;
use crate::sim_drive::drive;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyStopIteration;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trundle::core::{Invalid, Pose2, RobotBody, SensorEvent};
use trundle::experiments::simulated::{MeshOptions, SceneOptions, load_scene};
use trundle::io::{CameraModel, KINECT_V2_DEPTH_SCALE};
use trundle::sim::{LaserConfig, Preset, Scene, SimConfig, Simulator as Sim};

/// A simulated Kobuki with camera and laser in a scene.
///
/// `scene` is one of `Simulator.scenes()`, or a file: a scene (TOML), a mesh (glTF), a map (YAML). `seed` is the seed of scene and noise.
/// `camera` is "kinect-v2", "kinect-v1" or None; `laser` "rplidar-a1", "urg-04lx", "ust-10lx", "lds-01" or None; `noise` switches the noise
/// of all sensors; `start` (x m, y m, theta rad, world frame) replaces the scene's.
///
/// >>> simulator = trundle.Simulator("room", seed=1)
/// >>> events = simulator.step((0.2, 0.0), duration=0.2)
/// >>> simulator.stamp, simulator.rgbd().rgb.shape, simulator.truth()["contacts"]
/// (0.2, (424, 512, 3), 0)
#[pyclass(module = "trundle")]
pub struct Simulator {
    simulator: Sim,
    image: Option<Py<Rgbd>>,
    scan: Option<Py<Scan>>,
}

#[pymethods]
impl Simulator {
    #[new]
    #[pyo3(signature = (scene="demo", seed=0, *, camera="kinect-v2", laser=None, noise=true, start=None))]
    fn new(
        py: Python<'_>,
        scene: &str,
        seed: u64,
        camera: Option<&str>,
        laser: Option<&str>,
        noise: bool,
        start: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let config = sim_config(camera, laser, noise)?;
        let start = start.map(|start| pose2(start, "start")).transpose()?;
        let simulator = py.detach(|| simulator(scene, seed, start, config))?;
        Ok(Self { simulator, image: None, scan: None })
    }

    /// Names of the built-in scenes.
    #[staticmethod]
    fn scenes() -> Vec<&'static str> {
        Scene::NAMES.to_vec()
    }

    /// Drives with `twist` (v m/s, omega rad/s) for `duration` s, in whole milliseconds. Returns the list of sensor events of that time, by
    /// rising stamp.
    #[pyo3(signature = (twist, duration=0.1))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        twist: &Bound<'py, PyAny>,
        duration: f64,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let twist = self::twist(twist, "twist")?;
        let events = py.detach(|| drive(&mut self.simulator, twist, duration)).map_err(value_error)?;
        events.into_iter().map(|event| self.noted(py, event)).collect()
    }

    /// The next sensor event, for a loop of `next_event`, `Robot.step` and `command`.
    fn next_event<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let event = py.detach(|| self.simulator.next_event()).map_err(value_error)?;
        match event {
            Some(event) => self.noted(py, event),
            None => Err(PyStopIteration::new_err("the simulator has ended")),
        }
    }

    /// Commands the base to drive with `twist` (v m/s, omega rad/s) until the next command.
    fn command(&mut self, twist: &Bound<'_, PyAny>) -> PyResult<()> {
        let twist = self::twist(twist, "twist")?;
        self.simulator.command(twist).map_err(value_error)
    }

    /// The newest image; None before the first, or without a camera.
    fn rgbd(&self, py: Python<'_>) -> Option<Py<Rgbd>> {
        self.image.as_ref().map(|image| image.clone_ref(py))
    }

    /// The newest scan; None before the first, or without a laser.
    fn scan(&self, py: Python<'_>) -> Option<Py<Scan>> {
        self.scan.as_ref().map(|scan| scan.clone_ref(py))
    }

    /// The present truth, a dictionary: `stamp` s, `pose` (3,) `world_from_base`, `contacts` so far, `clearance` m to the nearest obstacle,
    /// `path_length` m driven.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let simulator = &self.simulator;
        let dict = PyDict::new(py);
        dict.set_item("stamp", seconds(simulator.stamp()))?;
        dict.set_item("pose", pose2_array(py, simulator.true_pose()))?;
        dict.set_item("contacts", simulator.contacts())?;
        dict.set_item("clearance", simulator.clearance())?;
        dict.set_item("path_length", simulator.path_length())?;
        Ok(dict)
    }

    /// Present time of the simulation, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.simulator.stamp())
    }

    /// Start of the robot, `world_from_base`, (3,): x m, y m, theta rad.
    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.simulator.scene().start)
    }

    /// The scene's goal, `world_from_goal`, (3,): x m, y m, theta rad.
    #[getter]
    fn goal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.simulator.scene().goal)
    }

    /// The scene's goal in the frame of the start (a robot's map frame), (3,): x m, y m, theta rad.
    #[getter]
    fn start_from_goal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.simulator.scene().start_from_goal())
    }

    /// The camera; its images have float32 depth in metres.
    #[getter]
    fn camera(&self) -> Camera {
        let camera = *self.simulator.camera();
        Camera { model: CameraModel { camera, depth_scale: KINECT_V2_DEPTH_SCALE } }
    }

    /// Mount of the camera, (4, 4), m.
    #[getter]
    fn base_from_camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        pose3_array(py, self.simulator.config().base_from_camera)
    }

    fn __repr__(&self) -> String {
        let simulator = &self.simulator;
        format!("Simulator('{}', at {} s)", simulator.scene().name, seconds(simulator.stamp()))
    }
}

impl Simulator {
    /// The object of an event; stores an image or a scan as the newest one.
    fn noted<'py>(&mut self, py: Python<'py>, event: SensorEvent) -> PyResult<Bound<'py, PyAny>> {
        let object = event_object(py, event)?;
        if let Ok(image) = object.cast::<Rgbd>() {
            self.image = Some(image.clone().unbind());
        } else if let Ok(scan) = object.cast::<Scan>() {
            self.scan = Some(scan.clone().unbind());
        }
        Ok(object)
    }
}

/// The simulated robot with these sensors.
pub fn sim_config(camera: Option<&str>, laser: Option<&str>, noise: bool) -> PyResult<SimConfig> {
    let mut config = match camera {
        Some(name) => preset("camera", name, &SimConfig::CAMERAS)?,
        None => SimConfig::default(),
    };
    config.has_camera = camera.is_some();
    config.laser = laser.map(|name| preset("laser", name, &LaserConfig::PRESETS)).transpose()?;
    Ok(if noise { config } else { config.without_noise() })
}

fn preset<T>(field: &str, name: &str, presets: &[Preset<T>]) -> PyResult<T> {
    let found = presets.iter().find(|(own, ..)| *own == name);
    found.map(|(.., make)| make()).ok_or_else(|| {
        let names: Vec<&str> = presets.iter().map(|(name, ..)| *name).collect();
        value_error(Invalid::new(field, name, "", format!("one of {}", names.join(", "))))
    })
}

/// A robot in the scene of a name or file, with `seed` for scene and noise.
pub fn simulator(scene: &str, seed: u64, start: Option<Pose2>, config: SimConfig) -> PyResult<Sim> {
    let options = SceneOptions { seed, mesh: MeshOptions::default(), start, station: None };
    let scene = load_scene(scene, options).map_err(app_error)?;
    Sim::new(scene, config, seed).map_err(value_error)
}
