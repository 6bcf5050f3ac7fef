//! A camera whose frames come from another process, which may crash without harm.

use super::StreamCamera;
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A camera whose frames come from the standard output of another process. The process ends with this value.
#[derive(Debug)]
pub struct ProcessCamera {
    stream: StreamCamera,
    process: RunningProcess,
}

#[derive(Debug)]
struct RunningProcess(Child);

impl Drop for RunningProcess {
    fn drop(&mut self) {
        // The process may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl ProcessCamera {
    /// Starts `command`, named `place` in messages, and waits at most `timeout` for the header of its stream.
    ///
    /// # Errors
    /// When the process cannot be started, or the header does not come in time or is not valid.
    pub fn start(mut command: Command, place: &str, timeout: Duration) -> Result<Self, CameraError> {
        let failed = |source| CameraError::Io { place: place.to_owned(), source };
        let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().map_err(failed)?;
        let mut process = RunningProcess(child);
        let Some(output) = process.0.stdout.take() else {
            return Err(failed(std::io::Error::other("the process has no standard output")));
        };
        let stream = StreamCamera::from_reader(Box::new(output), place, timeout)?;
        Ok(Self { stream, process })
    }

    /// Number of the process, for messages.
    #[must_use]
    pub fn process_id(&self) -> u32 {
        self.process.0.id()
    }
}

impl DepthCamera for ProcessCamera {
    fn info(&self) -> &CameraInfo {
        self.stream.info()
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        self.stream.next_frame(timeout)
    }

    fn has_ended(&self) -> bool {
        self.stream.has_ended()
    }
}
