//! The depth camera against closed forms.

use super::{block, hall};
use trundle_core::{PinholeCamera, Pose2, Pose3, Stamp, Vector2, Vector3};
use trundle_sim::{
    ColorNoise, Cylinder, DepthNoise, Finish, Lights, Paint, Renderer, RgbdSensor, Scene, SceneSnapshot,
    Shape, Solid, View, World, camera_mount,
};

fn seen(world: &World, world_from_camera: &Pose3) -> View {
    let renderer = Renderer::new(PinholeCamera::kinect_v2()).unwrap();
    let mut view = renderer.blank();
    let lights = Lights::default();
    renderer.render(&SceneSnapshot { world, movers: &[], lights: &lights }, world_from_camera, &mut view);
    view
}

/// Calls `check` with every pixel's normalised coordinates and depth.
fn each_pixel(view: &View, mut check: impl FnMut(f64, f64, f64)) {
    let camera = PinholeCamera::kinect_v2();
    for i in 0..view.depth.len() {
        let ray = camera.unproject(Vector2::new((i % view.width) as f64, (i / view.width) as f64), 1.0);
        check(ray.x, ray.y, f64::from(view.depth[i]));
    }
}

#[test]
fn wall_and_floor_are_planes_to_a_tenth_of_a_millimetre() {
    let (height, pitch) = (0.45, 0.15_f64);
    let view = seen(&hall(Pose2::IDENTITY).world, &camera_mount(0.0, height, pitch));
    let (mut on_wall, mut on_floor) = (0, 0);
    each_pixel(&view, |x, y, depth| {
        // The ray in the world: forward cos - y sin, sideways -x, down sin + y cos.
        let (forward, down) = (pitch.cos() - y * pitch.sin(), pitch.sin() + y * pitch.cos());
        let (wall, floor) = (3.0 / forward, height / down.max(1e-9));
        let is_side = (x * wall.min(floor)).abs() > 2.99;
        let is_over = height - down * wall > 1.99;
        if !is_side && !is_over {
            assert!((depth - wall.min(floor)).abs() < 1e-4, "{x} {y}: {depth}");
            if wall < floor { on_wall += 1 } else { on_floor += 1 }
        }
    });
    assert!(on_wall > 50_000 && on_floor > 50_000, "{on_wall} {on_floor}");
}

#[test]
fn a_turned_box_and_a_cylinder_have_their_closed_forms() {
    let yaw = 0.5_f64;
    let cylinder = Cylinder { base: Vector3::new(3.0, 0.8, -1.0), radius: 0.4, height: 2.0 };
    let finish = Finish::all(Paint::Flat { color: [99; 3] });
    let solids = vec![
        block([4.0, -1.0, 0.0], [1.0, 1.4, 2.0], yaw),
        Solid { shape: Shape::Cylinder(cylinder), finish },
    ];
    let world = World::new(solids, 1).unwrap();
    let view = seen(&world, &camera_mount(0.0, 0.0, 0.0));
    let (mut on_box, mut on_cylinder) = (0, 0);
    each_pixel(&view, |x, y, depth| {
        if depth == 0.0 || y.abs() * depth > 0.99 {
            return;
        }
        let p = Vector3::new(depth, -x * depth, -y * depth);
        if p.y > 0.35 {
            // On the cylinder's side the distance to the axis equals the radius; for each ray: the nearer root of the quadratic.
            let (a, b, c) = (1.0 + x * x, 3.0 - 0.8 * x, 3.0 * 3.0 + 0.8 * 0.8 - 0.16);
            let root = (b * b - a * c).max(0.0).sqrt();
            assert!((depth - (b - root) / a).abs() < 1e-4, "{depth} at {x} {y}");
            on_cylinder += 1;
        } else {
            let out = Vector2::new(p.x - 4.0, p.y + 1.0);
            let own =
                Vector2::new(yaw.cos() * out.x + yaw.sin() * out.y, -yaw.sin() * out.x + yaw.cos() * out.y);
            let outside = (own.x.abs() - 0.5).max(own.y.abs() - 0.7);
            assert!(outside.abs() < 1e-4, "{own}");
            on_box += 1;
        }
    });
    assert!(on_box > 10_000 && on_cylinder > 5_000, "{on_box} {on_cylinder}");
}

#[test]
fn the_renderer_agrees_with_the_ray_caster() {
    let camera = PinholeCamera::kinect_v2();
    let scene = Scene::by_name("obstacles", 3).unwrap();
    let mount = camera_mount(0.05, 0.45, 0.14);
    let (mut pixels, mut wrong) = (0, 0);
    for (place, heading) in [(scene.start, 0.8), (scene.start, -2.0), (scene.goal, 3.6)] {
        let pose = Pose3::from_pose2(Pose2::new(place.x, place.y, heading)) * mount;
        let view = seen(&scene.world, &pose);
        for i in (0..view.depth.len()).step_by(7) {
            let pixel = Vector2::new((i % view.width) as f64, (i / view.width) as f64);
            let ray = pose.rotate(camera.unproject(pixel, 1.0));
            let hit = scene.world.cast(pose.translation, ray, 1e3);
            let depth = hit.map_or(0.0, |hit| hit.distance);
            let cosine = hit.map_or(0.0, |hit| hit.normal.dot(&ray).abs() / ray.norm());
            pixels += 1;
            let is_same = (f64::from(view.depth[i]) - depth).abs() < 1e-4
                && (f64::from(view.cosine[i]) - cosine).abs() < 2e-3;
            wrong += usize::from(!is_same);
        }
    }
    // A ray that grazes an edge may have different results in f32 and f64.
    assert!(wrong * 5000 < pixels, "{wrong} of {pixels}");
}

#[test]
fn a_walls_noise_is_the_models() {
    let view = seen(&hall(Pose2::IDENTITY).world, &camera_mount(0.0, 0.8, 0.0));
    let sensor = RgbdSensor::new(DepthNoise::default(), ColorNoise::default(), 9).unwrap();
    let image = sensor.expose(&view, Stamp::default(), 4).unwrap();
    let (mut n, mut sum, mut sum2) = (0.0, 0.0, 0.0);
    for (y, x) in (170..250).flat_map(|y| (200..310).map(move |x| (y, x))) {
        let error = f64::from(image.depth()[(x, y)]) - 3.0;
        (n, sum, sum2) = (n + 1.0, sum + error, sum2 + error * error);
    }
    let sigma = DepthNoise::default().sigma(3.0, 0.1);
    let spread = (sum2 / n - (sum / n).powi(2)).sqrt();
    assert!((spread / sigma - 1.0).abs() < 0.05 && (sum / n).abs() < 2e-4, "{spread} {sigma}");
}
