//! The pose by points of the static world, where a thing that moves shows more points.

use super::{CORRELATED_POINTS, PoseConfig, PoseProblem, PoseSolution};
use crate::observation::PointObservation;
use crate::pose_prior::PosePrior;
use nalgebra::{Matrix6, Vector6};
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// Number of points that agree with a prior, below which they do not determine a pose against others: 20, as `tracking.min_inliers` of
/// SLAM. Source: ours.
const MIN_STATIC_POINTS: usize = 20;
/// Image area of the points that agree with the other pose alone, as a multiple of the area of those that agree with the prior alone: 3.
/// Beyond it the prior is wrong. Source: ours; below 4 for a photo over a fifth of the image, above it for wheels that are stuck.
const MAX_MOVING_SPREAD_RATIO: usize = 3;
/// Number of cells in the width of an image in which the spread of points is counted: 12. Source: ours.
const SPREAD_CELLS: f64 = 12.0;

/// A pose that counts as a measurement.
pub(super) struct Hold {
    pose: Pose3,
    /// Inverse covariance of a right perturbation of it (m, rad).
    pub(super) information: Matrix6<f64>,
}

impl Hold {
    /// Right perturbation that leads from here to `pose` (m, rad).
    pub(super) fn offset(&self, pose: Pose3) -> Vector6<f64> {
        (self.pose.inverse() * pose).log()
    }

    pub(super) fn cost(&self, pose: Pose3) -> f64 {
        let offset = self.offset(pose);
        offset.dot(&(self.information * offset))
    }
}

impl PoseProblem<'_> {
    /// The pose by the points that agree with the prior, where `against` is by points that contradict it; `None` if these points do not
    /// determine the pose, contradict the prior too, or are points that agree with both poses. Points of the static world cover much of
    /// the image, and only some of them agree with the motion of a thing. When wheels slip, all points agree with the other pose.
    pub(super) fn by_static_points(
        &self,
        against: &PoseSolution,
        prior: &PosePrior,
        config: &PoseConfig,
    ) -> Option<PoseSolution> {
        // The prior holds the pose while the points are classified.
        let mut inliers = vec![true; self.observations.len()];
        self.classify(prior.world_from_camera, &mut inliers);
        let held =
            Hold { pose: prior.world_from_camera, information: prior.covariance.cholesky()?.inverse() };
        let pose = self.rounds(held.pose, &mut inliers, Some(&held), config);
        let weights = self.weights(pose, &inliers);
        let found = self.summarise(self.optimise(pose, &weights, None, config), inliers);
        let (fused, covariance) =
            prior.fused_with(found.world_from_camera, &found.covariance?, CORRELATED_POINTS)?;
        let moving = |i: usize| against.inliers[i] && !found.inliers[i];
        let unmoved = |i: usize| !against.inliers[i] && found.inliers[i];
        let is_static = self.spread(unmoved) * MAX_MOVING_SPREAD_RATIO >= self.spread(moving);
        let moving = (0..self.observations.len()).filter(|i| moving(*i)).count();
        (found.inlier_count >= MIN_STATIC_POINTS && is_static).then_some(PoseSolution {
            world_from_camera: fused,
            covariance: Some(covariance),
            moving,
            ..found
        })
    }

    /// Number of cells of the image, [`SPREAD_CELLS`] in its width, that hold some of these observations.
    fn spread(&self, holds: impl Fn(usize) -> bool) -> usize {
        let size = self.camera.width() as f64 / SPREAD_CELLS;
        let cell = |seen: &PointObservation| (seen.pixel / size).map(|at| at.floor() as i32);
        let seen = self.observations.iter().enumerate().filter(|(i, _)| holds(*i));
        let cells: BTreeSet<[i32; 2]> = seen.map(|(_, (_, seen))| cell(seen).into()).collect();
        cells.len()
    }
}
