//! Odometry of a body, its conditions, and the truth of a simulator.

use crate::arrays::array;
use crate::errors::value_error;
use crate::geometry::{matrix, pose2_array, twist_array};
use crate::numbers::{pose2, seconds, stamp, twist};
use nalgebra::Matrix3;
use numpy::{PyArray1, PyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use trundle::core::{
    BodyEvent, BodyEventKind, Device, Invalid, Link, Odometry as CoreOdometry, PerWheel, Pose2, Stamp,
};

/// Odometry that the body computed itself: a body yields it in place of wheels and gyro.
#[pyclass(frozen, module = "trundle")]
pub struct Odometry {
    /// The reading.
    pub reading: CoreOdometry,
}

#[pymethods]
impl Odometry {
    #[new]
    fn new(
        stamp: f64,
        pose: &Bound<'_, PyAny>,
        twist: &Bound<'_, PyAny>,
        covariance: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let array = array::<f64, numpy::Ix2>(covariance, "covariance", "(3, 3)")?;
        if array.shape() != [3, 3] {
            let found = array.shape();
            return Err(value_error(format!(
                "covariance has shape {found:?}, expected a numpy array of dtype float64 and shape (3, 3)"
            )));
        }
        let covariance = Matrix3::from_row_slice(crate::arrays::slice(&array, "covariance")?);
        let (pose, twist) = (pose2(pose, "pose")?, self::twist(twist, "twist")?);
        let reading = CoreOdometry { stamp: self::stamp(stamp)?, pose, twist, covariance };
        Ok(Self { reading: reading.checked().map_err(value_error)? })
    }

    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.reading.pose)
    }

    #[getter]
    fn twist<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        twist_array(py, self.reading.twist)
    }

    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.reading.covariance)
    }

    fn __repr__(&self) -> String {
        let Pose2 { x, y, theta } = self.reading.pose;
        format!("Odometry(stamp={}, pose=({x}, {y}, {theta}))", self.stamp())
    }
}

/// A condition of the body: silence, a link, a wheel that hangs, and what a simulated or real base reports besides.
#[pyclass(frozen, module = "trundle")]
pub struct BodyCondition {
    /// The event.
    pub event: BodyEvent,
}

#[pymethods]
impl BodyCondition {
    /// No sensor has reported: time goes on.
    #[staticmethod]
    fn silence(stamp: f64) -> PyResult<Self> {
        Self::of(stamp, BodyEventKind::Silence)
    }

    /// The connection to `base`, `camera` or `laser` is up or down.
    #[staticmethod]
    fn link(stamp: f64, device: &str, is_up: bool) -> PyResult<Self> {
        let device = match device {
            "base" => Device::Base,
            "camera" => Device::Camera,
            "laser" => Device::Laser,
            other => return Err(value_error(Invalid::new("device", other, "", "base, camera or laser"))),
        };
        Self::of(stamp, BodyEventKind::Link(Link { device, is_up }))
    }

    /// Wheels hang in the air: the robot is lifted.
    #[staticmethod]
    fn wheel_drop(stamp: f64, left: bool, right: bool) -> PyResult<Self> {
        Self::of(stamp, BodyEventKind::WheelDrop(PerWheel { left, right }))
    }

    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.event.stamp)
    }

    fn __repr__(&self) -> String {
        format!("BodyCondition(stamp={}, {:?})", self.stamp(), self.event.kind)
    }
}

impl BodyCondition {
    fn of(stamp: f64, kind: BodyEventKind) -> PyResult<Self> {
        let event = BodyEvent { stamp: self::stamp(stamp)?, kind };
        Ok(Self { event: event.checked().map_err(value_error)? })
    }
}

/// The true pose of a simulated robot; robots ignore it.
#[pyclass(frozen, module = "trundle")]
pub struct Truth {
    /// Time of the pose.
    pub at: Stamp,
    /// `world_from_base`.
    pub world_from_base: Pose2,
}

#[pymethods]
impl Truth {
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.at)
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.world_from_base)
    }

    fn __repr__(&self) -> String {
        let Pose2 { x, y, theta } = self.world_from_base;
        format!("Truth(stamp={}, pose=({x}, {y}, {theta}))", self.stamp())
    }
}
