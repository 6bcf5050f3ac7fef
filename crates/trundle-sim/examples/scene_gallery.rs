//! Writes a picture of every built-in scene (two camera views, and the true grid with start and goal) and prints the scenes' costs.
//!
//! `cargo run --release -p trundle-sim --example scene_gallery -- OUT_DIR [SEED [HEIGHT_PX [SCENE]]]` writes
//! OUT_DIR/scene-NAME.png.
#![expect(clippy::print_stdout, reason = "this is what an example is for")]

use image::{Rgb, RgbImage};
use std::path::Path;
use std::time::Instant;
use trundle_core::{Cell, PinholeCamera, Pose2, Pose3, Vector2};
use trundle_sim::{HeightBand, Renderer, Scene, camera_mount};

type Failure = Box<dyn std::error::Error>;

/// Poses of the cameras: x, y (m) and heading (deg) in the scene's world.
const VIEWS: [(&str, [[f64; 3]; 2]); 10] = [
    ("demo", [[0.9, 1.1, 20.0], [5.0, 3.9, -40.0]]),
    ("room", [[2.4, 2.4, -135.0], [-2.4, 0.0, 20.0]]),
    ("obstacles", [[0.7, 0.7, 45.0], [5.3, 5.2, -135.0]]),
    ("corridor-a", [[-0.19, -2.0, 90.0], [0.19, 2.0, -90.0]]),
    ("corridor-b", [[0.0, -1.5, 90.0], [-0.1, 2.6, -90.0]]),
    ("corridor-c", [[0.0, -1.5, 90.0], [-0.1, 2.6, -90.0]]),
    ("corridor-d", [[0.0, -1.5, 90.0], [-0.1, 2.6, -90.0]]),
    ("office", [[2.0, 5.34, 0.0], [4.0, 3.9, -125.0]]),
    ("house", [[9.3, 0.9, 145.0], [6.7, 5.6, 50.0]]),
    ("warehouse", [[1.4, 2.4, 70.0], [22.6, 3.6, 50.0]]),
];

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let out = Path::new(arguments.first().ok_or("expected OUT_DIR [SEED [HEIGHT_PX [SCENE]]]")?);
    let number = |i: usize, default: u64| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (seed, height) = (number(1, 1)?, number(2, 170)? as u32);
    let wanted = |name: &str| arguments.get(3).is_none_or(|only| only == name);
    std::fs::create_dir_all(out)?;
    for (name, views) in VIEWS.into_iter().filter(|(name, _)| wanted(name)) {
        let started = Instant::now();
        let scene = Scene::by_name(name, seed)?;
        let built = started.elapsed();
        scene.world.prepare_textures();
        println!(
            "{name}: {} solids, built in {:.1} ms, painted in {:.0} ms on {} threads",
            scene.world.solids().len(),
            built.as_secs_f64() * 1e3,
            (started.elapsed() - built).as_secs_f64() * 1e3,
            rayon::current_num_threads(),
        );
        picture(&scene, views, height)?.save(out.join(format!("scene-{name}.png")))?;
    }
    Ok(())
}

/// Two views, one above the other, each `height` px, and the plan to the right.
fn picture(scene: &Scene, views: [[f64; 3]; 2], height: u32) -> Result<RgbImage, Failure> {
    let width = height * 6 / 5;
    let plan = plan(scene, 2 * height + 4)?;
    let mut sheet = RgbImage::from_pixel(width + 4 + plan.width(), plan.height(), Rgb([255; 3]));
    for (nth, [x, y, deg]) in views.into_iter().enumerate() {
        let view = view(scene, Pose2::new(x, y, deg.to_radians()), (width, height))?;
        image::imageops::replace(&mut sheet, &view, 0, i64::from(height + 4) * nth as i64);
    }
    image::imageops::replace(&mut sheet, &plan, i64::from(width) + 4, 0);
    Ok(sheet)
}

fn view(scene: &Scene, pose: Pose2, (width, height): (u32, u32)) -> Result<RgbImage, Failure> {
    let camera = PinholeCamera::from_field_of_view((width as usize, height as usize), (1.232, 1.047))?;
    let renderer = Renderer::new(camera)?;
    let mut view = renderer.blank();
    let mount = camera_mount(0.05, 0.45, 8_f64.to_radians());
    renderer.render(&scene.snapshot(), &(Pose3::from_pose2(pose) * mount), &mut view);
    // Five bits a colour: half the file, and no eye sees it at this size.
    let bytes = view.color.iter().flatten().map(|byte| byte & 0xF8 | byte >> 5).collect();
    RgbImage::from_raw(width, height, bytes).ok_or_else(|| "image size".into())
}

/// The true grid of a Kobuki's height band, at most `side` px high and two and a half times as wide; start green, goal red.
fn plan(scene: &Scene, side: u32) -> Result<RgbImage, Failure> {
    let (low, high) = scene.world.bounds();
    let resolution = ((high.y - low.y) / f64::from(side)).max((high.x - low.x) / f64::from(side * 5 / 2));
    let grid = scene.world.true_grid(resolution * 1.0001, HeightBand::new(0.012, 0.6)?)?;
    let geometry = *grid.geometry();
    let shade = |cell: Cell| if cell == Cell::Free { Rgb([244, 242, 236]) } else { Rgb([40, 44, 56]) };
    let mut plan = RgbImage::from_fn(geometry.width as u32, side, |x, y| {
        let row = geometry.height as i64 - 1 - i64::from(y);
        usize::try_from(row)
            .map_or(Rgb([255; 3]), |row| shade(grid.cells()[row * geometry.width + x as usize]))
    });
    for (pose, color) in [(scene.start, Rgb([20, 150, 60])), (scene.goal, Rgb([210, 40, 40]))] {
        for step in 0..200 {
            // A disc of the robot's size, with a beak ahead.
            let (angle, reach) = (f64::from(step) * 0.0628, if step % 2 == 0 { 0.1755 } else { 0.12 });
            let beak = f64::from(step) / 200.0 * 0.4;
            for point in [Vector2::new(reach * angle.cos(), reach * angle.sin()), Vector2::new(beak, 0.0)] {
                if let Some(cell) = geometry.cell_at(pose.transform(point)) {
                    plan.put_pixel(cell.col as u32, (geometry.height - 1 - cell.row) as u32, color);
                }
            }
        }
    }
    Ok(plan)
}
