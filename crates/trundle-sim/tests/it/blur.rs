//! Motion blur.

use super::{almost_blind, hall};
use trundle_core::{ColorImage, DepthImage, PinholeCamera, Pose2, RgbdImage, RobotBody, SensorEvent, Twist2};
use trundle_sim::{Exposure, Scene, Simulator};

/// The last of `n` images while turning at `omega` rad/s before a wall of bricks.
fn image(shutter_s: f64, omega: f64, n: usize) -> RgbdImage {
    let start = Pose2::new(-2.0, 0.0, 0.0);
    let demo = Scene::by_name("demo", 1).unwrap();
    let scene = Scene { start: demo.start, world: demo.world, ..hall(start) };
    let mut config = almost_blind().without_noise();
    config.camera = PinholeCamera::from_field_of_view((96, 64), (1.2, 0.8)).unwrap();
    config.camera_rate_hz = 10.0;
    config.shutter_s = shutter_s;
    let mut robot = Simulator::new(scene, config, 1).unwrap();
    robot.command(Twist2::new(0.0, omega)).unwrap();
    let mut images = Vec::new();
    while images.len() < n {
        if let Some(SensorEvent::Rgbd(image)) = robot.next_event().unwrap() {
            images.push(image);
        }
    }
    images.pop().unwrap()
}

/// Mean difference of neighbours along rows, levels.
fn sharpness(color: &ColorImage) -> f64 {
    let pairs = color.data().windows(2);
    let n = pairs.len() as f64;
    pairs.map(|pair| (f64::from(pair[0][1]) - f64::from(pair[1][1])).abs()).sum::<f64>() / n
}

fn depth(image: &RgbdImage) -> &DepthImage {
    image.depth()
}

#[test]
fn a_turn_blurs_the_colour_and_not_the_depth() {
    let (sharp, blurred) = (image(0.0, 1.0, 8), image(0.05, 1.0, 8));
    // 0.05 rad are 3.5 pixels.
    assert!(
        sharpness(blurred.color()) < 0.7 * sharpness(sharp.color()),
        "{} {}",
        sharpness(blurred.color()),
        sharpness(sharp.color())
    );
    assert!(depth(&sharp) == depth(&blurred), "depth is that of the stamp");
}

#[test]
fn a_camera_at_rest_has_no_blur() {
    let (sharp, still) = (image(0.0, 0.0, 2), image(0.05, 0.0, 2));
    assert!(sharp == still);
}

#[test]
fn exposure_is_wired() {
    let mut config = almost_blind().without_noise();
    config.camera_rate_hz = 10.0;
    let mut mean = |gain: f64| {
        config.color_noise.exposure = Exposure::fixed(gain);
        let mut robot = Simulator::new(hall(Pose2::IDENTITY), config.clone(), 1).unwrap();
        loop {
            if let Some(SensorEvent::Rgbd(image)) = robot.next_event().unwrap() {
                let data = image.color().data();
                break data.iter().map(|c| f64::from(c[1])).sum::<f64>() / data.len() as f64;
            }
        }
    };
    assert!(mean(0.5) < 0.8 * mean(1.0));
}
