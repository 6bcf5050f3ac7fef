//! Cost of worlds from files: reading a glTF house, its contact geometry, its true grid.
//!
//! `cargo run --release -p trundle-sim --example house_timing -- FILE.glb` (z up).
#![expect(clippy::print_stdout, reason = "a program that prints")]

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;
use trundle_core::{Footprint, Pose2};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{HeightBand, Obstacles, World};

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).unwrap_or("../shared/data/scenes/small_house.glb".into());
    let mesh = timed("read", || gltf(file.as_ref(), &GltfOptions::z_up()))?.mesh;
    println!("{} triangles, {} materials", mesh.triangles().len(), mesh.materials().len());
    let world = World::with_meshes(Vec::new(), vec![mesh], 1)?;
    let band = HeightBand::new(0.012, 0.6)?;
    let obstacles = timed("obstacles", || world.obstacles(band));
    for resolution in [0.05, 0.01] {
        let grid = timed(&format!("true grid at {resolution} m"), || world.true_grid(resolution, band))?;
        println!("{} x {} cells", grid.geometry().width, grid.geometry().height);
    }
    // Places anywhere in the house, in the furniture as well.
    let (low, high) = world.bounds();
    let places: Vec<Pose2> = (0..100_000_u32)
        .map(|i| {
            let part = |k: u32| f64::from(i.wrapping_mul(k) >> 8) / f64::from(u32::MAX >> 8);
            Pose2::new(
                low.x + part(2_654_435_761) * (high.x - low.x),
                low.y + part(805_459_861) * (high.y - low.y),
                0.3,
            )
        })
        .collect();
    let square = [(0.2, 0.15), (-0.2, 0.15), (-0.2, -0.15), (0.2, -0.15)]
        .map(|(x, y)| trundle_core::Vector2::new(x, y));
    for (name, footprint) in
        [("disc", Footprint::KOBUKI), ("rectangle", Footprint::polygon(square.to_vec())?)]
    {
        let mut batches: Vec<f64> =
            places.chunks(1000).map(|places| micros_each(&obstacles, &footprint, places)).collect();
        batches.sort_by(f64::total_cmp);
        println!("clearance of a {name}: median {:.2} us, best batch {:.2} us", batches[50], batches[0]);
    }
    Ok(())
}

fn micros_each(obstacles: &Obstacles, footprint: &Footprint, places: &[Pose2]) -> f64 {
    let start = Instant::now();
    for place in places {
        black_box(obstacles.clearance(footprint, *place));
    }
    start.elapsed().as_secs_f64() / places.len() as f64 * 1e6
}

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    println!("{what}: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    result
}
