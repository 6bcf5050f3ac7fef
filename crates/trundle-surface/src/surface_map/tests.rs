//! Surfaces of a box-shaped room with a ball, from exact images.

use super::*;
use crate::surface_nets::surface_mesh;
use crate::voxel_block::BLOCK_VOXELS;
use trundle_core::{ColorImage, DepthImage, Stamp, Vector2};

/// Half sides of a box-shaped room around the origin, m.
const ROOM_HALF_M: [f64; 3] = [2.1, 1.6, 1.2];

/// A camera that looks along +x turned by `yaw` about z, at `at` m.
fn pose(at: [f64; 3], yaw: f64) -> Pose3 {
    let forward = nalgebra::Vector3::new(yaw.cos(), yaw.sin(), 0.0);
    let right = nalgebra::Vector3::new(yaw.sin(), -yaw.cos(), 0.0);
    let rotation = nalgebra::Matrix3::from_columns(&[right, forward.cross(&right), forward]);
    Pose3::from_matrix(rotation, at.into())
}

fn camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view((160, 120), (1.2, 0.95)).unwrap()
}

/// The image of the room, each wall of its own colour, with a ball of `ball` m radius at the origin.
fn image(pose: &Pose3, ball: f64) -> RgbdImage {
    let camera = camera();
    let start = pose.transform(Vector3::zeros());
    let ray = |x: usize, y: usize| {
        let direction = pose.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
        let walls = (0..3).map(|i| ((ROOM_HALF_M[i] * direction[i].signum() - start[i]) / direction[i], i));
        let (wall, axis) = walls.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        let (a, b, c) = (direction.dot(&direction), direction.dot(&start), start.dot(&start) - ball * ball);
        let root = (b * b - a * c).sqrt();
        let sphere = (-b - root) / a;
        if sphere > 0.0 {
            (sphere, [250, 250, 0])
        } else {
            (wall, [[200, 0, 0], [0, 200, 0], [0, 0, 200]][axis])
        }
    };
    let depth = DepthImage::from_fn(160, 120, |x, y| ray(x, y).0 as f32);
    RgbdImage::new(Stamp::default(), ColorImage::from_fn(160, 120, |x, y| ray(x, y).1), depth).unwrap()
}

/// A map of `turns` views all around from two places.
fn room(ball: f64, turns: usize) -> SurfaceMap {
    let mut map = SurfaceMap::new(SurfaceConfig { voxel: 0.04, ..SurfaceConfig::default() }).unwrap();
    look_around(&mut map, ball, turns);
    map
}

fn look_around(map: &mut SurfaceMap, ball: f64, turns: usize) {
    for i in 0..turns {
        let yaw = i as f64 * 0.5;
        let at = if i % 2 == 0 { [-1.2, 0.4, 0.1] } else { [1.2, -0.5, -0.1] };
        let pose = pose(at, yaw);
        map.integrate(&image(&pose, ball), &camera(), &pose).unwrap();
    }
}

/// Distance of a point from the walls, m.
fn off_walls(vertex: &[f32; 3]) -> f64 {
    let gap = |i: usize| (f64::from(vertex[i]).abs() - ROOM_HALF_M[i]).abs();
    gap(0).min(gap(1)).min(gap(2))
}

#[test]
fn the_walls_of_a_room_are_where_they_are_with_their_colours_and_face_inward() {
    let mesh = surface_mesh(&room(0.0, 26));
    assert!(mesh.triangles.len() > 5_000, "{}", mesh.triangles.len());
    let mut errors: Vec<f64> = mesh.vertices.iter().map(off_walls).collect();
    errors.sort_by(f64::total_cmp);
    let share = errors.iter().filter(|error| **error < 0.01).count() as f64 / errors.len() as f64;
    assert!(share > 0.97, "{share} within 1 cm, worst {:?}", errors.last());
    for ((at, normal), color) in mesh.vertices.iter().zip(&mesh.normals).zip(&mesh.colors) {
        let gaps: Vec<f64> = (0..3).map(|i| ROOM_HALF_M[i] - f64::from(at[i]).abs()).collect();
        let axis = (0..3).min_by(|&a, &b| gaps[a].total_cmp(&gaps[b])).unwrap();
        let is_far_from_edges = (0..3).filter(|&i| i != axis).all(|i| gaps[i] > 0.2);
        if is_far_from_edges {
            assert!(normal[axis] * at[axis].signum() < -0.9, "{at:?} {normal:?}");
            assert!(color[axis] > 150, "{at:?} {color:?}");
        }
    }
}

#[test]
fn triangles_face_as_their_normals() {
    let mesh = surface_mesh(&room(0.0, 12));
    let at = |index: u32| nalgebra::Vector3::from(mesh.vertices[index as usize]);
    let agree = |t: &&[u32; 3]| {
        let normal = (at(t[1]) - at(t[0])).cross(&(at(t[2]) - at(t[0])));
        normal.dot(&nalgebra::Vector3::from(mesh.normals[t[0] as usize])) >= 0.0
    };
    let share = mesh.triangles.iter().filter(agree).count() as f64 / mesh.triangles.len() as f64;
    assert!(share > 0.99, "{share}");
}

#[test]
fn an_object_that_left_disappears() {
    let is_ball = |vertex: &&[f32; 3]| vertex.iter().map(|at| at * at).sum::<f32>() < 0.45 * 0.45;
    let mut map = room(0.4, 13);
    assert!(surface_mesh(&map).vertices.iter().filter(is_ball).count() > 100);
    look_around(&mut map, 0.0, 52);
    assert_eq!(surface_mesh(&map).vertices.iter().filter(is_ball).count(), 0);
}

#[test]
fn memory_does_not_grow_with_the_number_of_images() {
    let mut map = room(0.4, 52);
    let (blocks, memory) = (map.blocks.len(), map.memory());
    look_around(&mut map, 0.4, 52);
    assert_eq!((map.blocks.len(), map.memory()), (blocks, memory));
    assert!(memory >= blocks * BLOCK_VOXELS * 10);
}

#[test]
fn the_same_images_give_the_same_mesh() {
    assert_eq!(surface_mesh(&room(0.4, 9)), surface_mesh(&room(0.4, 9)));
}

#[test]
fn a_wrong_image_or_pose_is_refused_and_changes_nothing() {
    let mut map = room(0.0, 2);
    let before = surface_mesh(&map);
    let image = image(&pose([0.0; 3], 0.0), 0.0);
    let error = map.integrate(&image, &PinholeCamera::kinect_v2(), &Pose3::identity()).unwrap_err();
    assert!(error.to_string().contains("160 x 120"), "{error}");
    let lost = Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::new(f64::NAN, 0.0, 0.0));
    assert!(map.integrate(&image, &camera(), &lost).is_err());
    let far = Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::new(1e12, 0.0, 0.0));
    map.integrate(&image, &camera(), &far).unwrap();
    assert_eq!(surface_mesh(&map), before);
    assert!(SurfaceMap::new(SurfaceConfig { voxel: 0.0, ..SurfaceConfig::default() }).is_err());
}
