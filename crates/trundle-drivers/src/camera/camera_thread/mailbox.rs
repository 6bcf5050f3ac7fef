//! A queue of one frame between the reading and the converting thread.

use crate::camera::{CameraFrame, CameraInfo};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_core::Stamp;

/// A frame as read.
#[derive(Debug)]
pub(super) struct GrabbedFrame {
    pub frame: CameraFrame,
    pub stamp: Stamp,
    pub info: Arc<CameraInfo>,
    /// Counts the openings of the camera.
    pub generation: u64,
}

#[derive(Debug, Default)]
struct Content {
    frame: Option<Box<GrabbedFrame>>,
    is_closed: bool,
    is_stopped: bool,
}

/// Holds at most one frame.
#[derive(Debug, Default)]
pub(super) struct Mailbox {
    content: Mutex<Content>,
    changed: Condvar,
}

impl Mailbox {
    /// Puts a frame in. A live frame replaces a waiting one; another one waits for its place. Whether a frame was dropped.
    pub(super) fn put(&self, frame: GrabbedFrame) -> bool {
        let is_live = frame.info.is_live;
        let mut content = self.lock();
        while !is_live && content.frame.is_some() && !content.is_stopped {
            content = self.changed.wait(content).unwrap_or_else(PoisonError::into_inner);
        }
        let dropped = content.frame.replace(Box::new(frame));
        self.changed.notify_all();
        dropped.is_some()
    }

    /// The next frame; `None` if the mailbox was closed and is empty, or was stopped.
    pub(super) fn take(&self) -> Option<Box<GrabbedFrame>> {
        let mut content = self.lock();
        while content.frame.is_none() && !content.is_closed && !content.is_stopped {
            content = self.changed.wait(content).unwrap_or_else(PoisonError::into_inner);
        }
        let frame = content.frame.take().filter(|_| !content.is_stopped);
        self.changed.notify_all();
        frame
    }

    /// No frame follows.
    pub(super) fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_all();
    }

    /// Requests the end of both threads.
    pub(super) fn stop(&self) {
        self.lock().is_stopped = true;
        self.changed.notify_all();
    }

    /// Whether both threads shall end.
    pub(super) fn is_stopped(&self) -> bool {
        self.lock().is_stopped
    }

    /// Waits for `time`, or until both threads shall end.
    pub(super) fn pause(&self, time: Duration) {
        let deadline = Instant::now() + time;
        let mut content = self.lock();
        while !content.is_stopped {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            let waited = self.changed.wait_timeout(content, left);
            content = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn lock(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
