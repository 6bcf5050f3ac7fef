//! Writes the image of the robot's camera as PPM (colour) and PGM (depth, 8 m white), and the plan of the scene.
//!
//! `cargo run -p trundle-sim --example snapshot -- demo 1 0.9,1.1,20 /tmp/view` writes /tmp/view.ppm, /tmp/view.pgm and
//! /tmp/view_plan.pgm. The pose is x, y (m) and heading (deg) in the scene's world.

use std::fs;
use trundle_core::{Cell, Pose2, Pose3, Stamp};
use trundle_sim::{HeightBand, Renderer, RgbdSensor, Scene, SimConfig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, seed, pose, out] = arguments.as_slice() else {
        return Err("expected SCENE SEED X,Y,DEG OUT".into());
    };
    let scene = Scene::by_name(name, seed.parse()?)?;
    let numbers: Vec<f64> = pose.split(',').map(str::parse).collect::<Result<_, _>>()?;
    let [x, y, deg] = numbers[..] else { return Err("expected the pose as X,Y,DEG".into()) };
    let config = SimConfig::default();
    let renderer = Renderer::new(config.camera)?;
    let mut view = renderer.blank();
    let world_from_camera = Pose3::from_pose2(Pose2::new(x, y, deg.to_radians())) * config.base_from_camera;
    renderer.render(&scene.snapshot(), &world_from_camera, &mut view);
    let image =
        RgbdSensor::new(config.depth_noise, config.color_noise, 1)?.expose(&view, Stamp::default(), 0)?;
    let color: Vec<u8> = image.color().data().iter().flatten().copied().collect();
    write_pnm(&format!("{out}.ppm"), "P6", view.width, view.height, &color)?;
    let depth: Vec<u8> = image.depth().data().iter().map(|d| (d / 8.0 * 255.0) as u8).collect();
    write_pnm(&format!("{out}.pgm"), "P5", view.width, view.height, &depth)?;
    write_plan(&scene, &format!("{out}_plan.pgm"))
}

fn write_plan(scene: &Scene, path: &str) -> Result<(), Box<dyn std::error::Error>> {
    let grid = scene.world.true_grid(0.02, HeightBand::new(0.012, 0.6)?)?;
    let geometry = *grid.geometry();
    let mut pixels: Vec<u8> = Vec::with_capacity(geometry.len());
    for row in (0..geometry.height).rev() {
        let cells = &grid.cells()[row * geometry.width..(row + 1) * geometry.width];
        pixels.extend(cells.iter().map(|&cell| if cell == Cell::Free { 255 } else { 0 }));
    }
    for pose in [scene.start, scene.goal] {
        for step in 0..15 {
            let point = pose.transform(trundle_core::Vector2::new(0.02 * f64::from(step), 0.0));
            if let Some(cell) = geometry.cell_at(point) {
                pixels[(geometry.height - 1 - cell.row) * geometry.width + cell.col] = 128;
            }
        }
    }
    write_pnm(path, "P5", geometry.width, geometry.height, &pixels)
}

fn write_pnm(
    path: &str,
    magic: &str,
    width: usize,
    height: usize,
    pixels: &[u8],
) -> Result<(), Box<dyn std::error::Error>> {
    let mut bytes = format!("{magic}\n{width} {height}\n255\n").into_bytes();
    bytes.extend_from_slice(pixels);
    Ok(fs::write(path, bytes)?)
}
