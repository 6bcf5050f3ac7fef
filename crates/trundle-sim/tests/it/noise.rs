//! Noise of images against its models.

use trundle_core::{RgbdImage, Stamp};
use trundle_sim::{ColorNoise, DepthNoise, Exposure, RgbdSensor, View};

const WIDTH: usize = 200;
const HEIGHT: usize = 120;

/// A view of `depth` (m) by column, of one grey, seen head on.
fn view(depth: impl Fn(usize) -> f32, grey: u8, cosine: f32) -> View {
    let n = WIDTH * HEIGHT;
    let depth = (0..n).map(|i| depth(i % WIDTH)).collect();
    View { width: WIDTH, height: HEIGHT, depth, color: vec![[grey; 3]; n], cosine: vec![cosine; n] }
}

fn expose(depth: DepthNoise, view: &View, frame: u64) -> RgbdImage {
    let sensor = RgbdSensor::new(depth, ColorNoise::default(), 11).unwrap();
    sensor.expose(view, Stamp::default(), frame).unwrap()
}

/// Mean and standard deviation.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt())
}

#[test]
fn whole_images_spread_as_the_models_say() {
    for noise in [DepthNoise::kinect_v2(), DepthNoise::kinect_v1()] {
        for (z, theta) in [(1.0, 0.0), (2.5, 0.3), (4.5, 0.6), (3.0, 1.2)] {
            let image = expose(noise.clone(), &view(|_| z as f32, 160, f64::cos(theta) as f32), 3);
            let depths: Vec<f64> =
                image.depth().data().iter().map(|&d| f64::from(d)).filter(|d| *d > 0.0).collect();
            assert!(depths.len() as f64 > 0.999 * (WIDTH * HEIGHT) as f64);
            let (mean, sigma) = moments(&depths);
            let stated = noise.sigma(z, theta);
            assert!((sigma / stated - 1.0).abs() < 0.05, "{sigma} of {stated} at {z} m, {theta} rad");
            assert!((mean - z).abs() < 0.1 * stated + 5e-4, "{mean} at {z} m");
        }
    }
}

#[test]
fn noise_is_white_over_pixels_and_frames() {
    let wall = view(|_| 3.0, 160, 1.0);
    let noise = DepthNoise::kinect_v2();
    let [a, b] = [0, 1].map(|frame| expose(noise.clone(), &wall, frame));
    let errors = |image: &RgbdImage| -> Vec<f64> {
        image.depth().data().iter().map(|&d| f64::from(d) - 3.0).collect()
    };
    let (a, b) = (errors(&a), errors(&b));
    let correlation = |x: &[f64], y: &[f64]| {
        let products: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum();
        products / (x.len() as f64 * noise.sigma(3.0, 0.0).powi(2))
    };
    // 24,000 pixels: the correlation of white noise is below 0.02 with three sigma.
    for (what, value) in [
        ("next pixel", correlation(&a[1..], &a[..a.len() - 1])),
        ("next row", correlation(&a[WIDTH..], &a[..a.len() - WIDTH])),
        ("next frame", correlation(&a, &b)),
    ] {
        assert!(value.abs() < 0.025, "{what}: {value}");
    }
    assert_eq!(expose(noise.clone(), &wall, 1), expose(noise, &wall, 1));
}

#[test]
fn a_step_flies_and_the_first_kinects_casts_a_shadow() {
    let step = view(|x| if (80..120).contains(&x) { 1.0 } else { 3.0 }, 160, 1.0);
    let column =
        |image: &RgbdImage, x: usize| -> Vec<f32> { (0..HEIGHT).map(|y| image.depth()[(x, y)]).collect() };
    let v2 = expose(DepthNoise::kinect_v2(), &step, 0);
    let between = column(&v2, 79).into_iter().filter(|d| (1.05..2.95).contains(d)).count();
    assert!((0.15..0.45).contains(&(between as f64 / HEIGHT as f64)), "{between} of {HEIGHT} fly");
    assert!(column(&v2, 70).iter().all(|&d| d > 2.9));
    // 525 px 0.075 m (1/1 - 1/3) = 26 px to the left of the post.
    let v1 = expose(DepthNoise::kinect_v1(), &step, 0);
    assert!(column(&v1, 60).iter().all(|&d| d == 0.0));
    assert!(column(&v1, 50).iter().chain(&column(&v1, 130)).all(|&d| d > 2.8));
}

#[test]
fn multi_path_is_off_unless_asked_for() {
    let corner = view(|x| 1.0 / (0.3 + 0.0015 * (x as f32 - 100.0).abs()), 160, 0.7);
    let deepest = |noise: DepthNoise| {
        let image = expose(DepthNoise { axial_factor: 0.0, ..noise }, &corner, 0);
        image.depth()[(100, 60)]
    };
    assert!((deepest(DepthNoise::kinect_v2()) - 1.0 / 0.3).abs() < 1e-3);
    let lengthened = deepest(DepthNoise { multi_path: 0.3, ..DepthNoise::kinect_v2() }) - 1.0 / 0.3;
    assert!((0.03..0.3).contains(&lengthened), "{lengthened}");
}

#[test]
fn auto_exposure_brightens_dark_scenes_and_makes_them_noisier() {
    let mut sensor = RgbdSensor::new(DepthNoise::none(), ColorNoise::default(), 1).unwrap();
    let grey = |sensor: &RgbdSensor, view: &View| {
        let image = sensor.expose(view, Stamp::default(), 0).unwrap();
        moments(&image.color().data().iter().map(|c| f64::from(c[1])).collect::<Vec<_>>())
    };
    let dark = view(|_| 2.0, 50, 1.0);
    let (before, noise_before) = grey(&sensor, &dark);
    sensor.adapt(&dark, Stamp::default());
    let (after, noise_after) = grey(&sensor, &dark);
    assert!((before - 50.0).abs() < 0.5, "{before}");
    // 18 % of light is level 118.
    assert!((after - 118.0).abs() < 1.5 && (sensor.gain() - 0.18 / 0.0319).abs() < 0.1, "{after}");
    assert!(noise_after > 1.5 * noise_before, "{noise_before} {noise_after}");
    let mut fixed = RgbdSensor::new(
        DepthNoise::none(),
        ColorNoise { exposure: Exposure::fixed(1.0), ..ColorNoise::default() },
        1,
    )
    .unwrap();
    fixed.adapt(&dark, Stamp::default());
    assert_eq!(fixed.gain(), 1.0);
}
