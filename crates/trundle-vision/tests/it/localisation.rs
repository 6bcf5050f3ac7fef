//! Localisation error of corners: errors of correct matches between two views with a known relation, by octave.

use crate::texture::{noisy, picture};
use crate::tum::Recording;
use crate::view::{about, view};
use trundle_core::{GrayImage, Vector2, Vector3};
use trundle_vision::{
    Features, Keypoint, OrbConfig, OrbExtractor, RansacConfig, estimate_rigid_motion, match_mutual,
};

const SIZE: (usize, usize) = (640, 480);
const OCTAVES: usize = 8;
const SCALE: f64 = 1.2;

fn extracted(image: &GrayImage) -> Features {
    let mut config = OrbConfig::default();
    config.features = 2000;
    OrbExtractor::new(config).unwrap().extract(image)
}

fn position(k: &Keypoint) -> Vector2 {
    Vector2::new(f64::from(k.x), f64::from(k.y))
}

/// The centre of the keypoint's pixel in its own level.
fn position_of_pixel(k: &Keypoint) -> Vector2 {
    let whole = |v: f32, side: usize| {
        let per_px = side as f64 / (side as f64 / SCALE.powi(i32::from(k.octave))).round();
        (((f64::from(v) + 0.5) / per_px - 0.5).round() + 0.5) * per_px - 0.5
    };
    Vector2::new(whole(k.x, SIZE.0), whole(k.y, SIZE.1))
}

/// A drawn picture with edges between the samples of a pixel's average.
fn drawn(wall_from_image: impl Fn(Vector2) -> Vector2) -> GrayImage {
    picture(SIZE, |p| wall_from_image(p) + Vector2::new(0.217, 0.131))
}

/// The errors (px of the octave in b) of the matches between octave k of a and octave k - `down` of b, for each k.
fn errors(
    a: &Features,
    b: &Features,
    down: usize,
    b_from_a: impl Fn(Vector2) -> Vector2,
) -> Vec<Vec<Vector2>> {
    let mut errors = vec![Vec::new(); OCTAVES];
    for m in match_mutual(&a.descriptors, &b.descriptors, 64, 0.8) {
        let (ka, kb) = (&a.keypoints[m.a], &b.keypoints[m.b]);
        let error = (b_from_a(position(ka)) - position(kb)) / SCALE.powi(i32::from(kb.octave));
        if usize::from(ka.octave) == usize::from(kb.octave) + down && error.norm() < 3.0 {
            errors[usize::from(ka.octave)].push(error);
        }
    }
    errors
}

fn mean(errors: &[Vector2]) -> Vector2 {
    errors.iter().sum::<Vector2>() / errors.len() as f64
}

/// Standard deviation of one keypoint along one axis by the median of the errors. Half of the normal errors in the plane are shorter than
/// 1.1774 sigma, and two keypoints add their variances.
fn sigma(errors: &[Vector2]) -> f64 {
    let mut norms: Vec<f64> = errors.iter().map(|e| e.norm()).collect();
    norms.sort_by(f64::total_cmp);
    norms[norms.len() / 2] / 1.1774 / 2.0_f64.sqrt()
}

#[test]
fn two_views_agree_on_where_a_corner_is() {
    let (from, to) = (|p| about(SIZE, 9.0, 1.0)(p), |p| about(SIZE, -8.0, 1.0)(p));
    let mut pairs = vec![("drawn", drawn(from), drawn(to))];
    if let Some(recording) = Recording::open() {
        let image = recording.frame(100).0;
        pairs.push(("real", view(&image, from), view(&image, to)));
    }
    for (name, a, b) in pairs {
        let (a, b) = (extracted(&noisy(&a, 2.0, 1)), extracted(&noisy(&b, 2.0, 2)));
        let errors = errors(&a, &b, 0, about(SIZE, 17.0, 1.0)).concat();
        let (bias, sigma) = (mean(&errors), sigma(&errors));
        println!("{name}: {} matches, bias {:.3} {:.3}, sigma {sigma:.3}", errors.len(), bias.x, bias.y);
        // Whole pixels cannot do better than 0.29 = 1 / sqrt(12), and did 0.31.
        assert!(errors.len() >= 300 && sigma < 0.2, "{name}: {} matches, sigma {sigma:.3}", errors.len());
        assert!(bias.norm() < 0.06, "{name}: {bias}");
    }
}

#[test]
fn no_octave_is_biased() {
    let upright = drawn(|p| p);
    let (width, height) = SIZE;
    let flipped = GrayImage::from_fn(width, height, |x, y| upright[(width - 1 - x, height - 1 - y)]);
    let errors = errors(&extracted(&upright), &extracted(&flipped), 0, about(SIZE, 180.0, 1.0));
    for (octave, errors) in errors.iter().enumerate() {
        // Turned half round, a bias shows twice.
        let bias = mean(errors) / 2.0;
        println!("octave {octave}: {} matches, bias {:.4} {:.4}", errors.len(), bias.x, bias.y);
        assert!(errors.len() > 50 && bias.norm() < 0.02, "octave {octave}: {bias}");
    }
}

#[test]
fn a_coarse_octave_agrees_with_octave_zero_of_a_smaller_image() {
    let near = extracted(&noisy(&drawn(|p| p), 2.0, 1));
    for octave in [1, 3, 5] {
        let shrink = SCALE.powi(octave as i32);
        let far = extracted(&noisy(&drawn(about(SIZE, 0.0, shrink)), 2.0, 2));
        let errors = &errors(&near, &far, octave, about(SIZE, 0.0, 1.0 / shrink))[octave];
        let bias = mean(errors);
        println!(
            "octave {octave}: {} matches, bias {:.3} {:.3}, sigma {:.3}",
            errors.len(),
            bias.x,
            bias.y,
            sigma(errors)
        );
        assert!(
            errors.len() >= 20 && bias.norm() < 0.12,
            "octave {octave}: {} matches, {bias}",
            errors.len()
        );
    }
}

/// The right pairs of two frames of a recording, and the errors of their pixels after the motion that fits them best.
fn residuals(
    recording: &Recording,
    (a, b): (usize, usize),
    position: impl Fn(&Keypoint) -> Vector2,
) -> Vec<(u8, Vector2)> {
    let camera = Recording::camera();
    let [(fa, pa), (fb, pb)] = [a, b].map(|i| {
        let (image, depth) = recording.frame(i);
        let features = extracted(&image);
        let place = |k: &Keypoint| {
            let depth = f64::from(*depth.get(k.x.round() as usize, k.y.round() as usize)?);
            let pixel = camera.undistort(position(k));
            (depth > 0.0).then(|| (camera.unproject(pixel, depth), pixel))
        };
        let places: Vec<Option<(Vector3, Vector2)>> = features.keypoints.iter().map(place).collect();
        (features, places)
    });
    let pairs: Vec<_> = match_mutual(&fa.descriptors, &fb.descriptors, 64, 0.8)
        .into_iter()
        .filter(|m| fa.keypoints[m.a].octave == fb.keypoints[m.b].octave)
        .filter_map(|m| Some((fb.keypoints[m.b].octave, pa[m.a]?.0, pb[m.b]?)))
        .collect();
    let (from, to): (Vec<Vector3>, Vec<Vector3>) = pairs.iter().map(|(_, a, b)| (*a, b.0)).unzip();
    let config = RansacConfig::default();
    let Some(result) = estimate_rigid_motion(&from, &to, &camera, &config, 1) else { return vec![] };
    let error = |i: usize| {
        let (octave, a, b) = pairs[i];
        (octave, camera.project(result.b_from_a.transform(a)).unwrap() - b.1)
    };
    result.inliers.into_iter().map(error).collect()
}

#[test]
fn the_pixels_of_real_frames_fit_a_motion_better_than_whole_ones() {
    let Some(recording) = Recording::open() else { return };
    let pairs = (0..recording.len() - 2).step_by(50).map(|i| (i, i + 2));
    let all: Vec<_> = pairs.clone().flat_map(|pair| residuals(&recording, pair, position)).collect();
    for octave in 0..OCTAVES as u8 {
        let own: Vec<Vector2> = all.iter().filter(|(o, _)| *o == octave).map(|(_, e)| *e).collect();
        let sigma = sigma(&own);
        println!("octave {octave}: {} inliers, sigma {sigma:.3} px of the image", own.len());
        assert!(own.len() >= 100 && sigma < 0.9, "octave {octave}: {} inliers, {sigma:.3} px", own.len());
    }
    let whole: Vec<_> = pairs.flat_map(|pair| residuals(&recording, pair, position_of_pixel)).collect();
    let in_octave = |all: &[(u8, Vector2)]| {
        sigma(&all.iter().map(|(o, e)| e / SCALE.powi(i32::from(*o))).collect::<Vec<_>>())
    };
    let (fine, whole) = (in_octave(&all), in_octave(&whole));
    println!("sigma {fine:.3} px of the octave, {whole:.3} with whole pixels");
    assert!(fine < 0.85 * whole, "{fine:.3} {whole:.3}");
}
