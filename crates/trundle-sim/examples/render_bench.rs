//! Times drawing and casting in a glTF scene and writes the depth images: our half of `bench/simulator/render.py`.
//!
//! `cargo run --release -p trundle-sim --example render_bench -- SCENE.glb POSES.txt OUT_DIR FRAMES`: one pose per line, x y (m) heading
//! pitch (rad), of a camera 0.6 m above the floor. Prints JSON: means over the poses, each the best of its frames. CPU time is that of all
//! threads, from /proc; on other systems it is wall-clock time.
#![expect(clippy::print_stdout, reason = "this is what an example is for")]

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;
use trundle_core::{PinholeCamera, Pose2, Pose3, Stamp, Vector2};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{ColorNoise, DepthNoise, Lights, Renderer, RgbdSensor, SceneSnapshot, World, camera_mount};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, poses, out, frames] = arguments.as_slice() else {
        return Err("expected SCENE.glb POSES.txt OUT_DIR FRAMES".into());
    };
    let frames: usize = frames.parse()?;
    let mesh = gltf(Path::new(scene), &GltfOptions::z_up())?.mesh;
    let world = World::with_meshes(Vec::new(), vec![mesh], 1)?;
    world.prepare_textures();
    let stage = SceneSnapshot { world: &world, movers: &[], lights: &Lights::default() };
    let renderer = Renderer::new(PinholeCamera::kinect_v2())?;
    let sensor = RgbdSensor::new(DepthNoise::default(), ColorNoise::default(), 1)?;
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut view = renderer.blank();
    let [mut drawn, mut exposed, mut drawn_alone, mut cast] = [(); 4].map(|()| Vec::new());
    for (i, line) in fs::read_to_string(poses)?.lines().enumerate() {
        let pose = parse_pose(line)?;
        drawn.push(best(frames, || renderer.render(&stage, &pose, &mut view)));
        exposed.push(best(frames, || {
            renderer.render(&stage, &pose, &mut view);
            sensor.expose(&view, Stamp::default(), i as u64).expect("the view is whole");
        }));
        drawn_alone.push(alone.install(|| best(frames, || renderer.render(&stage, &pose, &mut view))));
        cast.push(best(frames.min(3), || cast_all(&world, renderer.camera(), &pose)));
        let bytes: Vec<u8> = view.depth.iter().flat_map(|depth| depth.to_le_bytes()).collect();
        fs::write(Path::new(out).join(format!("depth{i}.f32")), bytes)?;
    }
    let wall = |times: &[(f64, f64)]| times.iter().map(|time| time.0).sum::<f64>() / times.len() as f64 * 1e3;
    let cpu = |times: &[(f64, f64)]| times.iter().map(|time| time.1).sum::<f64>() / times.len() as f64 * 1e3;
    let ns_a_ray = 1e6 / (view.width * view.height) as f64;
    println!(
        "{{\"render_wall_ms\": {}, \"render_cpu_ms\": {}, \"frame_wall_ms\": {}, \"frame_cpu_ms\": {}, \
         \"render_one_thread_ns\": {}, \"cast_ns\": {}}}",
        wall(&drawn),
        cpu(&drawn),
        wall(&exposed),
        cpu(&exposed),
        cpu(&drawn_alone) * ns_a_ray,
        cpu(&cast) * ns_a_ray,
    );
    Ok(())
}

fn parse_pose(line: &str) -> Result<Pose3, Box<dyn Error>> {
    let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let [x, y, heading, pitch] = numbers[..] else { return Err(format!("no pose: {line}").into()) };
    Ok(Pose3::from_pose2(Pose2::new(x, y, heading)) * camera_mount(0.0, 0.6, pitch))
}

fn cast_all(world: &World, camera: &PinholeCamera, pose: &Pose3) {
    for (y, x) in (0..camera.height()).flat_map(|y| (0..camera.width()).map(move |x| (y, x))) {
        let ray = pose.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
        std::hint::black_box(world.cast(pose.translation, ray, 1e3));
    }
}

/// The smallest (wall, CPU) seconds of some runs.
fn best(runs: usize, mut run: impl FnMut()) -> (f64, f64) {
    let mut best = (f64::INFINITY, f64::INFINITY);
    for _ in 0..runs.max(1) {
        let (started, worked) = (Instant::now(), cpu_seconds());
        run();
        let wall = started.elapsed().as_secs_f64();
        let cpu = cpu_seconds().zip(worked).map_or(wall, |(now, then)| now - then);
        best = (best.0.min(wall), best.1.min(cpu));
    }
    best
}

/// CPU time of all threads of this program, s; `None` if the system does not report it.
fn cpu_seconds() -> Option<f64> {
    let mut nanoseconds = 0.0;
    for task in fs::read_dir("/proc/self/task").ok()? {
        let text = fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split_whitespace().next()?.parse::<f64>().ok()?;
    }
    Some(nanoseconds * 1e-9)
}
