//! Readings of wheels, gyro, bumper and cliff sensors.

use crate::errors::value_error;
use crate::numbers::{seconds, stamp};
use pyo3::prelude::*;
use trundle::core::{Cliff as CoreCliff, GyroRate, Invalid, Touch as CoreTouch, WheelTicks, require_finite};

/// Encoder counters of both wheels, 0 to 65535, with wrap-around.
///
/// >>> trundle.Wheels(1.5, left=10, right=65535)
/// Wheels(stamp=1.5, left=10, right=65535)
#[pyclass(frozen, module = "trundle")]
pub struct Wheels {
    /// The reading.
    pub reading: WheelTicks,
}

#[pymethods]
impl Wheels {
    #[new]
    fn new(stamp: f64, left: i64, right: i64) -> PyResult<Self> {
        let (left, right) = (counter("left", left)?, counter("right", right)?);
        Ok(Self { reading: WheelTicks { stamp: self::stamp(stamp)?, left, right } })
    }

    /// When it was read, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    /// Ticks of the left wheel, 0 to 65535.
    #[getter]
    fn left(&self) -> u16 {
        self.reading.left
    }

    /// Ticks of the right wheel, 0 to 65535.
    #[getter]
    fn right(&self) -> u16 {
        self.reading.right
    }

    fn __repr__(&self) -> String {
        format!("Wheels(stamp={}, left={}, right={})", self.stamp(), self.left(), self.right())
    }
}

/// A counter of 16 bits.
fn counter(field: &str, value: i64) -> PyResult<u16> {
    u16::try_from(value).map_err(|_| {
        let expected = "0 to 65535: counters wrap there";
        value_error(Invalid::new(field, value, "ticks", expected))
    })
}

/// Turn rate about the vertical axis, rad/s, counter-clockwise positive.
///
/// >>> trundle.Gyro(1.5, omega=0.25)
/// Gyro(stamp=1.5, omega=0.25)
#[pyclass(frozen, module = "trundle")]
pub struct Gyro {
    /// The reading.
    pub reading: GyroRate,
}

#[pymethods]
impl Gyro {
    #[new]
    fn new(stamp: f64, omega: f64) -> PyResult<Self> {
        let omega = require_finite("omega", omega, "rad/s").map_err(value_error)?;
        Ok(Self { reading: GyroRate { stamp: self::stamp(stamp)?, omega } })
    }

    /// When it was read, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    /// Turn rate, rad/s.
    #[getter]
    fn omega(&self) -> f64 {
        self.reading.omega
    }

    fn __repr__(&self) -> String {
        format!("Gyro(stamp={}, omega={})", self.stamp(), self.omega())
    }
}

/// The bumper: pressed or released.
///
/// >>> trundle.Touch(1.5, pressed=True)
/// Touch(stamp=1.5, pressed=True)
#[pyclass(frozen, module = "trundle")]
pub struct Touch {
    /// The reading.
    pub reading: CoreTouch,
}

#[pymethods]
impl Touch {
    #[new]
    fn new(stamp: f64, pressed: bool) -> PyResult<Self> {
        Ok(Self { reading: CoreTouch { stamp: self::stamp(stamp)?, pressed } })
    }

    /// When it was read, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    /// Whether the bumper is pressed.
    #[getter]
    fn pressed(&self) -> bool {
        self.reading.pressed
    }

    fn __repr__(&self) -> String {
        format!("Touch(stamp={}, pressed={})", self.stamp(), if self.pressed() { "True" } else { "False" })
    }
}

/// The cliff sensors: whether the floor ends below one of them.
///
/// >>> trundle.Cliff(1.5, over_edge=False)
/// Cliff(stamp=1.5, over_edge=False)
#[pyclass(frozen, module = "trundle")]
pub struct Cliff {
    /// The reading.
    pub reading: CoreCliff,
}

#[pymethods]
impl Cliff {
    #[new]
    fn new(stamp: f64, over_edge: bool) -> PyResult<Self> {
        Ok(Self { reading: CoreCliff { stamp: self::stamp(stamp)?, over_edge } })
    }

    /// When it was read, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.reading.stamp)
    }

    /// Whether the floor ends below a sensor.
    #[getter]
    fn over_edge(&self) -> bool {
        self.reading.over_edge
    }

    fn __repr__(&self) -> String {
        let over_edge = if self.over_edge() { "True" } else { "False" };
        format!("Cliff(stamp={}, over_edge={over_edge})", self.stamp())
    }
}
