//! Height, pitch and roll of a camera from the floor in its depth images.
//!
//! Problem: the floor's plane in the camera frame from depth images with walls and objects in them. Idea: a plane `q * p = 1` gives an
//! inverse depth `1/z = q * ray`, linear in q. RANSAC with planes through three pixels proposes a floor for each image \[Fischler81\]. The
//! median over the images is correct if more than half of the proposals are. Starting there, each image's floor is refined by least squares
//! on the inverse depth. A ramp ahead may fill more of the image than the floor before it: where the nearest points lie on a plane of another
//! tilt, the image counts by its nearest points alone, since the wheels stand there next. Cost: 500 planes over some 1,000 samples per image.

use super::estimate::Estimate;
use super::planar_track::tilt_of;
use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{DepthImage, Hypotenuse, PinholeCamera, Vector3};

/// The floor in the camera's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorView {
    /// Upward axis, unit vector.
    pub up: Vector3,
    /// Height of the camera above the floor, m.
    pub height: f64,
}

/// Height, pitch and roll over several images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorMount {
    /// Height above the floor, m.
    pub height: Estimate,
    /// Tilt downward, rad.
    pub pitch: Estimate,
    /// Roll around the optical axis, rad.
    pub roll: Estimate,
    /// Number of images with a visible floor.
    pub images: usize,
}

/// Distance of neighbouring samples along rows and columns, px. Source: ours; about 2,000 samples of a Kinect V2.
const SAMPLE_STEP_PX: usize = 10;
/// Largest depth of a sample: 4 m. Source: ours; the noise of depth grows with its square.
const MAX_DEPTH_M: f64 = 4.0;
/// Maximum number of planes tried per image. Source: \[Fischler81\]: three of 20 % floor pixels are found with 98 % probability.
const MAX_PLANE_TRIALS: usize = 500;
/// Largest distance of a supporting point from the plane: 0.03 m. Source: ours.
const SUPPORT_DISTANCE_M: f64 = 0.03;
/// Fraction of the samples that must be floor: 0.1. Source: ours.
const MIN_SUPPORT_RATIO: f64 = 0.1;
/// Smallest number of samples with depth. Source: ours.
const MIN_SAMPLES: usize = 100;
/// Largest angle between the floor and the floor expected by the mount in use: 20 deg. A plane with a larger angle is a wall or a ramp.
/// Source: ours.
const MAX_TILT_ERROR_RAD: f64 = 0.35;
/// Lowest camera: 0.05 m. Source: ours.
const MIN_HEIGHT_M: f64 = 0.05;
/// Highest camera: 3 m. Source: the range of `mount.z_m`.
const MAX_HEIGHT_M: f64 = 3.0;
/// Common bias of the height in all images (one sigma): 1 mm. Source: recordings round depth to 1 mm.
const HEIGHT_BIAS_M: f64 = 0.001;
/// Common bias of pitch and roll in all images (one sigma): 0.1 deg. Source: the simulated Kinect V2.
const TILT_BIAS_RAD: f64 = 0.0017;
/// Number of rounds of the refinement. Source: ours.
const REFINEMENT_ROUNDS: usize = 5;
/// Largest angle of an image's floor to the median: 2 deg. Source: ours; the noise of a depth image is below 0.5 deg.
const MAX_ANGLE_TO_MEDIAN_RAD: f64 = 0.035;
/// Largest difference of an image's height to the median: 0.03 m. Source: ours.
const MAX_HEIGHT_TO_MEDIAN_M: f64 = 0.03;

/// Depth of the nearest points over the smallest depth of an image \[1\]: up to 0.95 m of a camera 0.45 m high. Source: ours.
const NEAR_DEPTH_RATIO: f64 = 1.5;
/// Share of an image's samples that may be nearer than its smallest depth: errors of depth. Source: ours.
const NEAREST_SHARE: f64 = 0.02;
/// Smallest share of the nearest points on one plane for this plane to be the ground \[1\]: clutter is no ground. Source: ours.
const MIN_NEAR_SUPPORT_RATIO: f64 = 0.8;

/// The floor over the images of a recording.
#[derive(Debug, Clone)]
pub struct FloorSearch {
    expected_up: Vector3,
    /// Samples of each image, and the floor proposed by the image.
    images: Vec<(Vec<Vector3>, Option<FloorView>)>,
}

impl FloorSearch {
    /// A search for a camera whose upward axis is about `expected_up` (camera frame), to 20 deg.
    #[must_use]
    pub fn new(expected_up: Vector3) -> Self {
        Self { expected_up, images: Vec::new() }
    }

    /// Adds a depth image (m). Deterministic.
    pub fn add(&mut self, depth: &DepthImage, camera: &PinholeCamera) {
        let samples = samples(depth, camera);
        let view = FloorView::propose(&samples, self.expected_up);
        let ground = view.and_then(|view| view.ground_before(near(&samples), self.expected_up));
        self.images.push(ground.map_or((samples, view), |(near, ground)| (near, Some(ground))));
    }

    /// Number of images, and of those with enough depth.
    #[must_use]
    pub fn image_counts(&self) -> (usize, usize) {
        let with_depth = self.images.iter().filter(|(samples, _)| samples.len() >= MIN_SAMPLES);
        (self.images.len(), with_depth.count())
    }

    /// Number of images that show a level plane, which need not be the same in all of them.
    #[must_use]
    pub fn proposals(&self) -> usize {
        self.images.iter().filter(|(_, view)| view.is_some()).count()
    }

    /// The floor of each image with a visible floor.
    #[must_use]
    pub fn views(&self) -> Vec<FloorView> {
        let Some(median) = self.median() else { return Vec::new() };
        let refined = |(samples, _): &(Vec<Vector3>, Option<FloorView>)| {
            median.refined(samples).filter(|view| view.agrees(&median) && view.is_supported(samples))
        };
        self.images.iter().filter_map(refined).collect()
    }

    /// The median of all proposals, by component.
    fn median(&self) -> Option<FloorView> {
        let median = |value: &dyn Fn(&FloorView) -> f64| {
            let mut values: Vec<f64> =
                self.images.iter().filter_map(|(_, view)| view.as_ref()).map(value).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied()
        };
        let up =
            Vector3::new(median(&|view| view.up.x)?, median(&|view| view.up.y)?, median(&|view| view.up.z)?);
        Some(FloorView { up: up.try_normalize(0.5)?, height: median(&|view| view.height)? })
    }
}

impl FloorView {
    /// The plane with the largest support and a tilt near the expected one; `None` without visible floor.
    fn propose(samples: &[Vector3], expected_up: Vector3) -> Option<Self> {
        if samples.len() < MIN_SAMPLES {
            return None;
        }
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut draw = || samples[rng.random_range(0..samples.len())];
        let candidates = (0..MAX_PLANE_TRIALS).filter_map(|_| Self::through([draw(), draw(), draw()]));
        let level = candidates.filter(|plane| plane.up.angle(&expected_up) <= MAX_TILT_ERROR_RAD);
        let rated = level.map(|plane| (plane.support(samples).count(), plane));
        let best = rated.fold(None::<(usize, Self)>, |best, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        });
        let plane = best?.1.refined(samples)?;
        plane.is_supported(samples).then_some(plane)
    }

    /// The ground of the nearest points, with these points, if it meets this plane at an angle, as at the foot of a ramp; else `None`. A level
    /// table before a floor is no such ground.
    fn ground_before(&self, near: Vec<Vector3>, expected_up: Vector3) -> Option<(Vec<Vector3>, Self)> {
        let ground = Self::propose(&near, expected_up)?;
        let is_ground = ground.support(&near).count() as f64 >= MIN_NEAR_SUPPORT_RATIO * near.len() as f64;
        (is_ground && ground.up.angle(&self.up) > MAX_ANGLE_TO_MEDIAN_RAD).then_some((near, ground))
    }

    fn is_supported(&self, samples: &[Vector3]) -> bool {
        samples.len() >= MIN_SAMPLES
            && self.support(samples).count() as f64 >= MIN_SUPPORT_RATIO * samples.len() as f64
    }

    fn agrees(&self, other: &Self) -> bool {
        self.up.angle(&other.up) <= MAX_ANGLE_TO_MEDIAN_RAD
            && (self.height - other.height).abs() <= MAX_HEIGHT_TO_MEDIAN_M
    }

    fn through(points: [Vector3; 3]) -> Option<Self> {
        let rows = Matrix3::from_rows(&points.map(|p| p.transpose()));
        Self::of_inverse_depth(rows.try_inverse()? * Vector3::repeat(1.0))
    }

    /// The plane `q * p = 1`; `None` if it is not below a camera on a robot.
    fn of_inverse_depth(q: Vector3) -> Option<Self> {
        let height = 1.0 / q.norm();
        (MIN_HEIGHT_M..=MAX_HEIGHT_M).contains(&height).then(|| Self { up: -q * height, height })
    }

    fn support<'a>(&self, samples: &'a [Vector3]) -> impl Iterator<Item = &'a Vector3> {
        let plane = *self;
        samples.iter().filter(move |p| (plane.up.dot(p) + plane.height).abs() <= SUPPORT_DISTANCE_M)
    }

    /// Least squares on the inverse depth of the samples near the plane.
    fn refined(self, samples: &[Vector3]) -> Option<Self> {
        let mut plane = self;
        for _ in 0..REFINEMENT_ROUNDS {
            let (mut information, mut vector) = (Matrix3::zeros(), Vector3::zeros());
            for point in plane.support(samples) {
                let ray = point / point.z;
                information += ray * ray.transpose();
                vector += ray / point.z;
            }
            plane = Self::of_inverse_depth(information.try_inverse()? * vector)?;
        }
        Some(plane)
    }
}

impl FloorMount {
    /// The mean over images; `None` without one. The standard deviations include the errors common to all images: the bias of the depth,
    /// and the angle between the floor's normal and the robot's turn `axis` (camera frame) if known.
    #[must_use]
    pub fn of(views: &[FloorView], axis: Option<&Vector3>) -> Option<Self> {
        let mean = |value: &dyn Fn(&FloorView) -> f64, shared: &dyn Fn(f64) -> f64| {
            let mean = Estimate::mean_of(&views.iter().map(value).collect::<Vec<f64>>())?;
            Some(Estimate::new(mean.value, mean.sigma.hypotenuse(shared(mean.value))))
        };
        let tilt = |of: &dyn Fn((f64, f64)) -> f64| {
            mean(&|view| of(tilt_of(view.up)), &|mean| match axis {
                Some(axis) => of(tilt_of(*axis)) - mean,
                None => TILT_BIAS_RAD,
            })
        };
        Some(Self {
            height: mean(&|view| view.height, &|_| HEIGHT_BIAS_M)?,
            pitch: tilt(&|tilt| tilt.0)?,
            roll: tilt(&|tilt| tilt.1)?,
            images: views.len(),
        })
    }
}

/// Points with depth on a grid of pixels, camera frame, m.
fn samples(depth: &DepthImage, camera: &PinholeCamera) -> Vec<Vector3> {
    camera.points(depth, SAMPLE_STEP_PX).filter(|point| point.z <= MAX_DEPTH_M).collect()
}

/// The nearest of these points.
fn near(samples: &[Vector3]) -> Vec<Vector3> {
    let mut depths: Vec<f64> = samples.iter().map(|point| point.z).collect();
    depths.sort_by(f64::total_cmp);
    let smallest = depths.get((depths.len() as f64 * NEAREST_SHARE) as usize).copied().unwrap_or_default();
    samples.iter().filter(|point| point.z <= NEAR_DEPTH_RATIO * smallest).copied().collect()
}
