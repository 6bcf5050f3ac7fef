//! Faults and their times.

mod schedule;
mod state;

pub use schedule::{Fault, FaultKind, FaultSchedule, WheelSide};
pub(crate) use state::{CameraFault, Faults};
