//! Features under roll, scale and noise.

use crate::texture::{noisy, picture};
use crate::view::about;
use trundle_core::{GrayImage, Vector2};
use trundle_vision::{Features, Keypoint, OrbConfig, OrbExtractor, match_mutual, rotation_consistent};

const SIZE: (usize, usize) = (480, 360);

fn extracted(image: &GrayImage) -> Features {
    OrbExtractor::new(OrbConfig::default()).unwrap().extract(image)
}

fn position(k: &Keypoint) -> Vector2 {
    Vector2::new(f64::from(k.x), f64::from(k.y))
}

/// Number of matches, and the fraction of correct ones: within 3 px (of the coarser octave) of the truth.
fn matched(a: &Features, b: &Features, b_from_a: impl Fn(Vector2) -> Vector2) -> (usize, f64) {
    let matches = match_mutual(&a.descriptors, &b.descriptors, 64, 0.8);
    let right = matches.iter().filter(|m| {
        let (ka, kb) = (&a.keypoints[m.a], &b.keypoints[m.b]);
        let scale = 1.2_f64.powi(i32::from(ka.octave.max(kb.octave)));
        (b_from_a(position(ka)) - position(kb)).norm() < 3.0 * scale
    });
    (matches.len(), right.count() as f64 / matches.len() as f64)
}

fn about_the_middle(degrees: f64, magnification: f64) -> impl Fn(Vector2) -> Vector2 {
    about(SIZE, degrees, magnification)
}

#[test]
fn a_rolled_camera_finds_the_same_features() {
    let straight = extracted(&picture(SIZE, |p| p));
    for (degrees, at_least) in [(30.0, 250), (90.0, 250), (-137.0, 250)] {
        let rolled = extracted(&picture(SIZE, about_the_middle(-degrees, 1.0)));
        let (count, right) = matched(&straight, &rolled, about_the_middle(degrees, 1.0));
        println!("{degrees} deg: {count} matches, {right:.3} right");
        assert!(count >= at_least && right > 0.95, "{degrees} deg: {count} matches, {right:.3} right");
    }
}

#[test]
fn the_turn_of_the_keypoints_is_that_of_the_camera() {
    let straight = extracted(&picture(SIZE, |p| p));
    let rolled = extracted(&picture(SIZE, about_the_middle(-30.0, 1.0)));
    let matches = match_mutual(&straight.descriptors, &rolled.descriptors, 64, 0.8);
    let kept = rotation_consistent(&matches, &straight.keypoints, &rolled.keypoints);
    assert!(kept.len() * 10 > matches.len() * 8, "{} of {}", kept.len(), matches.len());
    let mut turns: Vec<f32> = kept
        .iter()
        .map(|m| rolled.keypoints[m.b].angle - straight.keypoints[m.a].angle)
        .map(|turn| turn.to_degrees().rem_euclid(360.0))
        .collect();
    turns.sort_by(f32::total_cmp);
    assert!((turns[turns.len() / 2] - 30.0).abs() < 1.0, "{}", turns[turns.len() / 2]);
}

#[test]
fn a_nearer_camera_finds_the_same_features() {
    let far = extracted(&picture(SIZE, |p| p));
    for magnification in [1.1, 1.3, 1.6] {
        let near = extracted(&picture(SIZE, about_the_middle(0.0, 1.0 / magnification)));
        let (count, right) = matched(&far, &near, about_the_middle(0.0, magnification));
        println!("x {magnification}: {count} matches, {right:.3} right");
        assert!(count >= 100 && right > 0.9, "x {magnification}: {count} matches, {right:.3} right");
    }
}

#[test]
fn noise_moves_few_features() {
    let clean = picture(SIZE, |p| p);
    let (a, b) = (extracted(&noisy(&clean, 4.0, 1)), extracted(&noisy(&clean, 4.0, 2)));
    let again = a.keypoints.iter().filter(|ka| {
        let reach = 2.0 * 1.2_f64.powi(i32::from(ka.octave));
        b.keypoints
            .iter()
            .any(|kb| ka.octave.abs_diff(kb.octave) <= 1 && (position(ka) - position(kb)).norm() < reach)
    });
    let repeated = again.count() as f64 / a.keypoints.len() as f64;
    let (count, right) = matched(&a, &b, |p| p);
    println!("noise: {repeated:.3} repeated; {count} matches, {right:.3} right");
    assert!(repeated > 0.75, "{repeated:.3} repeated");
    assert!(count >= 400 && right > 0.97, "{count} matches, {right:.3} right");
}

#[test]
fn keypoints_of_every_octave_are_where_the_corner_is() {
    // One isolated bright square: the keypoints of its corners on all octaves must have no bias.
    let inside = |v: usize, low: usize| (low..low + 100).contains(&v);
    let image = GrayImage::from_fn(340, 300, |x, y| if inside(x, 120) && inside(y, 100) { 220 } else { 30 });
    let features = extracted(&image);
    let middle = features.keypoints.iter().map(position).sum::<Vector2>() / features.keypoints.len() as f64;
    assert!(features.keypoints.iter().any(|k| k.octave >= 5));
    assert!((middle - Vector2::new(169.5, 149.5)).norm() < 2.0, "{middle}");
}
