//! Numbers, poses, twists and stamps from Python objects, with the expected form in every refusal.

use crate::errors::value_error;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use trundle::core::{
    Footprint, Invalid, MAX_COORDINATE_M, Pose2, Stamp, Twist2, Vector2, require_finite, require_in,
};
use trundle::io::parse_stamp;

/// Largest speed [m/s] and turn rate [rad/s] of a command. A larger one is a mistyped number. Source: ours.
const MAX_TWIST: f64 = 100.0;

/// N finite numbers of a sequence or array.
///
/// # Errors
/// `TypeError` for an object that is no sequence of numbers; `ValueError` for another count, NaN or infinity.
pub fn numbers<const N: usize>(object: &Bound<'_, PyAny>, name: &str, expected: &str) -> PyResult<[f64; N]> {
    let list: Vec<f64> = object.extract().map_err(|_| wrong_type(object, name, expected))?;
    let count = list.len();
    let numbers: [f64; N] = list
        .try_into()
        .map_err(|_| value_error(format!("{name} has {count} numbers, expected {expected}")))?;
    for number in numbers {
        require_finite(name, number, "").map_err(value_error)?;
    }
    Ok(numbers)
}

/// `TypeError` that names the type of an object and the expected one.
pub fn wrong_type(object: &Bound<'_, PyAny>, name: &str, expected: &str) -> PyErr {
    let kind = object.get_type().name().map_or_else(|_| "?".to_owned(), |kind| kind.to_string());
    PyTypeError::new_err(format!("{name} is of type {kind}, expected {expected}"))
}

/// A pose in the plane: x m, y m, theta rad.
///
/// # Errors
/// As [`numbers`], and for a position farther than 1000 km.
pub fn pose2(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Pose2> {
    let [x, y, theta] = numbers(object, name, "3 numbers: x m, y m, theta rad")?;
    for (axis, value) in [("x", x), ("y", y)] {
        let field = format!("{axis} of {name}");
        require_in(&field, value, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M).map_err(value_error)?;
    }
    Ok(Pose2::new(x, y, theta))
}

/// A point in the plane: x m, y m.
///
/// # Errors
/// As [`numbers`].
pub fn point(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vector2> {
    let [x, y] = numbers(object, name, "2 numbers: x m, y m")?;
    Ok(Vector2::new(x, y))
}

/// A twist: v m/s, omega rad/s.
///
/// # Errors
/// As [`numbers`], and for an impossibly large number.
pub fn twist(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Twist2> {
    let [v, omega] = numbers(object, name, "2 numbers: v m/s, omega rad/s")?;
    for (part, value, unit) in [("v", v, "m/s"), ("omega", omega, "rad/s")] {
        require_in(&format!("{part} of {name}"), value, unit, -MAX_TWIST, MAX_TWIST).map_err(value_error)?;
    }
    Ok(Twist2::new(v, omega))
}

/// A stamp from seconds, by their shortest decimal: a time of our century is exact to the microsecond.
///
/// # Errors
/// `ValueError` for NaN, infinity, and a time farther than 292 years from the epoch.
pub fn stamp(seconds: f64) -> PyResult<Stamp> {
    require_finite("stamp", seconds, "s").map_err(value_error)?;
    Stamp::from_secs(seconds).ok_or_else(|| {
        let expected = "a time within 292 years of the epoch, in seconds";
        value_error(Invalid::new("stamp", seconds, "s", expected))
    })?;
    parse_stamp(&seconds.to_string()).map_err(value_error)
}

/// Seconds of a stamp: the f64 nearest to its decimal.
pub fn seconds(stamp: Stamp) -> f64 {
    const NANOS: i64 = 1_000_000_000;
    (stamp.nanos / NANOS) as f64 + (stamp.nanos % NANOS) as f64 / NANOS as f64
}

/// An outline: a radius in metres, or the corners of a convex polygon.
///
/// # Errors
/// `TypeError` for another kind; `ValueError` for an invalid outline.
pub fn footprint(object: &Bound<'_, PyAny>) -> PyResult<Footprint> {
    let expected = "a radius in m, or 3 or more corners (x m, y m) of a convex polygon";
    if let Ok(radius) = object.extract::<f64>() {
        return Footprint::disc(radius).map_err(value_error);
    }
    let corners: Vec<Bound<'_, PyAny>> =
        object.extract().map_err(|_| wrong_type(object, "footprint", expected))?;
    let corners: PyResult<Vec<Vector2>> =
        corners.iter().map(|corner| point(corner, "corner of footprint")).collect();
    Footprint::polygon(corners?).map_err(value_error)
}
