//! Height, pitch and roll of a camera from the floor in its depth images.
//!
//! Problem: the floor's plane in the camera frame from one depth image, with walls and objects in it. Idea: a plane `q * p = 1` gives
//! an inverse depth `1/z = q * ray`, linear in q. Consensus of three pixels finds the floor \[Fischler81\]; reweighted least squares on
//! the inverse depth refines it. Cost: 200 planes over some 2,000 pixels an image.

use super::estimate::Estimate;
use super::planar_track::tilt_of;
use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{DepthImage, PinholeCamera, Vector2, Vector3};

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
    /// Roll about the optical axis, rad.
    pub roll: Estimate,
    /// Images that show the floor.
    pub images: usize,
}

/// Pixels from one sample to the next, across and down. Source: ours; about 2,000 samples of a Kinect V2.
const SAMPLE_STEP_PX: usize = 10;
/// Largest depth of a sample: 4 m. Source: ours; the noise of depth grows with its square.
const MAX_DEPTH_M: f64 = 4.0;
/// Planes tried. Source: \[Fischler81\]: three of 20 % floor pixels are found with 80 % probability; a miss costs one image.
const TRIALS: usize = 200;
/// Distance from the plane within which a point supports it: 0.03 m. Source: ours.
const SUPPORT_DISTANCE_M: f64 = 0.03;
/// Fraction of the samples that must be floor: 0.1. Source: ours.
const MIN_SUPPORT_RATIO: f64 = 0.1;
/// Smallest number of samples with depth. Source: ours.
const MIN_SAMPLES: usize = 100;
/// Largest angle of the floor to the floor by the mount in use: 20 deg. Beyond it the plane is a wall or a ramp. Source: ours.
const MAX_TILT_ERROR_RAD: f64 = 0.35;
/// Lowest and highest camera: 0.05 m to 3 m. Source: the range of `mount.z_m`.
const HEIGHT_RANGE_M: (f64, f64) = (0.05, 3.0);
/// Rounds of the refinement. Source: ours.
const ROUNDS: usize = 5;

impl FloorView {
    /// The floor in a depth image (m), by a camera whose upward axis is about `expected_up`; `None` where no floor is seen.
    /// Deterministic.
    #[must_use]
    pub fn find(depth: &DepthImage, camera: &PinholeCamera, expected_up: Vector3) -> Option<Self> {
        let samples = samples(depth, camera);
        if samples.len() < MIN_SAMPLES {
            return None;
        }
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut draw = || samples[rng.random_range(0..samples.len())];
        let candidates = (0..TRIALS).filter_map(|_| Self::through([draw(), draw(), draw()]));
        let level = candidates.filter(|plane| plane.up.angle(&expected_up) <= MAX_TILT_ERROR_RAD);
        let rated = level.map(|plane| (plane.support(&samples).count(), plane));
        let best = rated.fold(None::<(usize, Self)>, |best, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        });
        let (count, plane) = best?;
        (count as f64 >= MIN_SUPPORT_RATIO * samples.len() as f64).then(|| plane.refined(&samples))?
    }

    fn through(points: [Vector3; 3]) -> Option<Self> {
        let rows = Matrix3::from_rows(&points.map(|p| p.transpose()));
        Self::of_inverse_depth(rows.try_inverse()? * Vector3::repeat(1.0))
    }

    /// The plane `q * p = 1`; `None` where it is not below a camera on a robot.
    fn of_inverse_depth(q: Vector3) -> Option<Self> {
        let height = 1.0 / q.norm();
        (HEIGHT_RANGE_M.0..=HEIGHT_RANGE_M.1).contains(&height).then(|| Self { up: -q * height, height })
    }

    fn support<'a>(&self, samples: &'a [Vector3]) -> impl Iterator<Item = &'a Vector3> {
        let plane = *self;
        samples.iter().filter(move |p| (plane.up.dot(p) + plane.height).abs() <= SUPPORT_DISTANCE_M)
    }

    /// Least squares on the inverse depth of the samples near the plane.
    fn refined(self, samples: &[Vector3]) -> Option<Self> {
        let mut plane = self;
        for _ in 0..ROUNDS {
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
    /// The mean over images; `None` without one.
    #[must_use]
    pub fn of(views: &[FloorView]) -> Option<Self> {
        let mean = |value: &dyn Fn(&FloorView) -> f64| {
            Estimate::mean_of(&views.iter().map(value).collect::<Vec<f64>>())
        };
        Some(Self {
            height: mean(&|view| view.height)?,
            pitch: mean(&|view| tilt_of(view.up).0)?,
            roll: mean(&|view| tilt_of(view.up).1)?,
            images: views.len(),
        })
    }
}

/// Points with depth on a grid of pixels, camera frame, m.
fn samples(depth: &DepthImage, camera: &PinholeCamera) -> Vec<Vector3> {
    let rows = (0..depth.height()).step_by(SAMPLE_STEP_PX);
    let pixels = rows.flat_map(|y| (0..depth.width()).step_by(SAMPLE_STEP_PX).map(move |x| (x, y)));
    let point = |(x, y): (usize, usize)| {
        let z = f64::from(*depth.get(x, y)?);
        let pixel = camera.undistort(Vector2::new(x as f64, y as f64));
        (z > 0.0 && z <= MAX_DEPTH_M).then(|| camera.unproject(pixel, z))
    };
    pixels.filter_map(point).collect()
}
