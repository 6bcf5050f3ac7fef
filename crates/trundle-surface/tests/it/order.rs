//! The order of the images, and their repetition.

use crate::scene::{Body, around, camera, grey, image, look, look_at, map_of, voxels_of};
use std::collections::BTreeMap;
use trundle_core::{DepthImage, RgbdImage};
use trundle_surface::{SurfaceMesh, surface_mesh};

const BALL: Body = Body::Ball { at: [0.0; 3], radius: 0.4 };
const VOXEL_M: f64 = 0.03;

/// Vertices by their cells.
fn by_cell(mesh: &SurfaceMesh) -> BTreeMap<[i64; 3], [f32; 3]> {
    let cell = |at: &[f32; 3]| at.map(|x| (f64::from(x) / VOXEL_M - 0.5).floor() as i64);
    mesh.vertices.iter().map(|at| (cell(at), *at)).collect()
}

/// Averages do not depend on the order as long as no weight is at its bound.
#[test]
fn the_order_of_the_images_does_not_move_the_surface() {
    let poses = around([0.0; 3], 1.2, 14);
    let backwards: Vec<_> = poses.iter().rev().copied().collect();
    let meshes =
        [&poses, &backwards].map(|poses| surface_mesh(&map_of(&[grey(BALL)], poses, voxels_of(VOXEL_M))));
    let [a, b] = [by_cell(&meshes[0]), by_cell(&meshes[1])];
    let common: Vec<_> = a.iter().filter_map(|(cell, at)| Some((at, b.get(cell)?))).collect();
    assert!(common.len() * 100 >= a.len().max(b.len()) * 98, "{} of {}, {}", common.len(), a.len(), b.len());
    for (a, b) in common {
        let moved = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        assert!(f64::from(moved) < 0.1 * VOXEL_M, "{a:?} {b:?}");
    }
}

#[test]
fn an_image_again_leaves_the_surface_in_place() {
    let pose = look_at([0.0, -1.2, 0.3], [0.0; 3]);
    let mut map = map_of(&[grey(BALL)], &[pose; 2], voxels_of(VOXEL_M));
    let once = surface_mesh(&map);
    look(&mut map, &[grey(BALL)], &[pose; 6]);
    let again = surface_mesh(&map);
    assert_eq!((&once.triangles, &once.colors), (&again.triangles, &again.colors));
    for (a, b) in once.vertices.iter().zip(&again.vertices) {
        assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-3), "{a:?} {b:?}");
    }
}

/// A surface needs the weight of two images at 2 m: a single distant image is no evidence.
#[test]
fn a_distant_surface_seen_once_is_left_out() {
    let wall = |x: f64| [grey(Body::Plane { at: [x, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] })];
    let pose = look_at([0.0; 3], [1.0, 0.0, 0.0]);
    let count = |x: f64, images: usize| {
        surface_mesh(&map_of(&wall(x), &vec![pose; images], voxels_of(0.02))).vertices.len()
    };
    assert_eq!(count(3.0, 1), 0);
    assert!(count(3.0, 2) > 10_000);
    assert!(count(0.8, 1) > 1_000, "a near image weighs more");
}

/// The mean of noisy depths is nearer to the wall than one of them.
#[test]
fn more_images_average_the_noise_of_the_depth() {
    let wall = [grey(Body::Plane { at: [2.0, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] })];
    let pose = look_at([0.0; 3], [1.0, 0.0, 0.0]);
    let exact = image(&wall, &camera(), &pose);
    let noisy = |seed: usize| {
        let noise =
            |x: usize, y: usize| ((x * 7919 + y * 104_729 + seed * 15_485_863) % 1_009) as f32 / 1_009.0;
        let depth = DepthImage::from_fn(160, 120, |x, y| exact.depth()[(x, y)] + 0.04 * (noise(x, y) - 0.5));
        RgbdImage::new(exact.stamp(), exact.color().clone(), depth).unwrap()
    };
    let error = |images: usize| {
        let mut map = map_of(&[], &[], voxels_of(0.02));
        (0..images).for_each(|i| map.integrate(&noisy(i), &camera(), &pose).unwrap());
        let mesh = surface_mesh(&map);
        let sum: f64 = mesh.vertices.iter().map(|at| (f64::from(at[0]) - 2.0).powi(2)).sum();
        (sum / mesh.vertices.len() as f64).sqrt()
    };
    let [few, many] = [error(2), error(32)];
    assert!(many < 0.5 * few && many < 0.003, "{few} m of 2 images, {many} m of 32");
}
