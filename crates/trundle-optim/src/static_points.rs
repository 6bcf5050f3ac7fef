//! The pose by points and a prior, also where a thing that moves shows more points than the static world.

use crate::observation::PointObservation;
use crate::pose::{CORRELATED_POINTS, PoseConfig, PoseProblem, PoseSolution};
use crate::pose_prior::{Hold, PosePrior};
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

impl PoseProblem<'_> {
    /// Refines `world_from_camera`. Without measurements the pose is returned unchanged.
    ///
    /// With `bounded`, a point determines at most a quarter of a part of the pose (three times the mean where points are few). The Huber
    /// loss bounds points that disagree with others, but not a point that no other contradicts: a wrong point 0.1 m before the camera
    /// outweighs hundreds at 8 m. Where the matches were searched around a prediction, the prediction has excluded such a point, and right
    /// points are better counted in full.
    pub fn solve(&self, world_from_camera: Pose3, config: &PoseConfig) -> PoseSolution {
        let by_image = self.by_image(world_from_camera, config);
        let (Some(prior), Some(covariance)) = (self.prior, by_image.covariance) else { return by_image };
        match prior.fused_with(by_image.world_from_camera, &covariance, CORRELATED_POINTS) {
            Some((fused, covariance)) => {
                PoseSolution { world_from_camera: fused, covariance: Some(covariance), ..by_image }
            }
            None => self
                .by_static_points(&by_image, &prior, config)
                .unwrap_or(PoseSolution { contradicts_prior: true, ..by_image }),
        }
    }

    /// The pose by the points that agree with the prior, where `against` is by points that contradict it; `None` if these points do not
    /// determine the pose, contradict the prior too, or are points that agree with both poses. Points of the static world cover much of
    /// the image, and only some of them agree with the motion of a thing. When wheels slip, all points agree with the other pose.
    fn by_static_points(
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
