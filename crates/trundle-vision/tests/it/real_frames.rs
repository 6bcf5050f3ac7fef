//! Motion between real images.

use crate::tum::Recording;
use trundle_core::{DepthImage, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_vision::{
    Features, OrbConfig, OrbExtractor, RansacConfig, estimate_rigid_motion, match_mutual, rotation_consistent,
};

/// Position of each feature, camera frame, m; `None` without depth.
fn points(features: &Features, depth: &DepthImage, camera: &PinholeCamera) -> Vec<Option<Vector3>> {
    let point = |k: &trundle_vision::Keypoint| {
        let depth = *depth.get(k.x.round() as usize, k.y.round() as usize)?;
        let pixel = camera.undistort(Vector2::new(f64::from(k.x), f64::from(k.y)));
        (depth > 0.0).then(|| camera.unproject(pixel, f64::from(depth)))
    };
    features.keypoints.iter().map(point).collect()
}

struct Outcome {
    matches: usize,
    inliers: usize,
    metres: f64,
    degrees: f64,
}

/// Extracts, matches and estimates the motion; returns its error.
fn outcome(recording: &Recording, a: usize, b: usize) -> Option<Outcome> {
    let camera = Recording::camera();
    let mut orb = OrbExtractor::new(OrbConfig::default()).unwrap();
    let [(features_a, points_a), (features_b, points_b)] = [a, b].map(|i| {
        let (image, depth) = recording.frame(i);
        let features = orb.extract(&image);
        let points = points(&features, &depth, &camera);
        (features, points)
    });
    let matches = match_mutual(&features_a.descriptors, &features_b.descriptors, 64, 0.8);
    let matches = rotation_consistent(&matches, &features_a.keypoints, &features_b.keypoints);
    let (from, to): (Vec<Vector3>, Vec<Vector3>) =
        matches.iter().filter_map(|m| Some((points_a[m.a]?, points_b[m.b]?))).unzip();
    let result = estimate_rigid_motion(&from, &to, &camera, &RansacConfig::default(), 1)?;
    let error: Pose3 = result.b_from_a.inverse() * recording.motion(a, b);
    Some(Outcome {
        matches: matches.len(),
        inliers: result.inliers.len(),
        metres: error.translation.norm(),
        degrees: error.angle().to_degrees(),
    })
}

/// Number of frame pairs with a distance of `step` whose error is within the bounds.
fn good(recording: &Recording, step: usize, (metres, degrees): (f64, f64)) -> (usize, usize) {
    let starts: Vec<usize> = (0..recording.len() - step).step_by(20).collect();
    let within = |a: &&usize| {
        let Some(o) = outcome(recording, **a, **a + step) else {
            println!("{a} to {}: no motion", **a + step);
            return false;
        };
        println!(
            "{a} to {}: {} matches, {} inliers, {:.1} mm, {:.2} deg off",
            **a + step,
            o.matches,
            o.inliers,
            1e3 * o.metres,
            o.degrees
        );
        o.metres < metres && o.degrees < degrees
    };
    (starts.iter().filter(within).count(), starts.len())
}

#[test]
fn the_motion_between_neighbouring_frames_is_the_true_one() {
    let Some(recording) = Recording::open() else { return };
    let (good, all) = good(&recording, 1, (0.02, 0.7));
    assert!(good * 10 >= all * 9, "{good} of {all}");
}

#[test]
fn the_motion_over_a_sixth_of_a_second_is_the_true_one() {
    let Some(recording) = Recording::open() else { return };
    let (good, all) = good(&recording, 5, (0.03, 1.0));
    assert!(good * 10 >= all * 8, "{good} of {all}");
}
