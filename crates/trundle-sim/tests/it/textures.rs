//! Rendered textures: no flicker, enough features.

use trundle_core::{ColorImage, PinholeCamera, Pose2, Pose3};
use trundle_sim::{
    Lights, Material, Mesh, Renderer, Scene, SceneSnapshot, Triangle, View, World, camera_mount,
};

fn gray(view: &View) -> Vec<f64> {
    view.color.iter().map(|c| c.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0).collect()
}

fn look(renderer: &Renderer, scene: &Scene, pose: Pose2, pitch: f64) -> Vec<f64> {
    let mut view = renderer.blank();
    let camera = Pose3::from_pose2(pose) * camera_mount(0.0, 1.0, pitch);
    renderer.render(&scene.snapshot(), &camera, &mut view);
    gray(&view)
}

fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// A sideways motion by one pixel's width on a wall must shift its picture by exactly one pixel.
#[test]
fn textures_do_not_flicker() {
    let renderer = Renderer::new(PinholeCamera::kinect_v2()).unwrap();
    let (width, fx) = (renderer.camera().width(), renderer.camera().fx());
    let scene = Scene::by_name("obstacles", 2).unwrap();
    // The west wall from 3 and 5 m: x = 0, looking along -x.
    for distance in [3.0, 5.0] {
        let at = |y: f64| look(&renderer, &scene, Pose2::new(distance, y, std::f64::consts::PI), 0.0);
        let (before, after) = (at(3.0), at(3.0 - distance / fx));
        let (mut change, mut values) = (Vec::new(), Vec::new());
        for (y, x) in (40..120).flat_map(|y| (160..350).map(move |x| (y, x))) {
            change.push((after[y * width + x] - before[y * width + x - 1]).abs());
            values.push(before[y * width + x]);
        }
        let mean = change.iter().sum::<f64>() / change.len() as f64;
        assert!(mean < 1.0 && spread(&values) > 12.0, "{mean} of {}", spread(&values));
    }
}

/// Texture in every view: all but a twentieth of the patches of 32 x 32 pixels vary by more than twice the sensor's noise.
#[test]
fn the_demo_is_rich_in_texture() {
    let renderer = Renderer::new(PinholeCamera::kinect_v2()).unwrap();
    let (width, height) = (renderer.camera().width(), renderer.camera().height());
    let scene = Scene::by_name("demo", 1).unwrap();
    let (mut patches, mut poor) = (0, 0);
    for i in 0..12 {
        let place = if i % 2 == 0 { scene.start } else { scene.goal };
        let image = look(&renderer, &scene, Pose2::new(place.x, place.y, f64::from(i) * 0.55), 0.1);
        for (top, left) in
            (0..height - 32).step_by(32).flat_map(|y| (0..width).step_by(32).map(move |x| (y, x)))
        {
            let rows =
                (top..top + 32).flat_map(|y| image[y * width + left..y * width + left + 32].iter().copied());
            patches += 1;
            poor += usize::from(spread(&rows.collect::<Vec<_>>()) < 4.0);
        }
    }
    assert!(poor * 20 < patches, "{poor} of {patches} patches are flat");
}

/// A wall at x = 0 with a picture of fine checks and broad stripes, 96 x 80 texels, every 0.5 m.
fn pictured_wall() -> World {
    let check = |x: usize, y: usize| if (x / 3 + y / 2).is_multiple_of(2) { 225 } else { 40 };
    let picture = ColorImage::from_fn(96, 80, |x, y| [check(x, y), if x < 40 { 30 } else { 200 }, 90]);
    let corner = |y: f32, z: f32| ([0.0, y, z], [2.0 * y, -2.0 * z]);
    let corners = [corner(-9.0, -1.0), corner(9.0, -1.0), corner(9.0, 4.0), corner(-9.0, 4.0)];
    let triangles = [[0, 1, 2], [0, 2, 3]].map(|corners| Triangle { corners, material: 0 });
    let material = Material { name: "wall".into(), color: [255; 3], texture: Some(picture) };
    let (positions, uvs) = corners.into_iter().unzip();
    let mesh = Mesh::new(positions, uvs, triangles.to_vec(), vec![material]).unwrap();
    World::with_meshes(Vec::new(), vec![mesh], 1).unwrap()
}

/// A camera moves half a millimetre per frame along and towards a wall of checks hardly larger than its pixels, seen straight and at a
/// slant. No pixel changes by nearly the difference of light and dark, and the image mean is nearly constant.
#[test]
fn pictures_do_not_flicker() {
    let renderer = Renderer::new(PinholeCamera::kinect_v2()).unwrap();
    let world = pictured_wall();
    let stage = SceneSnapshot { world: &world, movers: &[], lights: &Lights::default() };
    for heading in [std::f64::consts::PI, 2.0] {
        let at = |step: u32| {
            let length = 0.0005 * f64::from(step);
            let mut view = renderer.blank();
            let pose = Pose3::from_pose2(Pose2::new(3.0 - length, 0.5 + length, heading));
            renderer.render(&stage, &(pose * camera_mount(0.0, 1.0, 0.0)), &mut view);
            // Outside the wall the image is empty.
            gray(&view)
                .into_iter()
                .zip(view.depth)
                .map(|(gray, depth)| (depth > 0.0).then_some(gray))
                .collect::<Vec<_>>()
        };
        let mut before = at(0);
        for step in 1..20 {
            let now = at(step);
            let both = || now.iter().zip(&before).filter_map(|(now, before)| Some((*now)? - (*before)?));
            let jump = both().map(f64::abs).fold(0.0, f64::max);
            let drift = both().sum::<f64>().abs() / now.len() as f64;
            // A tenth of a texel further, in steps of a sixteenth: at most two across and one down of a contrast of 120.
            assert!(jump < 20.0 && drift < 0.1, "step {step}, heading {heading}: {jump} {drift}");
            before = now;
        }
        let seen: Vec<f64> = before.into_iter().flatten().collect();
        assert!(seen.len() > 100_000 && spread(&seen) > 10.0, "{}", spread(&seen));
    }
}
