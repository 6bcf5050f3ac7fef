//! A camera that runs in parallel with the dynamics, like a real one.

use super::camera_rig::CameraRig;
use super::track::Track;
use super::{SimError, Simulator};
use crate::faults::CameraFault;
use crate::people::CrowdView;
use crate::scenes::Scene;
use crate::world::SceneSnapshot;
use std::sync::Arc;
use trundle_core::{Invalid, RgbdImage, SensorEvent, Stamp};

/// The simulated camera, detached from its [`Simulator`] for another thread: it makes images of [`Shot`]s.
#[derive(Debug)]
pub struct DetachedCamera {
    rig: CameraRig,
    scene: Arc<Scene>,
}

/// All data needed for an image.
#[derive(Debug)]
pub struct Shot {
    pub(super) people: CrowdView,
    pub(super) track: Track,
    pub(super) stamp: Stamp,
    pub(super) frame: u64,
    pub(super) fault: CameraFault,
}

impl DetachedCamera {
    /// The image of a shot, equal to the simulator's own image if all shots are taken in order.
    ///
    /// # Errors
    /// Never for a valid configuration.
    pub fn take(&mut self, shot: &Shot) -> Result<RgbdImage, SimError> {
        Ok(shot.expose(&mut self.rig, &self.scene)?)
    }
}

impl Shot {
    /// Stamp of the image.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// Delay of the image by a fault, s.
    pub fn delay(&self) -> f64 {
        self.fault.delay
    }

    pub(super) fn expose(&self, rig: &mut CameraRig, scene: &Scene) -> Result<RgbdImage, Invalid> {
        let movers = self.people.movers();
        let snapshot = SceneSnapshot { world: &scene.world, movers: &movers, lights: &scene.lights };
        rig.take(&snapshot, &self.track, self.stamp, self.frame, self.fault)
    }
}

impl Simulator {
    /// Detaches the camera: from now on images are not among the events, but are made from [`Simulator::shots`]. `None` the second time.
    pub fn detach_camera(&mut self) -> Option<DetachedCamera> {
        Some(DetachedCamera { rig: self.camera.rig.take()?, scene: Arc::clone(&self.scene) })
    }

    /// Advances by one millisecond; returns the sensor events of that time, in order.
    ///
    /// # Errors
    /// As [`trundle_core::RobotBody::next_event`].
    pub fn advance(&mut self) -> Result<impl Iterator<Item = SensorEvent> + use<>, SimError> {
        let before = std::mem::take(&mut self.outgoing.queue);
        self.step();
        self.read_sensors()?;
        Ok(before.into_iter().chain(std::mem::take(&mut self.outgoing.queue)))
    }

    /// The shots since the last call, for the camera that was taken out.
    pub fn shots(&mut self) -> Vec<Shot> {
        std::mem::take(&mut self.camera.shots)
    }
}
