//! What breaks, and when.

mod schedule;
mod state;

pub use schedule::{Fault, FaultKind, FaultSchedule, WheelSide};
pub(crate) use state::{CameraFault, Faults};
