//! Free and occupied voxels: no holes in a surface, no wall of an object that left.

use crate::scene::{Body, Painted, camera, grey, image, look_at, map_of, voxels_of};
use std::collections::BTreeMap;
use trundle_core::Pose3;
use trundle_surface::{OccupiedVoxels, SurfaceConfig, SurfaceMesh, VoxelState, surface_mesh};

const CELL_M: f64 = 0.05;

/// Rays and surface of the same images, as one run makes them.
fn octree(bodies: &[Painted], poses: &[Pose3]) -> (OccupiedVoxels, SurfaceMesh) {
    let mut voxels = OccupiedVoxels::new(CELL_M).unwrap();
    add_rays(&mut voxels, bodies, poses);
    (voxels, surface_mesh(&map_of(bodies, poses, voxels_of(0.02))))
}

fn add_rays(voxels: &mut OccupiedVoxels, bodies: &[Painted], poses: &[Pose3]) {
    for pose in poses {
        let image = image(bodies, &camera(), pose);
        voxels.integrate(&image, &camera(), pose, &SurfaceConfig::default()).unwrap();
    }
}

fn states(voxels: &OccupiedVoxels) -> BTreeMap<[i32; 3], VoxelState> {
    voxels.iter().collect()
}

/// Fraction of the vertices in an occupied voxel.
fn covered(voxels: &OccupiedVoxels, mesh: &SurfaceMesh) -> f64 {
    let states = states(voxels);
    let is_in = |at: &&[f32; 3]| {
        let voxel = at.map(|x| (f64::from(x) / CELL_M).floor() as i32);
        states.get(&voxel) == Some(&VoxelState::Occupied)
    };
    mesh.vertices.iter().filter(is_in).count() as f64 / mesh.vertices.len() as f64
}

/// A floor at a slant: the rays on it are sparser than voxels.
fn floor() -> (OccupiedVoxels, SurfaceMesh) {
    let floor = Body::Plane { at: [0.0, 0.0, 0.013], normal: [0.0, 0.0, 1.0] };
    octree(&[grey(floor)], &[look_at([0.0, 0.0, 0.6], [1.5, 0.05, 0.1]); 3])
}

#[test]
fn the_marked_surface_has_no_holes() {
    let (mut voxels, mesh) = floor();
    assert!(covered(&voxels, &mesh) < 0.7, "rays alone: {}", covered(&voxels, &mesh));
    voxels.mark_surface(&mesh).unwrap();
    assert_eq!(covered(&voxels, &mesh), 1.0);
    let states = states(&voxels);
    let occupied = |x: i32, y: i32| states.get(&[x, y, 0]) == Some(&VoxelState::Occupied);
    // Every voxel of the floor from 1 to 2 m ahead.
    let holes =
        (20..40).flat_map(|x| (-6..=6).map(move |y| (x, y))).filter(|&(x, y)| !occupied(x, y)).count();
    assert_eq!(holes, 0);
}

#[test]
fn a_dense_view_of_a_wall_has_no_holes_by_rays_alone() {
    let wall = Body::Plane { at: [0.52, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] };
    let (voxels, mesh) = octree(&[grey(wall)], &[look_at([0.0; 3], [1.0, 0.0, 0.0]); 2]);
    assert!(covered(&voxels, &mesh) > 0.99, "{}", covered(&voxels, &mesh));
}

#[test]
fn marking_adds_occupied_voxels_only_and_twice_is_once() {
    let (mut voxels, mesh) = floor();
    let before = states(&voxels);
    voxels.mark_surface(&SurfaceMesh::default()).unwrap();
    assert_eq!(states(&voxels), before, "an empty mesh marks nothing");
    voxels.mark_surface(&mesh).unwrap();
    let once = states(&voxels);
    let kept = |(voxel, state): (&[i32; 3], &VoxelState)| {
        once[voxel] == *state || once[voxel] == VoxelState::Occupied
    };
    assert!(before.iter().all(kept));
    voxels.mark_surface(&mesh).unwrap();
    assert_eq!(states(&voxels), once);
    // Free space above the floor stays free.
    assert_eq!(once.get(&[20, 0, 4]), Some(&VoxelState::Free));
}

#[test]
fn an_object_that_left_is_free_in_rays_and_surface() {
    let wall = grey(Body::Plane { at: [2.53, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] });
    let ball = grey(Body::Ball { at: [1.4, 0.0, 0.0], radius: 0.3 });
    let pose = look_at([0.0; 3], [1.0, 0.0, 0.0]);
    let (mut voxels, _) = octree(&[wall, ball], &[pose; 3]);
    let near_ball = |voxels: &OccupiedVoxels| {
        let is_near = |at: [i32; 3]| (18..34).contains(&at[0]) && at[1].abs() < 8 && at[2].abs() < 8;
        voxels.iter().filter(|(at, state)| is_near(*at) && *state == VoxelState::Occupied).count()
    };
    assert!(near_ball(&voxels) > 20);
    let mut map = map_of(&[wall, ball], &[pose; 3], voxels_of(0.02));
    add_rays(&mut voxels, &[wall], &[pose; 30]);
    crate::scene::look(&mut map, &[wall], &[pose; 30]);
    voxels.mark_surface(&surface_mesh(&map)).unwrap();
    assert_eq!(near_ball(&voxels), 0);
}

#[test]
fn a_wrong_mesh_or_image_changes_no_voxel() {
    let (mut voxels, mesh) = floor();
    let before = states(&voxels);
    let mut wrong = mesh.clone();
    wrong.vertices.pop();
    let error = voxels.mark_surface(&wrong).unwrap_err().to_string();
    assert!(error.contains("triangle of the mesh") && error.contains("below"), "{error}");
    wrong = mesh;
    wrong.vertices[7][1] = f32::NAN;
    assert!(voxels.mark_surface(&wrong).is_err());
    let floor = [grey(Body::Plane { at: [0.0; 3], normal: [0.0, 0.0, 1.0] })];
    let far = look_at([3e9, 0.0, 0.6], [3e9 + 2.0, 0.0, 0.0]);
    add_rays(&mut voxels, &floor, &[far]);
    assert_eq!(states(&voxels), before);
}
