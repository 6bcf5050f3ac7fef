//! A made-up camera view: a corridor with a chequered floor and bricked walls.

use crate::room::Noise;
use trundle_core::{ColorImage, DepthImage, Vector3};
use trundle_viz::{CameraView, FeatureMark};

const SIZE: (usize, usize) = (512, 424);

/// The nearest of floor, ceiling, two side walls and an end wall: depth, texture coordinates, which.
fn cast(x: usize, y: usize) -> (f64, f64, f64, usize) {
    let ray = Vector3::new((x as f64 - 256.0) / 365.0, (y as f64 - 190.0) / 365.0, 1.0);
    let planes = [(1, 0.35), (1, -1.9), (0, -1.3), (0, 1.7), (2, 6.0)];
    let hit = |(which, &(axis, level)): (usize, &(usize, f64))| {
        let depth = level / ray[axis];
        let p = ray * depth;
        let (u, v) = [(p.y, p.z), (p.x, p.z), (p.x, p.y)][axis];
        (depth > 0.0).then_some((depth, u, v, which))
    };
    let hits = planes.iter().enumerate().filter_map(hit);
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).expect("the end wall is always there")
}

pub fn view() -> CameraView {
    let mut noise = Noise(11);
    let color = ColorImage::from_fn(SIZE.0, SIZE.1, |x, y| {
        let (depth, u, v, which) = cast(x, y);
        let scale = if which < 2 { 2.0 } else { 4.0 };
        let chequered = ((u * scale).floor() + (v * scale).floor()).rem_euclid(2.0);
        let base = [
            [150.0, 120.0, 90.0],
            [205.0, 205.0, 200.0],
            [120.0, 140.0, 165.0],
            [165.0, 130.0, 125.0],
            [140.0, 150.0, 120.0],
        ];
        let light = (0.72 + 0.28 * chequered) * (1.15 - 0.1 * depth) + 0.05 * noise.next();
        base[which].map(|channel: f64| (channel * light).clamp(0.0, 255.0) as u8)
    });
    let features = (0..520).map(|i| feature(&mut noise, i)).collect();
    CameraView { color, features }
}

fn feature(noise: &mut Noise, i: usize) -> FeatureMark {
    let scale = 1.2_f64.powi((8.0 * noise.next() * noise.next()) as i32);
    FeatureMark {
        x: 512.0 * noise.next(),
        y: 424.0 * noise.next(),
        size: 31.0 * scale,
        angle: std::f64::consts::TAU * noise.next(),
        tracked: !i.is_multiple_of(3),
    }
}

pub fn depth() -> DepthImage {
    let mut noise = Noise(5);
    DepthImage::from_fn(SIZE.0, SIZE.1, |x, y| {
        let (depth, ..) = cast(x, y);
        let hole = noise.next() < 0.01 || (300..340).contains(&x) && (200..260).contains(&y);
        if hole || depth < 0.5 { 0.0 } else { (depth * (1.0 + 0.004 * noise.next())) as f32 }
    })
}
