//! Times the parts of an RGB-D frame in the built-in scenes and prints medians. Writes no file.
//!
//! `cargo run --release -p trundle-sim --example render_timing [FRAMES]`: each scene seen from its start and its goal, turning.
#![expect(clippy::print_stdout, reason = "this is what an example is for")]

use std::time::Instant;
use trundle_core::{PinholeCamera, Pose2, Pose3, Stamp};
use trundle_sim::{ColorNoise, DepthNoise, Renderer, RgbdSensor, Scene, SimConfig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let frames: usize = std::env::args().nth(1).map_or(Ok(120), |number| number.parse())?;
    for name in Scene::NAMES {
        let started = Instant::now();
        let scene = Scene::by_name(name, 1)?;
        scene.world.prepare_textures();
        let painting = started.elapsed().as_secs_f64() * 1e3;
        let renderer = Renderer::new(PinholeCamera::kinect_v2())?;
        let sensor = RgbdSensor::new(DepthNoise::default(), ColorNoise::default(), 1)?;
        let mount = SimConfig::default().base_from_camera;
        let mut view = renderer.blank();
        let (mut draw, mut expose) = (Vec::new(), Vec::new());
        for i in 0..frames {
            let along = if i % 2 == 0 { scene.start } else { scene.goal };
            let pose = Pose2::new(along.x, along.y, i as f64 * 0.11);
            let started = Instant::now();
            renderer.render(&scene.snapshot(), &(Pose3::from_pose2(pose) * mount), &mut view);
            draw.push(started.elapsed().as_secs_f64() * 1e3);
            let started = Instant::now();
            sensor.expose(&view, Stamp::default(), i as u64)?;
            expose.push(started.elapsed().as_secs_f64() * 1e3);
        }
        println!(
            "{name}: {} solids, painting {painting:.0} ms; 512 x 424 frame: drawing {:.1} ms, noise {:.1} ms (medians of {frames})",
            scene.world.solids().len(),
            median(&mut draw),
            median(&mut expose),
        );
    }
    Ok(())
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
