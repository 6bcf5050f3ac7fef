//! Stamps of the camera mapped to the sensors' clock.

use crate::camera::CameraInfo;
use trundle_core::Stamp;

/// Converts a time on the camera's clock and the frame's arrival on the host's clock to the sensors' clock.
pub type StampMap = Box<dyn FnMut(Stamp, Stamp) -> Stamp + Send>;
/// Makes the map of an opened camera. The camera's own clock may restart with each opening.
pub type StampMapFactory = Box<dyn FnMut(&CameraInfo) -> StampMap + Send>;

/// The simplest map: the arrival minus the camera's delay. It includes the jitter of the arrival.
pub fn arrival_minus_delay(info: &CameraInfo) -> StampMap {
    let delay_s = info.delay_s;
    Box::new(move |_, arrival| arrival.after(-delay_s))
}

/// The stamps of the camera itself, as in a recording.
pub fn recorded_stamps(_info: &CameraInfo) -> StampMap {
    Box::new(|device, _| device)
}

/// [`arrival_minus_delay`] for a live camera, [`recorded_stamps`] for a recording.
pub fn default_stamps(info: &CameraInfo) -> StampMap {
    if info.is_live { arrival_minus_delay(info) } else { recorded_stamps(info) }
}
