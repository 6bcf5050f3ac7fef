//! The pose of a camera from points and their pixels.

use super::consensus::Consensus;
use super::p3p::poses_of_three;
use super::ransac::RansacResult;
use super::ransac_config::RansacConfig;
use super::residual::Observation;
use trundle_core::{PinholeCamera, Vector2, Vector3};

/// Chi-square with two degrees of freedom at 95 %. Source: the chi-square distribution.
const CHI2_95_2: f64 = 5.991;

/// The pose of camera b from points in a frame a (m) and their rectified `pixels`, with wrong pairs among them. It is the counterpart of
/// [`estimate_rigid_motion`](crate::estimate_rigid_motion) for features without depth.
///
/// RANSAC \[Fischler81\]: three pairs allow up to four poses \[Persson18\]. A pair agrees with a pose if its point reprojects to its pixel
/// within 95 % of [`RansacConfig::pixel_sigma`]. The pose with the minimum truncated cost \[Torr00\] is refined on its inliers by
/// Gauss-Newton on the reprojection errors, robustly weighted (Huber). The numbers for depth in `config` are ignored.
///
/// Pairs that are not finite never agree. The same input and `seed` give the same result. `None` if fewer than
/// [`RansacConfig::min_inliers`] pairs agree, or the points do not determine a pose, as on one line. Panics when the slices
/// differ in length.
pub fn estimate_pose_pnp(
    points: &[Vector3],
    pixels: &[Vector2],
    camera: &PinholeCamera,
    config: &RansacConfig,
    seed: u64,
) -> Option<RansacResult> {
    assert_eq!(points.len(), pixels.len(), "invariant: every point has its pixel");
    let per_px = 1.0 / config.pixel_sigma;
    let pairs = points.iter().zip(pixels).enumerate();
    let finite = |point: &Vector3, pixel: &Vector2| point.iter().chain(pixel.iter()).all(|v| v.is_finite());
    let (indices, observations): (Vec<usize>, Vec<Observation>) = pairs
        .filter(|(_, (point, pixel))| finite(point, pixel))
        .map(|(index, (&point, &pixel))| {
            (index, Observation { point, pixel, per_px, depth: 0.0, per_m: 0.0, bound: CHI2_95_2 })
        })
        .unzip();
    let consensus = Consensus { observations: &observations, camera, config };
    let propose = |sample: [usize; 3]| {
        let sample = sample.map(|i| &observations[i]);
        let bearings = sample.map(|o| camera.unproject(o.pixel, 1.0).normalize());
        poses_of_three(sample.map(|o| o.point), bearings).into_iter().flatten()
    };
    let (b_from_a, inliers) = consensus.find(seed, propose)?;
    Some(RansacResult { b_from_a, inliers: inliers.into_iter().map(|i| indices[i]).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use trundle_core::Pose3;

    /// Points of frame a with their pixels in camera b, with an error of at most `noise` px in each direction; every `nth` pixel is wrong.
    fn scene(truth: Pose3, count: usize, noise: f64, nth: usize, seed: u64) -> (Vec<Vector3>, Vec<Vector2>) {
        let camera = PinholeCamera::kinect_v2();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut around = |middle: f64, reach: f64| middle + reach * (2.0 * rng.random::<f64>() - 1.0);
        let pair = |i: usize| {
            let seen = Vector2::new(around(255.0, 250.0), around(211.0, 200.0));
            let point = truth.inverse().transform(camera.unproject(seen, around(2.5, 1.5)));
            let noisy = seen + Vector2::new(around(0.0, noise), around(0.0, noise));
            let wrong = Vector2::new(around(255.0, 250.0), around(211.0, 200.0));
            (point, if i % nth == nth - 1 { wrong } else { noisy })
        };
        (0..count).map(pair).unzip()
    }

    fn estimated(scene: &(Vec<Vector3>, Vec<Vector2>), seed: u64) -> Option<RansacResult> {
        let camera = PinholeCamera::kinect_v2();
        estimate_pose_pnp(&scene.0, &scene.1, &camera, &RansacConfig::default(), seed)
    }

    proptest! {
        #[test]
        fn clean_pixels_give_the_pose_itself(
            tangent in prop::array::uniform6(-1.5..1.5), count in 12..60usize, seed: u64,
        ) {
            let truth = Pose3::exp(Vector6::from(tangent));
            let result = estimated(&scene(truth, count, 0.0, usize::MAX, seed), seed).unwrap();
            prop_assert!((result.b_from_a.inverse() * truth).log().norm() < 1e-6);
            prop_assert_eq!(result.inliers, (0..count).collect::<Vec<_>>());
        }

        #[test]
        fn half_of_the_pairs_may_be_wrong(tangent in prop::array::uniform6(-1.5..1.5), seed: u64) {
            let truth = Pose3::exp(Vector6::from(tangent));
            let result = estimated(&scene(truth, 200, 0.8, 2, seed), seed).unwrap();
            let error = result.b_from_a.inverse() * truth;
            prop_assert!(error.translation.norm() < 0.015, "{} m", error.translation.norm());
            prop_assert!(error.angle().to_degrees() < 0.3, "{} deg", error.angle().to_degrees());
            let right = result.inliers.iter().filter(|i| *i % 2 == 0).count();
            prop_assert!(right >= 95 && result.inliers.len() - right <= 4, "{right} of {}", result.inliers.len());
            prop_assert!(result.inliers.is_sorted());
        }
    }

    #[test]
    fn a_wall_is_enough() {
        let camera = PinholeCamera::kinect_v2();
        let truth = Pose3::exp(Vector6::new(0.2, -0.1, 0.3, 0.1, 0.4, -0.2));
        let points: Vec<Vector3> = (0..40)
            .map(|i| Vector3::new((i % 8) as f64 * 0.2 - 0.7, (i / 8) as f64 * 0.2 - 0.4, 2.0))
            .collect();
        let pixels = points.iter().map(|p| camera.project(truth.transform(*p)).unwrap()).collect();
        let result = estimated(&(points, pixels), 1).unwrap();
        assert!((result.b_from_a.inverse() * truth).log().norm() < 1e-6);
    }

    #[test]
    fn the_seed_decides_everything() {
        let scene = scene(Pose3::exp(Vector6::repeat(0.05)), 120, 0.8, 2, 3);
        assert_eq!(estimated(&scene, 7), estimated(&scene, 7));
    }

    #[test]
    fn points_that_do_not_determine_a_pose_give_none() {
        let camera = PinholeCamera::kinect_v2();
        let seen = |points: Vec<Vector3>| {
            let pixels = points.iter().map(|p| camera.project(*p).unwrap()).collect();
            estimated(&(points, pixels), 1)
        };
        let line = |i: usize| Vector3::new(i as f64 * 0.1 - 1.0, 0.2, 2.0 + i as f64 * 0.05);
        assert_eq!(seen((0..20).map(line).collect()), None);
        assert_eq!(seen(vec![line(3); 20]), None);
        assert_eq!(seen((0..20).map(|i| line(i % 2)).collect()), None);
        assert_eq!(seen((0..3).map(line).collect()), None);
        assert_eq!(seen(vec![]), None);
    }

    #[test]
    fn random_pairs_give_no_pose() {
        assert_eq!(estimated(&scene(Pose3::identity(), 100, 0.0, 1, 1), 0), None);
    }

    #[test]
    fn broken_numbers_never_agree() {
        let (mut points, mut pixels) = scene(Pose3::identity(), 60, 0.3, usize::MAX, 1);
        points[0].x = f64::NAN;
        pixels[1].y = f64::INFINITY;
        let inliers = estimated(&(points, pixels), 0).unwrap().inliers;
        assert!(inliers.len() >= 55 && inliers[0] == 2, "{inliers:?}");
        assert_eq!(estimated(&(vec![Vector3::repeat(f64::NAN); 20], vec![Vector2::zeros(); 20]), 0), None);
    }
}
