//! Triangles, movers and whole stages: against closed forms, the ray caster, and themselves on other threads.

use super::block;
use std::path::Path;
use trundle_core::{PinholeCamera, Pose2, Pose3, Vector2, Vector3};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{
    Lights, Material, Mesh, Mover, Renderer, Scene, SceneSnapshot, Target, Triangle, View, World,
    camera_mount,
};

fn look(renderer: &Renderer, world: &World, movers: &[Mover<'_>], pose: &Pose3) -> View {
    let mut view = renderer.blank();
    renderer.render(&SceneSnapshot { world, movers, lights: &Lights::default() }, pose, &mut view);
    view
}

fn kinect() -> Renderer {
    Renderer::new(PinholeCamera::kinect_v2()).unwrap()
}

/// The ray of pixel `i` of a Kinect at the origin facing along x: its component along x is 1.
fn ray(view: &View, i: usize) -> Vector3 {
    let pixel = Vector2::new((i % view.width) as f64, (i / view.width) as f64);
    camera_mount(0.0, 0.0, 0.0).rotate(PinholeCamera::kinect_v2().unproject(pixel, 1.0))
}

fn mesh(positions: Vec<[f32; 3]>, triangles: &[[u32; 3]]) -> World {
    let uvs = vec![[0.0; 2]; positions.len()];
    let triangles = triangles.iter().map(|&corners| Triangle { corners, material: 0 }).collect();
    let materials = vec![Material { name: "plain".into(), color: [150; 3], texture: None }];
    World::with_meshes(Vec::new(), vec![Mesh::new(positions, uvs, triangles, materials).unwrap()], 1).unwrap()
}

/// A sphere about (x, 0, 0) of `n` x `n` / 2 quadrilaterals.
fn sphere(x: f64, radius: f64, n: u32) -> World {
    let half = n / 2;
    let place = |i: u32, j: u32| {
        let (a, b) = (f64::from(i % n) / f64::from(n), f64::from(j) / f64::from(half));
        let ((s, c), (sb, cb)) =
            ((a * std::f64::consts::TAU).sin_cos(), (b * std::f64::consts::PI).sin_cos());
        [(x + radius * c * sb) as f32, (radius * s * sb) as f32, (radius * cb) as f32]
    };
    let positions = (0..=half).flat_map(|j| (0..n).map(move |i| place(i, j))).collect();
    let triangles: Vec<[u32; 3]> = (0..half)
        .flat_map(|j| (0..n).map(move |i| (j * n + i, j * n + (i + 1) % n)))
        .flat_map(|(a, b)| [[a, a + n, b + n], [a, b + n, b]])
        .collect();
    mesh(positions, &triangles)
}

#[test]
fn slanted_triangles_are_planes_to_a_tenth_of_a_millimetre_without_a_gap() {
    // x = 4 + 1.5 y + 0.5 z, a fan of 24 triangles around a point seen in the middle.
    let place = |y: f64, z: f64| [(4.0 + 1.5 * y + 0.5 * z) as f32, y as f32, z as f32];
    let corner = |i: u32| {
        let (s, c) = (f64::from(i) / 24.0 * std::f64::consts::TAU).sin_cos();
        place(2.0 * c, 2.0 * s)
    };
    let positions = std::iter::once(place(0.0, 0.0)).chain((0..24).map(corner)).collect();
    let triangles: Vec<[u32; 3]> = (0..24).map(|i| [0, 1 + i, 1 + (i + 1) % 24]).collect();
    let world = mesh(positions, &triangles);
    let view = look(&kinect(), &world, &[], &camera_mount(0.0, 0.0, 0.0));
    let mut inside = 0;
    for (i, &depth) in view.depth.iter().enumerate() {
        let d = ray(&view, i);
        let expected = 4.0 / (1.0 - 1.5 * d.y - 0.5 * d.z);
        if expected > 0.0 && (expected * d.yz()).norm() < 1.98 {
            assert!((f64::from(depth) - expected).abs() < 1e-4, "{depth} for {expected}");
            let cosine = (1.0 - 1.5 * d.y - 0.5 * d.z) / (3.5_f64.sqrt() * d.norm());
            assert!((f64::from(view.cosine[i]) - cosine).abs() < 1e-4);
            inside += 1;
        }
    }
    assert!(inside > 30_000, "{inside}");
}

#[test]
fn a_sphere_of_200_000_triangles_has_its_closed_form() {
    // The triangles are up to 34 um inside the sphere, twice that along slanted rays.
    let (x, radius) = (2.0, 0.7);
    let world = sphere(x, radius, 448);
    let pose = camera_mount(0.0, 0.0, 0.0);
    let view = look(&kinect(), &world, &[], &pose);
    let (mut inside, mut outside) = (0, 0);
    for (i, &depth) in view.depth.iter().enumerate() {
        let d = ray(&view, i);
        let (a, b, c) = (d.norm_squared(), x * d.x, x * x - radius * radius);
        let root2 = b * b - a * c;
        if root2 < 0.0 {
            assert_eq!(depth, 0.0);
            outside += 1;
            continue;
        }
        let expected = (b - root2.sqrt()) / a;
        let normal = (d * expected - Vector3::new(x, 0.0, 0.0)) / radius;
        if -normal.dot(&d) / d.norm() > 0.5 {
            assert!((f64::from(depth) - expected).abs() < 1e-4, "{depth} for {expected}");
            let hit = world.cast(pose.translation, d, 100.0).unwrap();
            assert!((hit.distance - f64::from(depth)).abs() < 1e-5 && hit.normal.dot(&normal) > 0.999);
            inside += 1;
        }
    }
    assert!(inside > 20_000 && outside > 50_000, "{inside} {outside}");
}

#[test]
fn rays_and_pixels_do_not_leak_between_triangles() {
    // From inside a closed surface every ray hits, for many positions with corners and edges at pixels.
    let world = sphere(0.0, 3.0, 96);
    let renderer = kinect();
    for i in 0..6 {
        let pose = Pose3::from_pose2(Pose2::new(0.1 * f64::from(i), 0.0, 0.7 * f64::from(i)))
            * camera_mount(0.0, 0.0, 0.1 * f64::from(i));
        let view = look(&renderer, &world, &[], &pose);
        assert!(view.depth.iter().all(|&depth| depth > 1.0));
        for i in (0..view.depth.len()).step_by(11) {
            let d = pose.rotate(camera_mount(0.0, 0.0, 0.0).inverse().rotate(ray(&view, i)));
            let hit = world.cast(pose.translation, d, 100.0).unwrap();
            assert!((hit.distance - f64::from(view.depth[i])).abs() < 1e-4);
            assert!(matches!(hit.target, Target::Triangle { mesh: 0, .. }) && hit.normal.dot(&d) < 0.0);
        }
    }
    let corner = Vector3::from(world.meshes()[0].corners(40)[1].map(f64::from));
    assert!(world.cast(Vector3::zeros(), corner, 2.0).is_some(), "through a corner");
}

#[test]
fn a_moving_solid_looks_like_a_standing_one() {
    let scene = Scene::by_name("obstacles", 3).unwrap();
    let pose = Pose3::from_pose2(Pose2::new(1.0, 1.0, 0.6)) * camera_mount(0.0, 0.6, 0.1);
    let at = Pose2::new(2.2, 2.0, 0.7);
    let own = World::new(vec![block([0.2, 0.0, 0.8], [0.5, 0.3, 1.6], 0.0)], 1).unwrap();
    let center = at.transform(Vector2::new(0.2, 0.0));
    let solids = scene.world.solids().iter().cloned();
    let still = solids.chain([block([center.x, center.y, 0.8], [0.5, 0.3, 1.6], 0.7)]).collect();
    let still = World::new(still, 3).unwrap();
    let movers = [Mover { body: &own, pose: at }];
    let renderer = kinect();
    let (moved, stood) = (look(&renderer, &scene.world, &movers, &pose), look(&renderer, &still, &[], &pose));
    let differ =
        |i: usize| (moved.depth[i] - stood.depth[i]).abs() > 1e-4 || moved.color[i] != stood.color[i];
    let wrong = (0..moved.depth.len()).filter(|&i| differ(i)).count();
    assert!(wrong < 100, "{wrong}");
    let stage = SceneSnapshot { world: &scene.world, movers: &movers, lights: &scene.lights };
    let mut on_mover = 0;
    for i in (0..moved.depth.len()).step_by(13) {
        let pixel = Vector2::new((i % moved.width) as f64, (i / moved.width) as f64);
        let d = pose.rotate(renderer.camera().unproject(pixel, 1.0));
        let hit = stage.cast(pose.translation, d, 100.0).unwrap();
        let expected = still.cast(pose.translation, d, 100.0).unwrap();
        assert!((hit.distance - expected.distance).abs() < 1e-9);
        assert!((hit.normal - expected.normal).norm() < 1e-9);
        on_mover += usize::from(hit.mover == Some(0));
    }
    assert!(on_mover > 500, "{on_mover}");
}

/// The house of triangles in shared/data; `None` if absent.
fn small_house() -> Option<World> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/scenes/small_house.glb"));
    if !path.exists() {
        eprintln!("skipped: {} is not there", path.display());
        return None;
    }
    let mesh = gltf(path, &GltfOptions::z_up()).unwrap().mesh;
    Some(World::with_meshes(Vec::new(), vec![mesh], 1).unwrap())
}

#[test]
fn the_house_is_drawn_as_it_is_cast_and_on_any_number_of_threads() {
    let Some(world) = small_house() else { return };
    let renderer = kinect();
    let (mut pixels, mut wrong) = (0, 0);
    for (x, y, heading) in [(0.0, 0.0, 0.0), (6.0, 1.0, 1.0), (-6.0, 1.0, 3.0), (-3.0, -3.0, 0.5)] {
        let pose = Pose3::from_pose2(Pose2::new(x, y, heading)) * camera_mount(0.0, 0.6, 0.1);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| look(&renderer, &world, &[], &pose))
        };
        let view = on(1);
        assert!(view == on(4));
        for i in (0..view.depth.len()).step_by(5) {
            let pixel = Vector2::new((i % view.width) as f64, (i / view.width) as f64);
            let d = pose.rotate(renderer.camera().unproject(pixel, 1.0));
            let depth = world.cast(pose.translation, d, 1e3).map_or(0.0, |hit| hit.distance);
            pixels += 1;
            wrong += usize::from((depth - f64::from(view.depth[i])).abs() > 1e-3);
        }
    }
    assert!(wrong * 2000 < pixels, "{wrong} of {pixels}");
}
