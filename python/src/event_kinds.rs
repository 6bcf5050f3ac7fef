//! Sensor events of the crates as Python objects, and back.

use crate::body_events::{BodyCondition, Odometry, Truth};
use crate::events::{Cliff, Gyro, Touch, Wheels};
use crate::numbers::wrong_type;
use crate::rgbd::Rgbd;
use crate::scan::Scan;
use pyo3::prelude::*;
use trundle::core::SensorEvent;

/// Classes of events, for refusals.
const EXPECTED: &str = "one of Wheels, Gyro, Rgbd, Scan, Touch, Cliff, Odometry, BodyCondition, Truth";

/// The Python object of an event.
pub fn event_object(py: Python<'_>, event: SensorEvent) -> PyResult<Bound<'_, PyAny>> {
    Ok(match event {
        SensorEvent::Wheels(reading) => Bound::new(py, Wheels { reading })?.into_any(),
        SensorEvent::Gyro(reading) => Bound::new(py, Gyro { reading })?.into_any(),
        SensorEvent::Rgbd(image) => Bound::new(py, Rgbd { image })?.into_any(),
        SensorEvent::Touch(reading) => Bound::new(py, Touch { reading })?.into_any(),
        SensorEvent::Cliff(reading) => Bound::new(py, Cliff { reading })?.into_any(),
        SensorEvent::Scan(scan) => Bound::new(py, Scan { scan })?.into_any(),
        SensorEvent::Odometry(reading) => Bound::new(py, Odometry { reading })?.into_any(),
        SensorEvent::Body(event) => Bound::new(py, BodyCondition { event })?.into_any(),
        SensorEvent::Truth { stamp, pose } => {
            Bound::new(py, Truth { at: stamp, world_from_base: pose })?.into_any()
        }
        other => {
            let problem = format!("event at {} s is of a kind that Python does not have yet", other.stamp());
            return Err(pyo3::exceptions::PyNotImplementedError::new_err(problem));
        }
    })
}

/// The event of a Python object. The pixels of an image are copied, since a robot may keep them.
///
/// # Errors
/// `TypeError` for another object.
pub fn event_of(object: &Bound<'_, PyAny>) -> PyResult<SensorEvent> {
    if let Ok(event) = object.cast::<Wheels>() {
        return Ok(SensorEvent::Wheels(event.get().reading));
    }
    if let Ok(event) = object.cast::<Gyro>() {
        return Ok(SensorEvent::Gyro(event.get().reading));
    }
    if let Ok(event) = object.cast::<Rgbd>() {
        return Ok(SensorEvent::Rgbd(event.get().image.clone()));
    }
    if let Ok(event) = object.cast::<Scan>() {
        return Ok(SensorEvent::Scan(event.get().scan.clone()));
    }
    if let Ok(event) = object.cast::<Touch>() {
        return Ok(SensorEvent::Touch(event.get().reading));
    }
    if let Ok(event) = object.cast::<Cliff>() {
        return Ok(SensorEvent::Cliff(event.get().reading));
    }
    if let Ok(event) = object.cast::<Odometry>() {
        return Ok(SensorEvent::Odometry(event.get().reading));
    }
    if let Ok(event) = object.cast::<BodyCondition>() {
        return Ok(SensorEvent::Body(event.get().event));
    }
    match object.cast::<Truth>() {
        Ok(event) => Ok(SensorEvent::Truth { stamp: event.get().at, pose: event.get().world_from_base }),
        Err(_) => Err(wrong_type(object, "event", EXPECTED)),
    }
}
