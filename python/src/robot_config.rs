//! The robot's settings: a robot file with overrides.

use crate::errors::{app_error, value_error};
use crate::numbers::wrong_type;
use pyo3::prelude::*;
use std::path::PathBuf;
use trundle::core::Footprint;
use trundle::runtime::RobotConfig as Config;
use trundle::runtime::settings::to_commented_toml;

/// The settings of a robot: a robot file (TOML), or a Kobuki with a Kinect V2. Each of `overrides`, "key=value" in TOML, replaces a
/// setting.
///
/// `seed` is the seed of the robot's random samples.
///
/// >>> config = trundle.RobotConfig(overrides=["footprint_radius_m=0.25"])
/// >>> config.footprint, config.max_speed > 0
/// (0.25, True)
#[pyclass(frozen, module = "trundle")]
pub struct RobotConfig {
    /// The settings.
    pub config: Config,
}

#[pymethods]
impl RobotConfig {
    #[new]
    #[pyo3(signature = (file=None, overrides=Vec::new(), *, seed=None))]
    fn new(file: Option<PathBuf>, overrides: Vec<String>, seed: Option<u64>) -> PyResult<Self> {
        let config = trundle::app::load_robot(file.as_deref(), &overrides).map_err(app_error)?;
        let config = config.validated().map_err(value_error)?;
        Ok(Self { config: seed.map_or(config.clone(), |seed| config.with_seed(seed)) })
    }

    /// The whole robot file, each key with its meaning, unit, range and default.
    fn to_toml(&self) -> String {
        to_commented_toml(&self.config)
    }

    /// The outline: a radius in m, or the corners of a convex polygon, base frame, (N, 2) m.
    #[getter]
    fn footprint(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        match self.config.footprint().map_err(value_error)? {
            Footprint::Disc { radius } => Ok(radius.into_pyobject(py)?.into_any().unbind()),
            outline @ Footprint::Polygon { .. } => {
                let Footprint::Polygon { corners } = outline else { return Ok(py.None()) };
                let corners = corners.iter().map(|corner| [corner.x, corner.y]).collect();
                Ok(crate::arrays::from_rows::<2, f64>(py, corners)?.into_any().unbind())
            }
        }
    }

    /// Highest forward speed, m/s.
    #[getter]
    fn max_speed(&self) -> f64 {
        self.config.limits.v
    }

    /// Highest turn rate, rad/s.
    #[getter]
    fn max_turn_rate(&self) -> f64 {
        self.config.limits.omega
    }

    fn __repr__(&self) -> String {
        let (v, omega) = (self.config.limits.v, self.config.limits.omega);
        format!("RobotConfig({v} m/s, {omega} rad/s)")
    }
}

/// The given settings, else the default ones.
pub fn robot_config(object: Option<&Bound<'_, PyAny>>) -> PyResult<Config> {
    match object {
        None => Ok(Config::default()),
        Some(object) => {
            let config = object.cast::<RobotConfig>();
            config.map(|config| config.get().config.clone()).map_err(|_| {
                wrong_type(object, "config", "a RobotConfig: RobotConfig('robot.toml'), or None for a Kobuki")
            })
        }
    }
}
