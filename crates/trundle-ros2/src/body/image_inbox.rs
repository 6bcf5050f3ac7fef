//! The newest image pair and the cameras' intrinsics, from the node's thread to the camera's.

use super::image_pairs::{ImagePairs, MAX_PAIR_GAP_S};
use crate::generated::sensor_msgs::{CameraInfoMessage, CompressedImage, ImageMessage};
use crate::node::Diagnostics;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::Stamp;

/// An image as received.
#[derive(Debug, Clone, PartialEq)]
pub enum ReceivedImage {
    /// Pixels.
    Raw(ImageMessage),
    /// A file.
    Compressed(CompressedImage),
}

impl ReceivedImage {
    /// Name of the image's frame.
    #[must_use]
    pub fn frame(&self) -> &str {
        match self {
            Self::Raw(image) => &image.header.frame_id,
            Self::Compressed(image) => &image.header.frame_id,
        }
    }
}

/// A colour image and the depth image of the same moment.
pub type ImagePair = (ReceivedImage, ReceivedImage);

#[derive(Default)]
struct State {
    pairs: ImagePairs<ReceivedImage, ReceivedImage>,
    newest: Option<ImagePair>,
    color_info: Option<CameraInfoMessage>,
    depth_info: Option<CameraInfoMessage>,
    color_frame: Option<String>,
    depth_frame: Option<String>,
}

/// The newest image pair and the newest intrinsics. A newer pair replaces one that was not taken.
#[derive(Default)]
pub struct ImageInbox {
    state: Mutex<State>,
    arrival: Condvar,
    diagnostics: Diagnostics,
}

impl ImageInbox {
    /// An empty inbox that reports to `diagnostics`.
    #[must_use]
    pub fn new(diagnostics: Diagnostics) -> Self {
        Self { diagnostics, ..Self::default() }
    }

    /// Takes up a colour image of the time `stamp`.
    pub fn on_color(&self, stamp: Stamp, image: ReceivedImage) {
        let mut state = self.lock();
        state.color_frame.get_or_insert_with(|| image.frame().to_owned());
        let pair = state.pairs.add_color(stamp, image);
        self.put(&mut state, pair);
    }

    /// Takes up a depth image of the time `stamp`.
    pub fn on_depth(&self, stamp: Stamp, image: ReceivedImage) {
        let mut state = self.lock();
        state.depth_frame.get_or_insert_with(|| image.frame().to_owned());
        let pair = state.pairs.add_depth(stamp, image);
        self.put(&mut state, pair);
    }

    /// Takes up the intrinsics of the colour camera.
    pub fn on_color_info(&self, info: CameraInfoMessage) {
        self.lock().color_info = Some(info);
        self.arrival.notify_all();
    }

    /// Takes up the intrinsics of the depth camera.
    pub fn on_depth_info(&self, info: CameraInfoMessage) {
        self.lock().depth_info = Some(info);
        self.arrival.notify_all();
    }

    /// The newest intrinsics of colour and depth.
    #[must_use]
    pub fn infos(&self) -> (Option<CameraInfoMessage>, Option<CameraInfoMessage>) {
        let state = self.lock();
        (state.color_info.clone(), state.depth_info.clone())
    }

    /// Names of the frames of colour and depth.
    #[must_use]
    pub fn frames(&self) -> (Option<String>, Option<String>) {
        let state = self.lock();
        (state.color_frame.clone(), state.depth_frame.clone())
    }

    /// Takes the newest pair; waits for one up to `timeout`.
    #[must_use]
    pub fn take(&self, timeout: Duration) -> Option<ImagePair> {
        let end = Instant::now() + timeout;
        let mut state = self.lock();
        loop {
            let left = end.saturating_duration_since(Instant::now());
            if state.newest.is_some() || left.is_zero() {
                return state.newest.take();
            }
            state = self.arrival.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn put(&self, state: &mut State, pair: Option<ImagePair>) {
        if let Some(gap) = state.pairs.smallest_gap() {
            let (gap, max) = (gap * 1e3, MAX_PAIR_GAP_S * 1e3);
            let message = format!(
                "stamps of colour and depth differ by {gap:.0} ms or more, expected at most {max:.0} ms: synchronise both streams in the camera's driver"
            );
            self.diagnostics.warn("camera", message);
        }
        if pair.is_some() {
            state.newest = pair;
            self.arrival.notify_all();
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
