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

/// Odometry computed by the body, in place of wheels and gyro.
///
/// `pose` `odom_from_base` (x m, y m, theta rad); `twist` (v m/s, omega rad/s); `covariance` float64 (3, 3) of the pose as a right
/// perturbation (m, m, rad).
///
/// >>> import numpy as np
/// >>> trundle.Odometry(1.5, (1, 2, 0.5), (0.1, 0), np.eye(3) * 1e-4).pose
/// array([1. , 2. , 0.5])
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

    /// When it was, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    /// `odom_from_base`, (3,): x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.reading.pose)
    }

    /// v m/s, omega rad/s, (2,).
    #[getter]
    fn twist<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        twist_array(py, self.reading.twist)
    }

    /// Covariance of the pose as a right perturbation (m, m, rad), (3, 3).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.reading.covariance)
    }

    fn __repr__(&self) -> String {
        let Pose2 { x, y, theta } = self.reading.pose;
        format!("Odometry(stamp={}, pose=({x}, {y}, {theta}))", self.stamp())
    }
}

/// A condition of the body that stops the robot, or its end.
///
/// >>> trundle.BodyCondition.link(1.5, "camera", False).stamp
/// 1.5
#[pyclass(frozen, module = "trundle")]
pub struct BodyCondition {
    /// The event.
    pub event: BodyEvent,
}

#[pymethods]
impl BodyCondition {
    /// A time without sensor readings, which advances the robot's time to `stamp` s.
    #[staticmethod]
    fn silence(stamp: f64) -> PyResult<Self> {
        Self::of(stamp, BodyEventKind::Silence)
    }

    /// The connection to "base", "camera" or "laser" is up or down.
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

    /// State of the wheel-drop sensors: a dropped wheel means a lifted robot.
    #[staticmethod]
    fn wheel_drop(stamp: f64, left: bool, right: bool) -> PyResult<Self> {
        Self::of(stamp, BodyEventKind::WheelDrop(PerWheel { left, right }))
    }

    /// When it was, s.
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
        let event = BodyEvent::new(self::stamp(stamp)?, kind);
        Ok(Self { event: event.checked().map_err(value_error)? })
    }
}

/// The true pose of a simulated robot, which `Robot` ignores.
///
/// >>> events = trundle.Simulator("room", 1, camera=None).step((0, 0), duration=0.05)
/// >>> next(event for event in events if isinstance(event, trundle.Truth)).pose.shape
/// (3,)
#[pyclass(frozen, module = "trundle")]
pub struct Truth {
    /// Time of the pose.
    pub at: Stamp,
    /// `world_from_base`.
    pub world_from_base: Pose2,
}

#[pymethods]
impl Truth {
    /// When it was, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.at)
    }

    /// `world_from_base`, (3,): x m, y m, theta rad.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        pose2_array(py, self.world_from_base)
    }

    fn __repr__(&self) -> String {
        let Pose2 { x, y, theta } = self.world_from_base;
        format!("Truth(stamp={}, pose=({x}, {y}, {theta}))", self.stamp())
    }
}
