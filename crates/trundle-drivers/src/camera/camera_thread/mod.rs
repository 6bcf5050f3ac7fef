//! A camera with its own threads, reopened after faults.
//!
//! One thread reads the camera: it stamps each frame on arrival, detects faults, and reopens a lost camera. A second thread converts and
//! registers the newest frame, and pushes it into the sink. A newer frame replaces a waiting one, which keeps the delay below two frames;
//! the frames of a recording wait instead.

mod base_gyro;
mod config;
mod converter;
mod grabber;
mod mailbox;
mod outbox;
mod stamps;

pub use config::{CameraFactory, CameraThreadConfig, CameraThreadParts, EventSink, HostClock};
pub use outbox::CameraCounters;
pub use stamps::{StampMap, StampMapFactory, arrival_minus_delay, default_stamps, recorded_stamps};

use self::{converter::Converter, grabber::Grabber, mailbox::Mailbox, outbox::Outbox};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

/// A running camera. A drop ends its threads; this may take as long as opening the camera.
#[derive(Debug)]
pub struct CameraThread {
    mailbox: Arc<Mailbox>,
    outbox: Arc<Outbox>,
    threads: Vec<JoinHandle<()>>,
}

impl CameraThread {
    /// Starts the threads. The camera is opened on a thread; a failure is retried until it succeeds.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(parts: CameraThreadParts, config: CameraThreadConfig) -> std::io::Result<Self> {
        let mailbox = Arc::new(Mailbox::default());
        let outbox = Arc::new(Outbox::new(parts.sink, parts.clock.clone()));
        let mut camera = Self { mailbox: mailbox.clone(), outbox: outbox.clone(), threads: Vec::new() };
        let converter = Converter::new(mailbox.clone(), outbox.clone(), config);
        let grabber = Grabber::new(parts.factory, parts.stamps, parts.clock, (mailbox, outbox), config);
        camera.threads.push(Builder::new().name("camera-convert".into()).spawn(move || converter.run())?);
        camera.threads.push(Builder::new().name("camera-grab".into()).spawn(move || grabber.run())?);
        Ok(camera)
    }

    /// Frames counted since the start.
    pub fn counters(&self) -> CameraCounters {
        self.outbox.counters()
    }

    /// The sentence of the last fault; `None` without a fault.
    pub fn last_fault(&self) -> Option<String> {
        self.outbox.last_fault()
    }

    /// Whether the last frame came in time.
    pub fn is_up(&self) -> bool {
        self.outbox.is_up()
    }

    /// Whether a recording has ended and all its frames are in the sink.
    pub fn has_ended(&self) -> bool {
        self.threads.iter().all(JoinHandle::is_finished)
    }
}

impl Drop for CameraThread {
    fn drop(&mut self) {
        self.mailbox.stop();
        for thread in self.threads.drain(..) {
            if thread.join().is_err() {
                tracing::error!("a camera thread panicked");
            }
        }
    }
}
