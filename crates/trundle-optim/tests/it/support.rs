//! Cameras, poses and points of the tests.

use nalgebra::Vector6;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{PinholeCamera, Pose3, Vector2, Vector3};
use trundle_optim::{InverseDepth, PointObservation};

pub fn camera() -> PinholeCamera {
    PinholeCamera::kinect_v1()
}

/// A pose within `size` (m, rad) of the identity.
pub fn any_pose(size: f64) -> impl Strategy<Value = Pose3> {
    prop::array::uniform6(-size..size).prop_map(|xi| Pose3::exp(Vector6::from(xi)))
}

/// The size of the perturbation between two poses, m and rad.
pub fn gap(a: Pose3, b: Pose3) -> f64 {
    (a.inverse() * b).log().norm()
}

/// A number of about a standard normal distribution.
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

/// Observations of points by a camera at `truth` with `noise` standard deviations of noise, all with a depth.
pub fn seen_from(truth: Pose3, count: usize, noise: f64, seed: u64) -> Vec<(Vector3, PointObservation)> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let see = |_| {
        let pixel = Vector2::new(rng.random_range(0.0..640.0), rng.random_range(0.0..480.0));
        let z = rng.random_range(0.6..5.0);
        let point = truth.transform(camera().unproject(pixel, z));
        let pixel = pixel + Vector2::new(normal(&mut rng), normal(&mut rng)) * noise;
        let depth = Some(InverseDepth { value: 1.0 / z + 0.003 * noise * normal(&mut rng), sigma: 0.003 });
        (point, PointObservation { pixel, pixel_sigma: 1.0, depth })
    };
    (0..count).map(see).collect()
}
