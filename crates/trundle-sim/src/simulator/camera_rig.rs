//! The camera on the simulated robot, with motion blur and faults.

use super::track::Track;
use crate::camera::{Renderer, RgbdSensor, View, blend};
use crate::config::SimConfig;
use crate::faults::CameraFault;
use crate::world::SceneSnapshot;
use trundle_core::{ColorImage, DepthImage, Invalid, Pose3, RgbdImage, Stamp};

/// The camera on the robot, with its faults.
#[derive(Debug)]
pub(super) struct CameraRig {
    renderer: Renderer,
    sensor: RgbdSensor,
    view: View,
    /// Views at the moments of an exposure, if that takes time.
    moments: Vec<View>,
    /// Seconds.
    shutter: f64,
    base_from_camera: Pose3,
    /// The last image, if a camera that freezes needs it.
    last: Option<RgbdImage>,
    may_freeze: bool,
}

impl CameraRig {
    /// The camera of a valid configuration.
    ///
    /// # Errors
    /// When the camera has lens distortion.
    pub(super) fn new(config: &SimConfig, seed: u64) -> Result<Self, Invalid> {
        let renderer = Renderer::new(config.camera)?;
        let moments = if config.shutter_s > 0.0 { config.sub_exposures } else { 0 };
        Ok(Self {
            sensor: RgbdSensor::new(config.depth_noise.clone(), config.color_noise.clone(), seed)?,
            view: renderer.blank(),
            moments: vec![renderer.blank(); moments],
            shutter: config.shutter_s,
            renderer,
            base_from_camera: config.base_from_camera,
            last: None,
            may_freeze: config.faults.freezes_camera(),
        })
    }

    /// Image number `frame`, taken at `stamp`.
    ///
    /// # Errors
    /// Never for a valid configuration; the type is that of an image's constructor.
    pub(super) fn take(
        &mut self,
        snapshot: &SceneSnapshot<'_>,
        track: &Track,
        stamp: Stamp,
        frame: u64,
        fault: CameraFault,
    ) -> Result<RgbdImage, Invalid> {
        if fault.is_black {
            return self.black(stamp);
        }
        let image = match self.last.take().filter(|_| fault.is_frozen) {
            Some(frozen) => RgbdImage::new(stamp, frozen.color().clone(), frozen.depth().clone())?,
            None => self.capture(snapshot, track, stamp, frame)?,
        };
        self.last = self.may_freeze.then(|| image.clone());
        let image = if fault.is_dark { without_light(&image)? } else { image };
        if fault.has_no_depth { without_depth(&image) } else { Ok(image) }
    }

    fn capture(
        &mut self,
        snapshot: &SceneSnapshot<'_>,
        track: &Track,
        stamp: Stamp,
        frame: u64,
    ) -> Result<RgbdImage, Invalid> {
        let world_from_camera = |age| Pose3::from_pose2(track.back(age)) * self.base_from_camera;
        if self.moments.is_empty() {
            self.renderer.render(snapshot, &world_from_camera(0.0), &mut self.view);
        } else {
            let n = self.moments.len() as f64;
            for (i, moment) in self.moments.iter_mut().enumerate() {
                let age = ((n - 1.0) / 2.0 - i as f64) / n * self.shutter;
                self.renderer.render(snapshot, &world_from_camera(age), moment);
            }
            blend(&self.moments, &mut self.view)?;
        }
        self.sensor.adapt(&self.view, stamp);
        self.sensor.expose(&self.view, stamp, frame)
    }

    fn black(&self, stamp: Stamp) -> Result<RgbdImage, Invalid> {
        let (width, height) = (self.renderer.camera().width(), self.renderer.camera().height());
        RgbdImage::new(stamp, ColorImage::filled(width, height, [0; 3]), no_depth(width, height)?)
    }
}

fn without_light(image: &RgbdImage) -> Result<RgbdImage, Invalid> {
    let color = ColorImage::filled(image.color().width(), image.color().height(), [0; 3]);
    RgbdImage::new(image.stamp(), color, image.depth().clone())
}

fn without_depth(image: &RgbdImage) -> Result<RgbdImage, Invalid> {
    let color = image.color();
    RgbdImage::new(image.stamp(), color.clone(), no_depth(color.width(), color.height())?)
}

fn no_depth(width: usize, height: usize) -> Result<DepthImage, Invalid> {
    DepthImage::new(width, height, vec![0.0; width * height])
}
