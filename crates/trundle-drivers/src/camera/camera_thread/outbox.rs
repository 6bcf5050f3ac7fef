//! The sink of images and link events, the state of the link, and the counters.

use super::config::{EventSink, HostClock};
use serde::Serialize;
use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};
use trundle_core::{BodyEvent, BodyEventKind, Device, GyroRate, Link, RgbdImage, SensorEvent};

/// Frames counted since the start of a camera thread.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct CameraCounters {
    /// Frames pushed into the sink.
    pub frames: u64,
    /// Frames dropped because a newer one arrived before the conversion, or because the camera was lost.
    pub dropped: u64,
    /// Frames that could not be read or converted.
    pub broken: u64,
    /// Number of times that the camera delivered the same frame repeatedly.
    pub stuck: u64,
    /// Times that the camera was lost, or could not be opened.
    pub lost: u64,
}

struct State {
    sink: EventSink,
    /// `None` before the first frame and the first fault.
    is_up: Option<bool>,
    generation: u64,
    broken_in_row: u64,
    counters: CameraCounters,
    last_fault: Option<String>,
}

/// The sink of images and link events. A frame of a lost camera never follows the event of its loss.
pub(super) struct Outbox {
    clock: HostClock,
    state: Mutex<State>,
}

impl Outbox {
    pub(super) fn new(sink: EventSink, clock: HostClock) -> Self {
        let counters = CameraCounters::default();
        let state = State { sink, is_up: None, generation: 0, broken_in_row: 0, counters, last_fault: None };
        Self { clock, state: Mutex::new(state) }
    }

    /// Pushes an image of an opening of the camera. The link is up from the first one on.
    pub(super) fn push(&self, image: RgbdImage, generation: u64) {
        let mut state = self.lock();
        if generation != state.generation {
            state.counters.dropped += 1;
            return;
        }
        if state.is_up != Some(true) {
            self.push_link(&mut state, true);
        }
        state.counters.frames += 1;
        state.broken_in_row = 0;
        (state.sink)(SensorEvent::Rgbd(image));
    }

    /// Pushes readings of the camera's gyro.
    pub(super) fn push_gyro(&self, rates: Vec<GyroRate>) {
        if !rates.is_empty() {
            let mut state = self.lock();
            rates.into_iter().for_each(|rate| (state.sink)(SensorEvent::Gyro(rate)));
        }
    }

    /// The camera was lost, or could not be opened.
    pub(super) fn on_lost(&self, fault: String) {
        tracing::warn!("camera lost: {fault}");
        let mut state = self.lock();
        state.generation += 1;
        state.broken_in_row = 0;
        state.counters.lost += 1;
        state.last_fault = Some(fault);
        if state.is_up != Some(false) {
            self.push_link(&mut state, false);
        }
    }

    /// A frame could not be read or converted.
    pub(super) fn on_broken(&self, fault: String) {
        let mut state = self.lock();
        state.counters.broken += 1;
        if state.broken_in_row == 0 {
            tracing::warn!("camera: a frame is broken: {fault}");
        }
        state.broken_in_row += 1;
        state.last_fault = Some(fault);
    }

    /// A fault that does not end the use of the camera.
    pub(super) fn on_fault(&self, fault: String) {
        tracing::warn!("camera: {fault}");
        self.lock().last_fault = Some(fault);
    }

    pub(super) fn on_dropped(&self) {
        self.lock().counters.dropped += 1;
    }

    pub(super) fn on_stuck(&self) {
        self.lock().counters.stuck += 1;
    }

    /// The number of the present opening of the camera.
    pub(super) fn generation(&self) -> u64 {
        self.lock().generation
    }

    /// Broken frames since the last good one.
    pub(super) fn broken_in_row(&self) -> u64 {
        self.lock().broken_in_row
    }

    pub(super) fn counters(&self) -> CameraCounters {
        self.lock().counters
    }

    pub(super) fn last_fault(&self) -> Option<String> {
        self.lock().last_fault.clone()
    }

    pub(super) fn is_up(&self) -> bool {
        self.lock().is_up == Some(true)
    }

    fn push_link(&self, state: &mut State, is_up: bool) {
        state.is_up = Some(is_up);
        let kind = BodyEventKind::Link(Link { device: Device::Camera, is_up });
        (state.sink)(SensorEvent::Body(BodyEvent::new((self.clock)(), kind)));
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Outbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Outbox").field("counters", &self.counters()).finish_non_exhaustive()
    }
}
