//! A camera that works beside the dynamics, as a real one does.

use super::camera_rig::CameraRig;
use super::track::Track;
use super::{SimError, Simulator};
use crate::faults::CameraFault;
use crate::people::CrowdView;
use crate::scenes::Scene;
use crate::world::SceneSnapshot;
use std::sync::Arc;
use trundle_core::{Invalid, RgbdImage, SensorEvent, Stamp};

/// The simulated camera taken out of its [`Simulator`], for another thread: it makes images of [`Shot`]s.
#[derive(Debug)]
pub struct CameraAside {
    rig: CameraRig,
    scene: Arc<Scene>,
}

/// All that an image depends on at the moment when it is taken.
#[derive(Debug)]
pub struct Shot {
    pub(super) people: CrowdView,
    pub(super) track: Track,
    pub(super) stamp: Stamp,
    pub(super) frame: u64,
    pub(super) fault: CameraFault,
}

impl CameraAside {
    /// The image of a shot: the same as the simulator would have made of it, when every shot is taken, in order.
    ///
    /// # Errors
    /// Never for a valid configuration.
    pub fn take(&mut self, shot: &Shot) -> Result<RgbdImage, SimError> {
        Ok(shot.expose(&mut self.rig, &self.scene)?)
    }
}

impl Shot {
    /// When the image is taken.
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
    /// Takes the camera out: from now on there are no images among the events, but [`Simulator::shots`]. None the second time.
    pub fn detach_camera(&mut self) -> Option<CameraAside> {
        Some(CameraAside { rig: self.rig.take()?, scene: Arc::clone(&self.scene) })
    }

    /// Advances by a millisecond: the sensor events of that time, in order.
    ///
    /// # Errors
    /// As [`trundle_core::RobotBody::next_event`].
    pub fn advance(&mut self) -> Result<impl Iterator<Item = SensorEvent> + use<>, SimError> {
        let before = std::mem::take(&mut self.queue);
        self.step();
        self.read_sensors()?;
        Ok(before.into_iter().chain(std::mem::take(&mut self.queue)))
    }

    /// The shots since the last call, for the camera that was taken out.
    pub fn shots(&mut self) -> Vec<Shot> {
        std::mem::take(&mut self.shots)
    }
}
