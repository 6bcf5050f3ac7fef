//! Samples of a camera's gyro as turns of the base.

use super::StampMap;
use crate::camera::{CameraInfo, DepthCamera, GyroSample};
use nalgebra::UnitQuaternion;
use trundle_core::{GyroRate, Stamp};

/// Converts the samples of an opened camera to turns of the base around its vertical axis.
pub(super) struct BaseGyro {
    base_from_gyro: UnitQuaternion<f64>,
    stamps: StampMap,
    last: Option<Stamp>,
}

impl BaseGyro {
    /// The gyro of a camera; `base_from_camera` is the rotation of the colour camera on the base, `stamps` maps the samples' stamps.
    pub(super) fn new(info: &CameraInfo, base_from_camera: UnitQuaternion<f64>, stamps: StampMap) -> Self {
        let color_from_depth =
            info.color_from_depth.map_or_else(UnitQuaternion::identity, |pose| pose.rotation);
        Self { base_from_gyro: base_from_camera * color_from_depth, stamps, last: None }
    }

    /// The samples that `camera` has read, oldest first, by rising stamps; `arrival` is the present time of the host.
    pub(super) fn take(&mut self, camera: &mut dyn DepthCamera, arrival: Stamp) -> Vec<GyroRate> {
        camera.take_gyro().into_iter().map(|sample| self.turn(&sample, arrival)).collect()
    }

    fn turn(&mut self, sample: &GyroSample, arrival: Stamp) -> GyroRate {
        let stamp = (self.stamps)(sample.device_stamp, arrival);
        let stamp = self.last.map_or(stamp, |last| stamp.max(last));
        self.last = Some(stamp);
        GyroRate { stamp, omega: (self.base_from_gyro * sample.rate).z }
    }
}
