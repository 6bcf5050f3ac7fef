//! A thread that collects the packets of an open device, which prevents losses during decoding.

use super::color_packets::{ColorPacket, ColorPackets};
use super::depth_packets::DepthPackets;
use super::device::{Identity, Kinect2Device};
use super::ids;
use super::libusb::Transfers;
use crate::camera::CameraError;
use crate::camera::kinect2::packets::PackedFrame;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Maximum number of images in the queue; further ones are dropped. Source: ours; two of each kind.
const QUEUE_IMAGES: usize = 4;
/// Longest wait for a transfer \[ms\]; in between, the thread checks for its end. Source: ours.
const POLL_MS: u64 = 50;

/// Results of the thread.
#[derive(Debug)]
pub(super) enum Streamed {
    Color(ColorPacket),
    Depth(Box<PackedFrame>),
}

/// The thread. A drop stops the device and ends the thread.
#[derive(Debug)]
pub(super) struct StreamThread {
    images: Receiver<Streamed>,
    is_stopping: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<(), CameraError>>>,
}

/// Buffers that the transfers fill.
struct Collector {
    color: ColorPackets,
    depth: DepthPackets,
    queue: SyncSender<Streamed>,
    unread: u64,
}

impl StreamThread {
    /// Starts the streams of a device, and the thread.
    pub(super) fn start(mut device: Kinect2Device) -> Result<(Identity, Self), CameraError> {
        let identity = device.start()?;
        let (queue, images) = sync_channel(QUEUE_IMAGES);
        let is_stopping = Arc::new(AtomicBool::new(false));
        let stopping = Arc::clone(&is_stopping);
        let thread = std::thread::Builder::new().name("kinect2-usb".into());
        let thread = thread.spawn(move || collect(&device, queue, &stopping)).map_err(|source| {
            let place = ids::KINECT2_NAME.to_owned();
            CameraError::Io { place, source }
        })?;
        Ok((identity, Self { images, is_stopping, thread: Some(thread) }))
    }

    /// The next image; `None` if none came within `timeout`.
    ///
    /// # Errors
    /// The error that ended the thread.
    pub(super) fn next(&mut self, timeout: Duration) -> Result<Option<Streamed>, CameraError> {
        match self.images.recv_timeout(timeout) {
            Ok(image) => Ok(Some(image)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                let outcome = self.thread.take().and_then(|thread| thread.join().ok());
                let gone = CameraError::Unplugged { device: ids::KINECT2_NAME.into() };
                Err(outcome.and_then(Result::err).unwrap_or(gone))
            }
        }
    }
}

impl Drop for StreamThread {
    fn drop(&mut self) {
        self.is_stopping.store(true, Ordering::Relaxed);
        if self.thread.take().is_some_and(|thread| thread.join().is_err()) {
            tracing::error!("the thread of the {} panicked", ids::KINECT2_NAME);
        }
    }
}

fn collect(
    device: &Kinect2Device,
    queue: SyncSender<Streamed>,
    is_stopping: &AtomicBool,
) -> Result<(), CameraError> {
    let mut collector =
        Collector { color: ColorPackets::default(), depth: DepthPackets::default(), queue, unread: 0 };
    let outcome = {
        let take = |(endpoint, bytes): (u8, Option<&[u8]>)| collector.take(endpoint, bytes);
        let mut transfers = Transfers::start(device.handle(), &device.plans(), take)?;
        loop {
            if is_stopping.load(Ordering::Relaxed) {
                break Ok(());
            }
            if let Err(error) = transfers.handle_events(Duration::from_millis(POLL_MS)) {
                break Err(error);
            }
        }
    };
    collector.report();
    outcome
}

impl Collector {
    fn take(&mut self, endpoint: u8, bytes: Option<&[u8]>) {
        let image = match (endpoint, bytes) {
            (ids::COLOR_ENDPOINT, Some(bytes)) => self.color.push(bytes).map(Streamed::Color),
            (ids::DEPTH_ENDPOINT, Some(bytes)) => {
                self.depth.push(bytes).map(|frame| Streamed::Depth(Box::new(frame)))
            }
            (ids::COLOR_ENDPOINT, None) => return self.color.lose(),
            (_, None) => return self.depth.lose(),
            _ => None,
        };
        let is_dropped = image.is_some_and(|image| self.queue.try_send(image).is_err());
        self.unread += u64::from(is_dropped);
    }

    /// Losses, for the log.
    fn report(&self) {
        tracing::info!(
            "{}: {} images of depth incomplete, {} images not read in time, {} bytes of colour and {} bytes of depth skipped",
            ids::KINECT2_NAME,
            self.depth.dropped(),
            self.unread,
            self.color.skipped_bytes(),
            self.depth.skipped_bytes()
        );
    }
}
