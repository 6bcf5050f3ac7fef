use trundle_core::{PinholeCamera, Pose2, Pose3};
use trundle_sim::{Renderer, Scene, View, camera_mount};

fn gray(view: &View) -> Vec<f64> {
    view.color.iter().map(|c| c.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0).collect()
}

fn look(renderer: &Renderer, scene: &Scene, pose: Pose2, pitch: f64) -> Vec<f64> {
    let mut view = renderer.blank();
    let camera = Pose3::from_pose2(pose) * camera_mount(0.0, 1.0, pitch);
    renderer.render(&scene.stage(), &camera, &mut view);
    gray(&view)
}

fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Moving sideways by one pixel's width on a wall must shift its picture by one pixel and change nothing else.
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

/// Wherever the robot looks there is something to see: all but a twentieth of the patches of 32 x 32 pixels
/// spread by more than twice the sensor's noise.
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
