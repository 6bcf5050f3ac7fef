//! Configuration of the simulated robot: body, sensors, noise and faults.

use crate::camera::{ColorNoise, DepthNoise};
use crate::charging_station::StationConfig;
use crate::faults::FaultSchedule;
use crate::kobuki::KobukiConfig;
use crate::laser::LaserConfig;
use nalgebra::{Matrix3, Rotation3};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PinholeCamera, Pose3, Vector3, require_in};

/// The simulated robot: body, sensors and their noise, and what breaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SimConfig {
    /// The body.
    pub kobuki: KobukiConfig,
    /// Whether there is a camera. Default true.
    pub has_camera: bool,
    /// The camera, rectified. Default Kinect V2.
    pub camera: PinholeCamera,
    /// Pose of the camera's optical frame (x right, y down, z forward) on the base. Default [`camera_mount`]`(0.05, 0.45, 8 deg)`.
    pub base_from_camera: Pose3,
    /// Images per second, Hz, 0.1 to 120. Default 15: half the Kinect V2's 30.
    pub camera_rate_hz: f64,
    /// How long the colour camera's shutter is open, about an image's stamp, s, 0 to 0.1. Default 0: no motion blur.
    pub shutter_s: f64,
    /// Moments of an exposure that are drawn and averaged while the shutter is open, an odd number from 1 to 63. Default 7.
    /// Each costs as much as an image.
    pub sub_exposures: usize,
    /// Noise of depth.
    pub depth_noise: DepthNoise,
    /// Noise of colour.
    pub color_noise: ColorNoise,
    /// A 2-D laser. Default none.
    pub laser: Option<LaserConfig>,
    /// Faults and their times. Default none.
    pub faults: FaultSchedule,
    /// Light and contacts of the charging station, for a scene that has one.
    pub station: StationConfig,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            kobuki: KobukiConfig::default(),
            has_camera: true,
            camera: PinholeCamera::kinect_v2(),
            base_from_camera: camera_mount(0.05, 0.45, 8_f64.to_radians()),
            camera_rate_hz: 15.0,
            shutter_s: 0.0,
            sub_exposures: 7,
            depth_noise: DepthNoise::default(),
            color_noise: ColorNoise::default(),
            laser: None,
            faults: FaultSchedule::default(),
            station: StationConfig::default(),
        }
    }
}

/// A preset of a front end: name, help text, and what makes it.
pub type Preset<T> = (&'static str, &'static str, fn() -> T);

impl SimConfig {
    /// The cameras of a front end: name, help text, robot with it.
    pub const CAMERAS: [Preset<Self>; 2] = [
        ("kinect-v2", "Kinect V2: 512 x 424", Self::kinect_v2),
        ("kinect-v1", "Kinect v1, as of TUM's sequences: 640 x 480", Self::kinect_v1),
    ];

    /// A robot with a Kinect V2, 512 x 424 at 15 Hz: the default.
    pub fn kinect_v2() -> Self {
        Self::default()
    }

    /// A robot with a Kinect v1, 640 x 480 at 30 Hz, as of the TUM RGB-D benchmark \[Sturm12\].
    pub fn kinect_v1() -> Self {
        Self {
            camera: PinholeCamera::kinect_v1(),
            camera_rate_hz: 30.0,
            depth_noise: DepthNoise::kinect_v1(),
            ..Self::default()
        }
    }

    /// The same robot without any noise; dynamics, range, rates and faults stay.
    pub fn without_noise(self) -> Self {
        Self {
            kobuki: self.kobuki.without_noise(),
            depth_noise: DepthNoise::none(),
            color_noise: ColorNoise::none(),
            laser: self.laser.map(LaserConfig::without_noise),
            station: self.station.without_noise(),
            ..self
        }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range or not finite.
    pub fn validated(self) -> Result<Self, Invalid> {
        if !self.base_from_camera.is_finite() {
            return Err(Invalid::new("base_from_camera", "not finite", "", "finite numbers"));
        }
        require_in("camera_rate_hz", self.camera_rate_hz, "Hz", 0.1, 120.0)?;
        require_in("shutter_s", self.shutter_s, "s", 0.0, 0.1)?;
        if self.sub_exposures.is_multiple_of(2) || self.sub_exposures > 63 {
            return Err(Invalid::new("sub_exposures", self.sub_exposures, "", "an odd number from 1 to 63"));
        }
        Ok(Self {
            kobuki: self.kobuki.validated()?,
            depth_noise: self.depth_noise.validated()?,
            color_noise: self.color_noise.validated()?,
            laser: self.laser.map(LaserConfig::validated).transpose()?,
            faults: self.faults.validated()?,
            station: self.station.validated()?,
            ..self
        })
    }

    /// Time for which poses of the base are stored, s: one turn of the laser, or half an exposure if that is longer.
    pub(crate) fn memory(&self) -> f64 {
        let turn = self.laser.as_ref().map_or(0.0, |laser| 1.0 / laser.rate_hz);
        turn.max(self.shutter_s / 2.0)
    }
}

/// `base_from_camera` of a camera `forward` m before and `up` m above the base's origin, looking forward and `pitch` rad down.
pub fn camera_mount(forward: f64, up: f64, pitch: f64) -> Pose3 {
    let body_from_optical = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), pitch).into_inner();
    Pose3::from_matrix(tilt * body_from_optical, Vector3::new(forward, 0.0, up))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mount_looks_forward_and_down() {
        let axis = camera_mount(0.1, 0.5, 30_f64.to_radians()).rotate(Vector3::z());
        assert!((axis - Vector3::new(0.75_f64.sqrt(), 0.0, -0.5)).norm() < 1e-12);
    }

    #[test]
    fn presets_are_valid() {
        for config in [SimConfig::kinect_v2(), SimConfig::kinect_v1()] {
            assert!(config.validated().is_ok());
        }
        let even = SimConfig { sub_exposures: 4, ..SimConfig::default() };
        assert_eq!(even.validated().unwrap_err().field, "sub_exposures");
    }

    #[test]
    fn defaults_are_valid_and_nan_is_refused() {
        assert!(SimConfig::default().validated().is_ok());
        assert!(SimConfig::default().without_noise().validated().is_ok());
        let bad = SimConfig { base_from_camera: camera_mount(f64::NAN, 0.4, 0.0), ..SimConfig::default() };
        assert_eq!(bad.validated().unwrap_err().field, "base_from_camera");
    }
}
