//! The motion between two RGB-D frames, from pairs of points.

use super::consensus::Consensus;
use super::ransac_config::RansacConfig;
use super::residual::Observation;
use super::rigid::rigid_motion;
use trundle_core::{Hypotenuse, PinholeCamera, Pose3, Vector3};

/// Chi-square with three degrees of freedom at 95 %. Source: the chi-square distribution.
const CHI2_95_3: f64 = 7.815;

/// Result of [`estimate_rigid_motion`] and [`estimate_pose_pnp`](crate::estimate_pose_pnp).
#[derive(Debug, Clone, PartialEq)]
pub struct RansacResult {
    /// The motion: maps points of frame a into camera frame b.
    pub b_from_a: Pose3,
    /// Indices of the pairs that agree with the motion, increasing.
    pub inliers: Vec<usize>,
}

/// The motion between two RGB-D frames from paired points (camera frames a and b, m), some of the pairs being wrong.
///
/// RANSAC \[Fischler81\]: three pairs give a motion by least squares \[Umeyama91\]. A pair agrees if its point of a reprojects to its point
/// of b, in `camera` px and in depth, within 95 % of the noise; the noise of a depth grows with its square. The motion has the minimum
/// truncated cost \[Torr00\], and the search ends when a better one is unlikely. The motion is then refined on its inliers by Gauss-Newton
/// on the reprojection and depth errors, robustly weighted (Huber).
///
/// Pairs with a point that is not finite or not in front of its camera count as outliers. The same input and `seed` give the same result.
/// `None` if fewer than [`RansacConfig::min_inliers`] pairs agree. Panics when the slices differ in length.
pub fn estimate_rigid_motion(
    points_a: &[Vector3],
    points_b: &[Vector3],
    camera: &PinholeCamera,
    config: &RansacConfig,
    seed: u64,
) -> Option<RansacResult> {
    assert_eq!(points_a.len(), points_b.len(), "invariant: the points are paired");
    let pairs: Vec<Pair> = points_a
        .iter()
        .zip(points_b)
        .enumerate()
        .filter_map(|(index, (&a, &b))| Pair::new(index, a, b, camera, config))
        .collect();
    let observations: Vec<Observation> = pairs.iter().map(|pair| pair.observation).collect();
    let consensus = Consensus { observations: &observations, camera, config };
    let propose = |sample: [usize; 3]| {
        let sample = sample.map(|i| &pairs[i]);
        keeps_distances(&sample).then(|| rigid_motion(&sample.map(|pair| (pair.a, pair.b)))).flatten()
    };
    let (b_from_a, inliers) = consensus.find(seed, propose)?;
    Some(RansacResult { b_from_a, inliers: inliers.into_iter().map(|i| pairs[i].index).collect() })
}

/// A pair of points in the form of the search.
#[derive(Debug, Clone, Copy)]
struct Pair {
    index: usize,
    a: Vector3,
    b: Vector3,
    /// Possible error of the distance to another point, caused by this one, m.
    slack: f64,
    observation: Observation,
}

impl Pair {
    /// `None` if a point is not finite or not in front of its camera.
    fn new(
        index: usize,
        a: Vector3,
        b: Vector3,
        camera: &PinholeCamera,
        config: &RansacConfig,
    ) -> Option<Self> {
        let finite = a.iter().chain(b.iter()).all(|v| v.is_finite());
        (finite && a.z > 0.0 && b.z > 0.0).then_some(())?;
        let depth_sigma = config.sigma_of_depth(a.z).hypotenuse(config.sigma_of_depth(b.z));
        let observation = Observation {
            point: a,
            pixel: camera.project(b)?,
            per_px: 1.0 / config.pixel_sigma,
            depth: b.z,
            per_m: 1.0 / depth_sigma,
            bound: CHI2_95_3,
        };
        let slack = 3.0 * (depth_sigma + config.pixel_sigma * a.z.max(b.z) / camera.fx());
        Some(Self { index, a, b, slack, observation })
    }
}

/// Whether the three distances agree on both sides within the noise, as in any rigid motion: this cheap check rejects most wrong samples.
fn keeps_distances(sample: &[&Pair; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
        let (p, q) = (sample[i], sample[j]);
        ((p.a - q.a).norm() - (p.b - q.b).norm()).abs() <= p.slack + q.slack
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use trundle_core::Vector2;

    /// Points seen from a and b with noise of the pixel and the depth; every second pair is wrong.
    fn half_wrong(truth: Pose3, count: usize, seed: u64) -> (Vec<Vector3>, Vec<Vector3>) {
        let camera = PinholeCamera::kinect_v2();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut around = |middle: f64, reach: f64| middle + reach * (2.0 * rng.random::<f64>() - 1.0);
        let mut pairs = Vec::new();
        for i in 0..count {
            let pixel = Vector2::new(around(255.0, 250.0), around(211.0, 200.0));
            let a = camera.unproject(pixel, around(2.5, 1.5));
            let b = truth.transform(a);
            let seen = camera.project(b).unwrap() + Vector2::new(around(0.0, 0.8), around(0.0, 0.8));
            let depth = b.z + 0.002 * b.z * b.z * around(0.0, 1.0);
            let other = Vector2::new(around(255.0, 250.0), around(211.0, 200.0));
            let wrong = camera.unproject(other, around(2.5, 1.5));
            pairs.push((a, if i % 2 == 0 { camera.unproject(seen, depth) } else { wrong }));
        }
        pairs.into_iter().unzip()
    }

    fn estimated(points: &(Vec<Vector3>, Vec<Vector3>), seed: u64) -> Option<RansacResult> {
        let camera = PinholeCamera::kinect_v2();
        estimate_rigid_motion(&points.0, &points.1, &camera, &RansacConfig::default(), seed)
    }

    proptest! {
        #[test]
        fn half_of_the_pairs_may_be_wrong(
            tangent in prop::array::uniform6(-0.25..0.25), scene in 0..1000u64, seed: u64,
        ) {
            let truth = Pose3::exp(Vector6::from(tangent));
            let result = estimated(&half_wrong(truth, 200, scene), seed).unwrap();
            let error = result.b_from_a.inverse() * truth;
            prop_assert!(error.translation.norm() < 0.01, "{} m", error.translation.norm());
            prop_assert!(error.angle().to_degrees() < 0.2, "{} deg", error.angle().to_degrees());
            let right = result.inliers.iter().filter(|i| *i % 2 == 0).count();
            prop_assert!(right >= 95 && result.inliers.len() - right <= 4, "{right} of {}", result.inliers.len());
            prop_assert!(result.inliers.is_sorted());
        }
    }

    #[test]
    fn the_seed_decides_everything() {
        let points = half_wrong(Pose3::exp(Vector6::repeat(0.05)), 120, 3);
        assert_eq!(estimated(&points, 7), estimated(&points, 7));
    }

    #[test]
    fn random_pairs_give_no_motion() {
        let (a, _) = half_wrong(Pose3::identity(), 100, 1);
        let (b, _) = half_wrong(Pose3::identity(), 100, 2);
        assert_eq!(estimated(&(a, b), 0), None);
        assert_eq!(estimated(&(vec![], vec![]), 0), None);
    }

    #[test]
    fn broken_points_never_agree() {
        let (mut a, b) = half_wrong(Pose3::identity(), 100, 1);
        a[0].x = f64::NAN;
        a[2].z = -1.0;
        a[4].z = f64::INFINITY;
        let inliers = estimated(&(a, b), 0).unwrap().inliers;
        assert!(inliers.len() >= 45 && inliers[0] > 4);
    }
}
