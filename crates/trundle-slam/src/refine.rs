use crate::frame::Frame;
use crate::ids::LandmarkId;
use crate::map::LandmarkMap;
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
}

impl PointMatch {
    /// A feature taken for a landmark, as well known as that is; `None` when the landmark is forgotten.
    pub fn of_landmark(feature: usize, id: LandmarkId, map: &LandmarkMap) -> Option<Self> {
        let landmark = map.landmark(id)?;
        let (point, sigma_factor) = (landmark.position, landmark.sigma_factor());
        Some(Self { feature, point, landmark: Some(id), sigma_factor })
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
        let observe =
            |m: &PointMatch| (m.point, widened(sensor.observation(frame, m.feature), m.sigma_factor));
        let observations: Vec<(Vector3, PointObservation)> = matches.iter().map(observe).collect();
        let (prior, bounded) = match known {
            Known::Followed(prior) => (prior.copied(), false),
            Known::Nothing => (None, true),
        };
        let problem = PoseProblem { camera: &sensor.camera, observations: &observations, prior, bounded };
        let solution = problem.solve(start, config);
        Self { matches, solution }
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
