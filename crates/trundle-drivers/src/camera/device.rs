//! The trait of a depth camera.

use super::{CameraError, CameraFrame, CameraInfo, GyroSample};
use std::time::Duration;

/// A camera that delivers pairs of a colour and a depth image.
pub trait DepthCamera: Send {
    /// Facts of the camera and its streams. The facts are constant while the camera is open.
    fn info(&self) -> &CameraInfo;

    /// The next frame; `None` if none came within `timeout`, or a sample of the gyro came first.
    ///
    /// # Errors
    /// [`CameraError::BrokenFrame`] when one frame is damaged: the next call may succeed. After every other error the camera must be
    /// reopened.
    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError>;

    /// The samples of the camera's gyro since the last call, oldest first; empty for a camera without one.
    fn take_gyro(&mut self) -> Vec<GyroSample> {
        Vec::new()
    }

    /// Whether no further frame will follow. Always `false` for a live camera; `true` at the end of a recording.
    fn has_ended(&self) -> bool {
        false
    }
}
