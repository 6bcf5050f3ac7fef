//! Odometry of a body, its conditions, and the truth of a simulator.

use crate::arrays::array;
use crate::errors::value_error;
use crate::geometry::{matrix, pose2_array, twist_array};
use crate::numbers::{pose2, seconds, stamp, twist};
use nalgebra::Matrix3;
use numpy::{PyArray1, PyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use trundle::core::{
    Battery, BodyEvent, BodyEventKind, Button, Device, DockBeams, DockInfrared, Invalid, Link,
    Odometry as CoreOdometry, PerWheel, Pose2, PowerSource, Stamp,
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

/// A condition of the body: what stops the robot, its battery and charging station, and time without sensor readings.
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

    /// Whether the motor of a wheel draws too much current.
    #[staticmethod]
    fn over_current(stamp: f64, left: bool, right: bool) -> PyResult<Self> {
        Self::of(stamp, BodyEventKind::OverCurrent(PerWheel { left, right }))
    }

    /// Voltage (V), charge (0 to 1; `None`: not measured), and the source of the power: "battery", "charging_station" or "adapter".
    #[staticmethod]
    #[pyo3(signature = (stamp, voltage, charge=None, source="battery", is_charging=false))]
    fn battery(
        stamp: f64,
        voltage: f64,
        charge: Option<f64>,
        source: &str,
        is_charging: bool,
    ) -> PyResult<Self> {
        let source = match source {
            "battery" => PowerSource::Battery,
            "charging_station" => PowerSource::ChargingStation,
            "adapter" => PowerSource::Adapter,
            other => {
                let expected = "battery, charging_station or adapter";
                return Err(value_error(Invalid::new("source of the power", other, "", expected)));
            }
        };
        Self::of(stamp, BodyEventKind::Battery(Battery { voltage_v: voltage, charge, source, is_charging }))
    }

    /// A button of the base, from 0, is down or up.
    #[staticmethod]
    fn button(stamp: f64, index: i64, pressed: bool) -> PyResult<Self> {
        let index = u8::try_from(index)
            .map_err(|_| value_error(Invalid::new("index of the button", index, "", "0 to 255")))?;
        Self::of(stamp, BodyEventKind::Button(Button { index, pressed }))
    }

    /// The sectors of a charging station's light that the receivers at the left, middle and right of the front detect: "near_left",
    /// "near_center", "near_right", "far_left", "far_center", "far_right", as seen in the direction of the station's front.
    #[staticmethod]
    fn dock_infrared(
        stamp: f64,
        left: Vec<String>,
        center: Vec<String>,
        right: Vec<String>,
    ) -> PyResult<Self> {
        let (left, center, right) = (beams(&left)?, beams(&center)?, beams(&right)?);
        Self::of(stamp, BodyEventKind::DockInfrared(DockInfrared { left, center, right }))
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

/// The sectors with these names.
fn beams(sectors: &[String]) -> PyResult<DockBeams> {
    let mut beams = DockBeams::default();
    for sector in sectors {
        let beam = match sector.as_str() {
            "near_left" => &mut beams.near_left,
            "near_center" => &mut beams.near_center,
            "near_right" => &mut beams.near_right,
            "far_left" => &mut beams.far_left,
            "far_center" => &mut beams.far_center,
            "far_right" => &mut beams.far_right,
            other => {
                let expected = "near or far, then _left, _center or _right, as near_left";
                return Err(value_error(Invalid::new("sector of the station's light", other, "", expected)));
            }
        };
        *beam = true;
    }
    Ok(beams)
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
