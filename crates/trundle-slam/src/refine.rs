use crate::align::Aligned;
use crate::frame::Frame;
use crate::ids::LandmarkId;
use crate::map::LandmarkMap;
use crate::median::median;
use crate::sensor::Sensor;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{InverseDepth, PointObservation, PoseConfig, PosePrior, PoseProblem, PoseSolution};

/// A feature of the frame, taken for a point of the visual frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointMatch {
    pub feature: usize,
    /// Visual frame, m.
    pub point: Vector3,
    /// Which landmark the point is, unless it is only a depth of an earlier frame.
    pub landmark: Option<LandmarkId>,
    /// How much larger the standard deviations are, because the point is not known exactly.
    pub sigma_factor: f64,
    /// Where the feature is by what is around it, if that fits.
    pub aligned: Option<Aligned>,
}

impl PointMatch {
    /// A feature taken for a landmark, as well known as that is; `None` when the landmark is forgotten.
    pub fn of_landmark(feature: usize, id: LandmarkId, map: &LandmarkMap) -> Option<Self> {
        let landmark = map.landmark(id)?;
        let (point, sigma_factor) = (landmark.position, landmark.sigma_factor());
        Some(Self { feature, point, landmark: Some(id), sigma_factor, aligned: None })
    }

    /// What the frame says of its feature.
    fn observation(&self, frame: &Frame, sensor: &Sensor) -> PointObservation {
        let found = sensor.observation(frame, self.feature);
        let aligned = |Aligned { pixel, sigma, .. }| PointObservation { pixel, pixel_sigma: sigma, ..found };
        self.aligned.map_or(found, aligned)
    }
}

/// What is known of a camera besides what an image shows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Known<'a> {
    /// It was followed to here, by wheels, if there are any.
    Followed(Option<&'a PosePrior>),
    /// It may be anywhere: nothing contradicts what looks right.
    Nothing,
}

/// What a standard deviation of normal errors is in medians of their sizes.
const DEVIATIONS: f64 = 1.4826;

/// The pose of a frame, and by which matches.
#[derive(Debug, Clone)]
pub(crate) struct Fix {
    pub matches: Vec<PointMatch>,
    pub solution: PoseSolution,
}

impl Fix {
    /// Refines `start` on `matches`, and on what else is known of the camera.
    pub fn by(
        matches: Vec<PointMatch>,
        (start, known): (Pose3, Known),
        frame: &Frame,
        sensor: &Sensor,
        config: &PoseConfig,
    ) -> Self {
        let observe = |m: &PointMatch| (m.point, widened(m.observation(frame, sensor), m.sigma_factor));
        let observations: Vec<(Vector3, PointObservation)> = matches.iter().map(observe).collect();
        let (prior, bounded) = match known {
            Known::Followed(prior) => (prior.copied(), false),
            Known::Nothing => (None, true),
        };
        let problem = PoseProblem { camera: &sensor.camera, observations: &observations, prior, bounded };
        let solution = problem.solve(start, config);
        Self { matches, solution }
    }

    /// By how much aligned features are farther off than they say: their median error in standard deviations; 0 of none.
    pub fn spread(&self, sensor: &Sensor) -> f64 {
        let camera_from_visual = self.visual_from_camera().inverse();
        let errors = |m: &PointMatch| {
            let aligned = m.aligned.filter(|aligned| aligned.is_alike)?;
            let seen = sensor.camera.project(camera_from_visual.transform(m.point))?;
            let error = (seen - aligned.pixel) / (aligned.sigma * m.sigma_factor);
            Some([error.x.abs(), error.y.abs()])
        };
        median(self.matches.iter().filter_map(errors).flatten()).map_or(0.0, |size| DEVIATIONS * size)
    }

    /// The matches that agree with the pose.
    pub fn inliers(&self) -> impl Iterator<Item = &PointMatch> {
        self.matches.iter().zip(&self.solution.inliers).filter_map(|(m, inlier)| inlier.then_some(m))
    }

    pub fn visual_from_camera(&self) -> Pose3 {
        self.solution.world_from_camera
    }

    /// Whether enough matches agree to believe it, and they determine the pose.
    pub fn is_sound(&self, least_inliers: usize) -> bool {
        self.solution.inlier_count >= least_inliers && self.solution.covariance.is_some()
    }

    /// Whether most matches agree: where the prediction is off, windows are full of wrong ones that agree by chance.
    pub fn is_convincing(&self) -> bool {
        2 * self.solution.inlier_count >= self.matches.len()
    }
}

fn widened(seen: PointObservation, factor: f64) -> PointObservation {
    let depth = seen.depth.map(|d| InverseDepth { sigma: d.sigma * factor, ..d });
    PointObservation { pixel_sigma: seen.pixel_sigma * factor, depth, ..seen }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{painted_frame, painted_map, painted_points, sensor};
    use trundle_core::Vector2;

    #[test]
    fn the_spread_is_what_is_left_of_aligned_features_in_what_they_say() {
        let (sensor, (map, _)) = (sensor(), painted_map());
        let frame = painted_frame(Pose3::identity(), &painted_points(), Vector2::zeros());
        let aligned = |i: usize| {
            let off = Vector2::new(
                if i.is_multiple_of(2) { 0.4 } else { -0.4 },
                if (i / 2).is_multiple_of(2) { 0.4 } else { -0.4 },
            );
            Aligned { raw: frame.pixels[i], pixel: frame.pixels[i] + off, sigma: 0.5, is_alike: i < 40 }
        };
        let matches = map.landmarks().enumerate().map(|(i, (id, _))| {
            let m = PointMatch::of_landmark(i, id, &map).unwrap();
            PointMatch { aligned: Some(aligned(i)), sigma_factor: 1.0, ..m }
        });
        let known = Known::Followed(None);
        let fix =
            Fix::by(matches.collect(), (Pose3::identity(), known), &frame, &sensor, &PoseConfig::default());
        let spread = fix.spread(&sensor);
        assert!((spread - DEVIATIONS * 0.8).abs() < 0.2, "{spread}");
        let none = Fix { matches: vec![], ..fix };
        assert_eq!(none.spread(&sensor), 0.0);
    }
}
