//! Device clocks mapped to one clock, and events put in order.
//!
//! | module | content |
//! |---|---|
//! | [`unwrap`] | wrapping counters, converted to the time since their first value |
//! | [`device_clock`] | device stamps on the host's clock |
//! | [`reorder_buffer`] | events in the order of their stamps |
//!
//! No function reads a clock: the time of arrival is an argument. [`HostClock`] is the clock of a driver's threads.

pub mod device_clock;
mod lower_hull;
pub mod reorder_buffer;
pub mod unwrap;

pub use device_clock::{DeviceClock, DeviceClockConfig};
pub use reorder_buffer::{ReorderBuffer, ReorderCounts};
pub use unwrap::MillisUnwrapper;

use std::sync::Arc;
use trundle_core::Stamp;

/// The host's clock for drivers: the present stamp, which never decreases.
pub type HostClock = Arc<dyn Fn() -> Stamp + Send + Sync>;
