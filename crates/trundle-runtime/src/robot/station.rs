//! The charging station, as the robot's light sensors and contacts show it.

use crate::bumper;
use std::f64::consts::PI;
use trundle_core::{DockInfrared, Footprint, Invalid, Pose2};
use trundle_estimation::{StationEstimate, StationEstimator, StationLightConfig};

/// Seed of the candidates of the station's pose. Source: ours; any.
const STATION_SEED: u64 = 1;

/// The charging station and how a robot stands on its contacts.
#[derive(Debug)]
pub(super) struct ChargingStation {
    estimator: StationEstimator,
    /// `base_from_station` of a robot on the contacts.
    docked: Pose2,
}

impl ChargingStation {
    /// A station that was not seen yet, for a robot of this footprint.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(super) fn new(config: StationLightConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        let docked = Pose2::new(bumper::front_of(footprint), 0.0, PI);
        Ok(Self { estimator: StationEstimator::new(config, STATION_SEED)?, docked })
    }

    /// The robot stands on the contacts at `pose`, map frame.
    pub(super) fn add_contact(&mut self, pose: Pose2) {
        self.estimator.add_contact(pose * self.docked);
    }

    /// The light of the station at `pose`, map frame.
    pub(super) fn add_light(&mut self, pose: Pose2, light: &DockInfrared) {
        self.estimator.add_light(pose, light);
    }

    /// The station's pose; none before its light was seen.
    pub(super) fn estimate(&self) -> Option<StationEstimate> {
        self.estimator.estimate()
    }

    /// The map of its pose is replaced: the pose is unknown.
    pub(super) fn forget(&mut self) {
        self.estimator.forget();
    }

    /// Begins with the pose of a checkpoint.
    pub(super) fn restore(&mut self, estimate: &StationEstimate) {
        self.estimator.restore(estimate);
    }
}
