//! The thread that reads the camera, and reopens a lost one.

use super::base_gyro::BaseGyro;
use super::config::{CameraFactory, CameraThreadConfig, HostClock};
use super::mailbox::{GrabbedFrame, Mailbox};
use super::outbox::Outbox;
use super::{StampMap, StampMapFactory};
use crate::camera::frame_monitor::faults_of_info;
use crate::camera::{CameraError, CameraFault, CameraFrame, CameraInfo, DepthCamera, FrameMonitor};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;
use trundle_core::Stamp;

/// Longest wait for one frame \[ms\]; in between, the thread checks for the end of the program. Source: ours.
const POLL_MS: u64 = 50;
/// Number of consecutive broken frames after which the camera is reopened: 30. Source: ours; 1 s at 30 Hz.
const MAX_BROKEN_IN_ROW: u64 = 30;

/// Reads the camera.
pub(super) struct Grabber {
    factory: CameraFactory,
    stamps: StampMapFactory,
    clock: HostClock,
    mailbox: Arc<Mailbox>,
    outbox: Arc<Outbox>,
    config: CameraThreadConfig,
    /// Number of attempts to open the camera since its last frame.
    attempts: u32,
    /// Stamps of the last frame of the camera that was lost.
    last_stamps: Option<(Stamp, Stamp)>,
}

/// Reason why a camera is no longer read.
enum Outcome {
    /// The recording ended, or the program does.
    Finished,
    /// The camera must be reopened.
    Lost(String),
}

/// A camera that is open.
struct OpenCamera {
    camera: Box<dyn DepthCamera>,
    info: Arc<CameraInfo>,
    monitor: FrameMonitor,
    stamps: StampMap,
    gyro: Option<BaseGyro>,
    generation: u64,
    /// Arrival of the newest good frame on the host's clock.
    last_good: Stamp,
}

impl Grabber {
    pub(super) fn new(
        factory: CameraFactory,
        stamps: StampMapFactory,
        clock: HostClock,
        (mailbox, outbox): (Arc<Mailbox>, Arc<Outbox>),
        config: CameraThreadConfig,
    ) -> Self {
        Self { factory, stamps, clock, mailbox, outbox, config, attempts: 0, last_stamps: None }
    }

    pub(super) fn run(mut self) {
        while !self.mailbox.is_stopped() {
            // A manufacturer's driver may panic; the robot must learn of the lost camera.
            let outcome = catch_unwind(AssertUnwindSafe(|| self.open_and_read()));
            match outcome.unwrap_or_else(|_| Outcome::Lost("the driver of the camera panicked".into())) {
                Outcome::Finished => break,
                Outcome::Lost(fault) => self.outbox.on_lost(fault),
            }
            let wait = reopen_wait(&self.config, self.attempts);
            self.attempts = self.attempts.saturating_add(1);
            self.mailbox.pause(wait);
        }
        self.mailbox.close();
    }

    fn open_and_read(&mut self) -> Outcome {
        match (self.factory)() {
            Ok(camera) => self.read(camera),
            Err(error) => Outcome::Lost(error.to_string()),
        }
    }

    /// Reads a camera until it is lost.
    fn read(&mut self, camera: Box<dyn DepthCamera>) -> Outcome {
        let mut open = self.prepare(camera);
        while !self.mailbox.is_stopped() {
            match open.camera.next_frame(Duration::from_millis(POLL_MS)) {
                Ok(Some(frame)) => {
                    if let Some(fault) = self.on_frame(&mut open, frame) {
                        return Outcome::Lost(fault.to_string());
                    }
                }
                Ok(None) if open.camera.has_ended() => return Outcome::Finished,
                Ok(None) => {}
                Err(error @ CameraError::BrokenFrame(_)) => self.outbox.on_broken(error.to_string()),
                Err(error) => return Outcome::Lost(error.to_string()),
            }
            if let Some(gyro) = &mut open.gyro {
                self.outbox.push_gyro(gyro.take(&mut *open.camera, (self.clock)()));
            }
            if let Some(fault) = self.silence(&open) {
                return Outcome::Lost(fault);
            }
        }
        Outcome::Finished
    }

    fn prepare(&mut self, camera: Box<dyn DepthCamera>) -> OpenCamera {
        let info = Arc::new(camera.info().clone());
        faults_of_info(&info).iter().for_each(|fault| self.outbox.on_fault(fault.to_string()));
        let monitor =
            FrameMonitor::new(&info, self.config.expects_noise && info.is_live).following(self.last_stamps);
        let (stamps, generation) = ((self.stamps)(&info), self.outbox.generation());
        let gyro = self.config.gyro.map(|rotation| {
            // Samples arrive without the exposure and the readout of an image: a filter of their own maps their stamps.
            let at_once = CameraInfo { delay_s: 0.0, ..camera.info().clone() };
            BaseGyro::new(&info, rotation, (self.stamps)(&at_once))
        });
        OpenCamera { camera, info, monitor, stamps, gyro, generation, last_good: (self.clock)() }
    }

    /// Hands a frame on; a fault that ends the use of the camera.
    fn on_frame(&mut self, open: &mut OpenCamera, frame: CameraFrame) -> Option<CameraFault> {
        let stamp = (open.stamps)(frame.color.device_stamp, (self.clock)());
        let fault = open.monitor.on_frame(&frame);
        self.last_stamps = open.monitor.last_stamps();
        if let Some(fault) = fault {
            if matches!(fault, CameraFault::Stuck { .. }) {
                self.outbox.on_stuck();
            }
            if fault.needs_reopening() {
                return Some(fault);
            }
            self.outbox.on_fault(fault.to_string());
        }
        if open.monitor.is_repeated() {
            // The robot has this frame.
            return None;
        }
        let (info, generation) = (open.info.clone(), open.generation);
        open.last_good = (self.clock)();
        self.attempts = 0;
        if self.mailbox.put(GrabbedFrame { frame, stamp, info, generation }) {
            self.outbox.on_dropped();
        }
        None
    }

    /// The sentence of a live camera that was silent, or whose frames are all broken.
    fn silence(&self, open: &OpenCamera) -> Option<String> {
        let silent_s = (self.clock)() - open.last_good;
        let broken = self.outbox.broken_in_row();
        if open.info.is_live && silent_s > self.config.max_silence_s {
            let silence = format!("{} delivered no good frame for {silent_s:.1} s", open.info.name);
            return Some(if broken > 0 { self.with_cause(&silence) } else { silence });
        }
        let is_broken = open.info.is_live && broken >= MAX_BROKEN_IN_ROW;
        is_broken.then(|| {
            self.with_cause(&format!("{} delivered {broken} broken frames in a row", open.info.name))
        })
    }

    /// A sentence, followed by the fault of the last broken frame.
    fn with_cause(&self, sentence: &str) -> String {
        self.outbox
            .last_fault()
            .map_or_else(|| sentence.to_owned(), |cause| format!("{sentence}; the last one: {cause}"))
    }
}

/// Wait before the next attempt: it doubles with each one.
fn reopen_wait(config: &CameraThreadConfig, attempts: u32) -> Duration {
    let wait_s = config.min_reopen_wait_s * 2.0_f64.powi(attempts.min(20) as i32);
    Duration::from_secs_f64(wait_s.clamp(0.0, config.max_reopen_wait_s))
}
