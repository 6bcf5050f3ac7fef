//! The pose of a frame by matches with points of the map.

use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::matching::point_match::PointMatch;
use crate::median::median;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{InverseDepth, PointObservation, PoseConfig, PosePrior, PoseProblem, PoseSolution};

/// Prior of a camera's pose besides the image.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PosePriorKind<'a> {
    /// The camera was tracked; the pose by odometry is given if known.
    Tracked(Option<&'a PosePrior>),
    /// The pose is unknown.
    Unknown,
}

/// Ratio of the standard deviation of a normal distribution to the median of its absolute values: 1.4826. Source: 1 over the 75th
/// percentile of the normal distribution.
const SIGMA_OVER_MEDIAN: f64 = 1.4826;

/// The pose of a frame, and the matches that determine it.
#[derive(Debug, Clone)]
pub(crate) struct MatchedPose {
    pub matches: Vec<PointMatch>,
    pub solution: PoseSolution,
}

impl MatchedPose {
    /// Refines `start` by `matches` and the prior.
    pub fn by(
        matches: Vec<PointMatch>,
        (start, prior): (Pose3, PosePriorKind),
        frame: &Frame,
        model: &ObservationModel,
        config: &PoseConfig,
    ) -> Self {
        let observe = |m: &PointMatch| (m.point, inflated(m.observation(frame), m.sigma_factor));
        let observations: Vec<(Vector3, PointObservation)> = matches.iter().map(observe).collect();
        let (prior, bounded) = match prior {
            PosePriorKind::Tracked(prior) => (prior.copied(), false),
            PosePriorKind::Unknown => (None, true),
        };
        let problem = PoseProblem { camera: &model.camera, observations: &observations, prior, bounded };
        let solution = problem.solve(start, config);
        Self { matches, solution }
    }

    /// Scale of the errors of aligned features in their standard deviations, by the median; 0 without aligned features.
    pub fn spread(&self, model: &ObservationModel) -> f64 {
        let camera_from_visual = self.visual_from_camera().inverse();
        let errors = |m: &PointMatch| {
            let aligned = m.aligned.filter(|aligned| aligned.is_aligned)?;
            let seen = model.camera.project(camera_from_visual.transform(m.point))?;
            let error = (seen - aligned.pixel) / (aligned.sigma * m.sigma_factor);
            Some([error.x.abs(), error.y.abs()])
        };
        median(self.matches.iter().filter_map(errors).flatten()).map_or(0.0, |size| SIGMA_OVER_MEDIAN * size)
    }

    /// The matches that agree with the pose.
    pub fn inliers(&self) -> impl Iterator<Item = &PointMatch> {
        self.matches.iter().zip(&self.solution.inliers).filter_map(|(m, inlier)| inlier.then_some(m))
    }

    pub fn visual_from_camera(&self) -> Pose3 {
        self.solution.world_from_camera
    }

    /// Whether at least `min_inliers` matches agree, and they determine the pose.
    pub fn is_sound(&self, min_inliers: usize) -> bool {
        self.solution.inlier_count >= min_inliers && self.solution.covariance.is_some()
    }

    /// Whether a majority of the matches agrees, without matches of a moving object. With a wrong prediction, some wrong matches agree by
    /// chance.
    pub fn has_majority(&self) -> bool {
        2 * self.solution.inlier_count + self.solution.moving >= self.matches.len()
    }
}

fn inflated(seen: PointObservation, factor: f64) -> PointObservation {
    let depth = seen.depth.map(|d| InverseDepth { sigma: d.sigma * factor, ..d });
    PointObservation { pixel_sigma: seen.pixel_sigma * factor, depth, ..seen }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::aligned_feature::Aligned;
    use crate::testing::{model, painted_frame, painted_map, painted_points};
    use trundle_core::Vector2;

    #[test]
    fn the_spread_is_the_scale_of_the_aligned_residuals() {
        let (model, (map, _)) = (model(), painted_map());
        let frame = painted_frame(Pose3::identity(), &painted_points(), Vector2::zeros());
        let aligned = |i: usize| {
            let off = Vector2::new(
                if i.is_multiple_of(2) { 0.4 } else { -0.4 },
                if (i / 2).is_multiple_of(2) { 0.4 } else { -0.4 },
            );
            Aligned { raw: frame.pixels[i], pixel: frame.pixels[i] + off, sigma: 0.5, is_aligned: i < 40 }
        };
        let matches = map.landmarks().enumerate().map(|(i, (id, _))| {
            let m = PointMatch::of_landmark(i, id, &map).unwrap();
            PointMatch { aligned: Some(aligned(i)), sigma_factor: 1.0, ..m }
        });
        let known = PosePriorKind::Tracked(None);
        let fix = MatchedPose::by(
            matches.collect(),
            (Pose3::identity(), known),
            &frame,
            &model,
            &PoseConfig::default(),
        );
        let spread = fix.spread(&model);
        assert!((spread - SIGMA_OVER_MEDIAN * 0.8).abs() < 0.2, "{spread}");
        let none = MatchedPose { matches: vec![], ..fix };
        assert_eq!(none.spread(&model), 0.0);
    }
}
