//! Heights of steps, of a table, and of nothing.

use crate::scene::{Body, Painted, grey, look_at, map_of, voxels_of};
use trundle_core::Pose3;
use trundle_surface::{HeightMap, SurfaceMesh, surface_mesh};

/// Rise and depth of a step, m.
const RISE_M: f64 = 0.16;
const TREAD_M: f64 = 0.3;

fn stairs() -> Vec<Painted> {
    let step = |i: u32| {
        let at = f64::from(i);
        Body::Block { low: [at * TREAD_M, -0.5, -0.2], high: [4.0 * TREAD_M, 0.5, at * RISE_M] }
    };
    (0..4).map(step).map(grey).collect()
}

/// Cameras above and before the stairs.
fn from_above() -> Vec<Pose3> {
    [0.1, 0.5, 0.9].iter().flat_map(|&x| [look_at([x - 0.3, 0.0, 1.9], [x, 0.02, 0.0]); 3]).collect()
}

fn height_at(map: &HeightMap, x: f64, y: f64) -> f32 {
    let cell = |at: f64, axis: usize| ((at - map.origin[axis]) / map.resolution).floor();
    let (column, row) = (cell(x, 0), cell(y, 1));
    if column < 0.0 || row < 0.0 || column as usize >= map.width || row as usize >= map.height {
        return f32::NAN;
    }
    map.heights[row as usize * map.width + column as usize]
}

#[test]
fn each_tread_of_the_stairs_has_its_height() {
    let mesh = surface_mesh(&map_of(&stairs(), &from_above(), voxels_of(0.02)));
    let map = HeightMap::of(&mesh, 0.05, 1.8).unwrap().unwrap();
    for step in 0..4 {
        for y in [-0.3, 0.02, 0.33] {
            let height = f64::from(height_at(&map, (f64::from(step) + 0.6) * TREAD_M, y));
            let expected = f64::from(step) * RISE_M;
            assert!(
                (height - expected).abs() < 0.01,
                "step {step}, y {y} m: {height} m, expected {expected}"
            );
        }
    }
    assert!(height_at(&map, 0.5, 0.9).is_nan(), "beside the stairs is nothing");
}

/// A table hides the floor under it from above; a camera below the top sees it.
#[test]
fn the_ceiling_separates_a_table_from_the_floor_under_it() {
    let floor = Body::Plane { at: [0.0; 3], normal: [0.0, 0.0, 1.0] };
    let table = Body::Block { low: [0.8, -0.4, 0.7], high: [1.6, 0.4, 0.75] };
    let above = look_at([0.0, 0.0, 1.6], [1.2, 0.01, 0.5]);
    let below = look_at([-0.4, 0.0, 0.45], [1.2, 0.01, 0.1]);
    let poses = [above, above, above, below, below, below];
    let mesh = surface_mesh(&map_of(&[grey(floor), grey(table)], &poses, voxels_of(0.02)));
    let height = |ceiling: f64| {
        let map = HeightMap::of(&mesh, 0.05, ceiling).unwrap().unwrap();
        f64::from(height_at(&map, 1.1, 0.02))
    };
    assert!((height(1.8) - 0.75).abs() < 0.01, "{}", height(1.8));
    assert!(height(0.5).abs() < 0.01, "{}", height(0.5));
}

#[test]
fn without_an_upward_surface_there_is_no_height_map() {
    assert_eq!(HeightMap::of(&SurfaceMesh::default(), 0.05, 1.8).unwrap(), None);
    let wall = Body::Plane { at: [1.5, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] };
    let mesh =
        surface_mesh(&map_of(&[grey(wall)], &[look_at([0.0; 3], [1.0, 0.0, 0.0]); 2], voxels_of(0.03)));
    assert!(!mesh.vertices.is_empty());
    assert_eq!(HeightMap::of(&mesh, 0.05, 1.8).unwrap(), None);
}

#[test]
fn wrong_cells_and_too_many_cells_are_refused() {
    let far = SurfaceMesh {
        vertices: vec![[0.0; 3], [9_000.0, 9_000.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 2],
        ..SurfaceMesh::default()
    };
    for (resolution, words) in
        [(0.0, "resolution"), (f64::NAN, "resolution"), (2.0, "0.01 to 1"), (0.05, "cells")]
    {
        let error = HeightMap::of(&far, resolution, 1.8).unwrap_err().to_string();
        assert!(error.contains(words), "{resolution} m: {error}");
    }
}
