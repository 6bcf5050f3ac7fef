//! The charging station, by the robot's light sensors and contacts.

use crate::bumper;
use std::f64::consts::PI;
use trundle_core::{DockInfrared, Footprint, Invalid, Pose2};
use trundle_estimation::{StationEstimate, StationEstimator, StationLightConfig};

/// Seed of the candidates of the station's pose. Source: ours, arbitrary.
const STATION_SEED: u64 = 1;

/// The charging station, and the pose of a docked robot.
#[derive(Debug)]
pub(super) struct ChargingStation {
    estimator: StationEstimator,
    /// `base_from_station` of a docked robot.
    docked: Pose2,
}

impl ChargingStation {
    /// An unknown station, for a robot of this footprint.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(super) fn new(config: StationLightConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        let docked = Pose2::new(bumper::front_of(footprint), 0.0, PI);
        Ok(Self { estimator: StationEstimator::new(config, STATION_SEED)?, docked })
    }

    /// Adds contact with the station at `pose`, map frame.
    pub(super) fn add_contact(&mut self, pose: Pose2) {
        self.estimator.add_contact(pose * self.docked);
    }

    /// Adds the light of the station at `pose`, map frame.
    pub(super) fn add_light(&mut self, pose: Pose2, light: &DockInfrared) {
        self.estimator.add_light(pose, light);
    }

    /// The station's pose; `None` before the first light.
    pub(super) fn estimate(&self) -> Option<StationEstimate> {
        self.estimator.estimate()
    }

    /// Drops the pose, when its map is replaced.
    pub(super) fn forget(&mut self) {
        self.estimator.forget();
    }

    /// Restores the pose of a checkpoint.
    pub(super) fn restore(&mut self, estimate: &StationEstimate) {
        self.estimator.restore(estimate);
    }
}

#[cfg(test)]
mod tests;
