//! A camera of OpenNI2 in a separate process.
//!
//! The drivers of OpenNI2 crash at their shutdown, which ends their process. A child process therefore runs [`serve_openni`] and writes the
//! frames to its output; the robot's process reads them as a camera stream.

use super::{OpenNiApi, OpenNiCamera, OpenNiSettings};
use crate::camera::native::Selection;
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera};
use std::time::Duration;

/// Longest wait for a frame before the next try. Source: ours.
const FRAME_TIMEOUT: Duration = Duration::from_secs(1);

/// Opens a camera or a recording and hands each frame to the function that `start` returns, until that function fails or the recording ends.
///
/// With a stream writer: `serve_openni(&selection, &settings, |info| { let mut writer = StreamWriter::new(out, info)?;
/// Ok(move |frame: CameraFrame| writer.write(&frame)) })`.
///
/// # Errors
/// When the camera cannot be opened or read, or the function fails.
pub fn serve_openni<F>(
    selection: &Selection,
    settings: &OpenNiSettings,
    start: impl FnOnce(&CameraInfo) -> Result<F, CameraError>,
) -> Result<(), CameraError>
where
    F: FnMut(CameraFrame) -> Result<(), CameraError>,
{
    let api = OpenNiApi::load(settings.library.as_deref())?;
    let mut camera = OpenNiCamera::open(&api, selection, settings)?;
    let mut send = start(camera.info())?;
    while !camera.has_ended() {
        match camera.next_frame(FRAME_TIMEOUT) {
            Ok(Some(frame)) => send(frame)?,
            Ok(None) => {}
            Err(error) if error.is_of_one_frame() => tracing::warn!(%error, "a frame is left out"),
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
