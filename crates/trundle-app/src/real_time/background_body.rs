//! A body that runs in its own threads and sends its events into the run's inbox.

use super::{DeviceReport, MemoryUsage};
use crate::{AppError, StateDisplay};
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;
use std::sync::mpsc::Sender;
use std::time::Instant;
use trundle_core::Twist2;
use trundle_io::EncodedEvent;

/// An event and the instant of its arrival.
#[non_exhaustive]
pub struct TimedEvent {
    /// The event.
    pub event: EncodedEvent,
    /// The instant of its arrival.
    pub at: Instant,
}

impl TimedEvent {
    /// An event that arrives now.
    pub fn now(event: EncodedEvent) -> Self {
        Self { event, at: Instant::now() }
    }
}

/// A body that runs in its own threads and sends its events into the inbox given at its start.
pub trait BackgroundBody {
    /// Sender for commands to the body.
    fn commands(&self) -> Sender<Twist2>;

    /// The count of separate contacts, in truth; `None` if only the bumper reports contacts.
    fn contacts(&self) -> Option<Arc<AtomicU32>>;

    /// The body's lights and sounds; `None` (the default) for a body without them.
    fn state_display(&mut self) -> Option<StateDisplay> {
        None
    }

    /// Ends the body's threads.
    ///
    /// # Errors
    /// When the body failed during the run.
    fn stop(self) -> Result<BodyTiming, AppError>;
}

/// Lateness of the readings of a simulated base.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Lateness {
    /// 99.9th percentile \[ms\].
    #[serde(rename = "lateness_p999_ms")]
    pub p999_ms: f64,
    /// Maximum \[ms\].
    #[serde(rename = "lateness_most_ms")]
    pub max_ms: f64,
}

/// Number of events that arrived out of order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct EventOrderCounts {
    /// Events that were put in order.
    #[serde(rename = "events_put_in_order")]
    pub reordered: u64,
    /// Events that came too late for that and were dropped.
    #[serde(rename = "events_too_late")]
    pub late: u64,
}

/// Timing of the body. Delays of a simulated body also appear in the robot's figures.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BodyTiming {
    /// Lateness of the base's readings; `None` if the base is real.
    #[serde(flatten)]
    pub lateness: Option<Lateness>,
    /// Images that the camera had no time to take.
    pub images_not_taken: u64,
    /// Images due.
    pub images: u64,
    /// Age of an image at its arrival, median \[ms\].
    pub image_age_median_ms: f64,
    /// Age of an image at its arrival, 99th percentile \[ms\].
    pub image_age_p99_ms: f64,
    /// Events that arrived out of order.
    #[serde(flatten)]
    pub order: EventOrderCounts,
    /// Report of the drivers; empty for a simulated body.
    #[serde(flatten)]
    pub devices: DeviceReport,
    /// Resident memory of the program.
    #[serde(skip)]
    pub memory: MemoryUsage,
}
