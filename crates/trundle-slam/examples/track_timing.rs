//! Times the stages of tracking over a recorded folder in the TUM layout, one image after the other.
//!
//! `cargo run --release -p trundle-slam --example track_timing FOLDER [fx fy cx cy [width height]]` prints median and 99th
//! percentile of each stage in ms: the features, the rest of a step (of all frames, and of those that became keyframes), and
//! both together. Without numbers the camera is that of the TUM benchmark's freiburg1, 640 x 480. Run it on one core
//! (`taskset -c 0`). Loading images is not timed.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench program")]

use std::path::Path;
use std::time::Instant;
use trundle_core::{ColorImage, DepthImage, Distortion, PinholeCamera, RgbdImage, Stamp, gray_from_color};
use trundle_slam::{RgbdSlam, SlamConfig};
use trundle_vision::OrbExtractor;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = Path::new(arguments.first().expect("a folder with associations.txt"));
    let numbers: Vec<f64> = arguments[1..].iter().map(|n| n.parse().unwrap()).collect();
    let config = SlamConfig::default();
    let mut slam = RgbdSlam::new(camera(&numbers), config.clone()).unwrap();
    let mut extractor = OrbExtractor::new(config.orb).unwrap();
    let list = std::fs::read_to_string(folder.join("associations.txt")).unwrap();
    let (mut features, mut rest, mut kept, mut total) = (vec![], vec![], vec![], vec![]);
    for line in list.lines().filter(|line| !line.starts_with('#')) {
        let image = load(folder, line);
        let start = Instant::now();
        let found = extractor.extract(&gray_from_color(image.color()));
        features.push(milliseconds(start));
        let start = Instant::now();
        let report = slam.step_with_features(image.stamp(), found, image.depth(), None);
        rest.push(milliseconds(start));
        if report.new_keyframe {
            kept.push(rest[rest.len() - 1]);
        }
        total.push(features[features.len() - 1] + rest[rest.len() - 1]);
    }
    println!("{} frames, {} keyframes made, {} in the map", rest.len(), kept.len(), slam.keyframes().count());
    for (name, times) in [
        ("features", &mut features),
        ("the rest of a step", &mut rest),
        ("the same, keyframes", &mut kept),
        ("together", &mut total),
    ] {
        println!("{name:>20}: median {:6.2} ms, 99 % {:6.2} ms", part(times, 0.5), part(times, 0.99));
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

fn part(times: &mut [f64], part: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    let last = times.len().saturating_sub(1);
    times.get((part * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

fn camera(numbers: &[f64]) -> PinholeCamera {
    let size = numbers.get(4).zip(numbers.get(5)).map_or((640, 480), |(w, h)| (*w as usize, *h as usize));
    if let [fx, fy, cx, cy, ..] = *numbers {
        return PinholeCamera::new(size, (fx, fy), (cx, cy), Distortion::default()).unwrap();
    }
    let lens = Distortion { k1: 0.2624, k2: -0.9531, p1: -0.0054, p2: 0.0026, k3: 1.1633 };
    PinholeCamera::new(size, (517.3, 516.5), (318.6, 255.3), lens).unwrap()
}

fn load(folder: &Path, line: &str) -> RgbdImage {
    let fields: Vec<&str> = line.split_whitespace().collect();
    let color = image::open(folder.join(fields[1])).unwrap().to_rgb8();
    let depth = image::open(folder.join(fields[3])).unwrap().to_luma16();
    let (width, height) = (color.width() as usize, color.height() as usize);
    let color = ColorImage::new(width, height, color.pixels().map(|p| p.0).collect()).unwrap();
    let depth = depth.into_raw().into_iter().map(|v| f32::from(v) / 5000.0).collect();
    let stamp = Stamp::from_secs(fields[0].parse().unwrap()).unwrap();
    RgbdImage::new(stamp, color, DepthImage::new(width, height, depth).unwrap()).unwrap()
}
