//! Errors of the surface against the true one: by the voxel, the slant and the lens.

use crate::scene::{Body, around, camera, grey, image, look_at, map_of, voxels_of};
use nalgebra::Vector3;
use trundle_core::{Distortion, PinholeCamera, Pose3};
use trundle_surface::{SurfaceMap, SurfaceMesh, surface_mesh};

fn rms(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = errors.len() as f64;
    (errors.map(|error| error * error).sum::<f64>() / count).sqrt()
}

fn points(mesh: &SurfaceMesh) -> impl ExactSizeIterator<Item = Vector3<f64>> {
    mesh.vertices.iter().map(|at| Vector3::from(*at).cast())
}

#[test]
fn smaller_voxels_err_less() {
    let bodies = [grey(Body::Ball { at: [0.0; 3], radius: 0.4 })];
    let error = |voxel: f64| {
        let mesh = surface_mesh(&map_of(&bodies, &around([0.0; 3], 1.0, 30), voxels_of(voxel)));
        rms(points(&mesh).map(|at| at.norm() - 0.4))
    };
    let [fine, middle, coarse] = [0.01, 0.02, 0.04].map(error);
    assert!(fine < middle && middle < coarse, "{fine} {middle} {coarse} m");
    assert!(fine < 0.0025 && middle < 0.004 && coarse < 0.01, "{fine} {middle} {coarse} m");
}

#[test]
fn a_plane_at_a_slant_is_within_a_fraction_of_a_voxel() {
    for slant in [0.0, 20.0, 40.0, 60.0_f64] {
        let (sine, cosine) = slant.to_radians().sin_cos();
        let normal = [-cosine, sine, 0.0];
        let wall = [grey(Body::Plane { at: [2.0, 0.0, 0.0], normal })];
        let mesh = surface_mesh(&map_of(&wall, &[look_at([0.0; 3], [1.0, 0.0, 0.0]); 2], voxels_of(0.02)));
        assert!(mesh.vertices.len() > 2_000, "{slant} deg: {}", mesh.vertices.len());
        let off = |at: Vector3<f64>| (at - Vector3::new(2.0, 0.0, 0.0)).dot(&Vector3::from(normal)).abs();
        let mut errors: Vec<f64> = points(&mesh).map(off).collect();
        errors.sort_by(f64::total_cmp);
        let (median, max) = (errors[errors.len() / 2], errors[errors.len() * 95 / 100]);
        assert!(median < 0.005 && max < 0.02, "{slant} deg: median {median}, 95 % within {max} m");
    }
}

#[test]
fn a_lens_with_distortion_sees_a_flat_wall() {
    let plain = camera();
    let lens = Distortion { k1: -0.2, k2: 0.05, p1: 0.001, ..Distortion::default() };
    let (focal, centre) = ((plain.fx(), plain.fy()), (plain.cx(), plain.cy()));
    let camera = PinholeCamera::new((160, 120), focal, centre, lens).unwrap();
    let wall = [grey(Body::Plane { at: [1.5, 0.0, 0.0], normal: [-0.8, 0.6, 0.0] })];
    let pose = look_at([0.0; 3], [1.0, 0.2, 0.1]);
    let mut map = SurfaceMap::new(voxels_of(0.02)).unwrap();
    (0..2).for_each(|_| map.integrate(&image(&wall, &camera, &pose), &camera, &pose).unwrap());
    let mesh = surface_mesh(&map);
    let off = |at: Vector3<f64>| (at.x - 1.5) * 0.8 - at.y * 0.6;
    assert!(mesh.vertices.len() > 2_000 && rms(points(&mesh).map(off)) < 0.005);
}

/// A map has no preferred place: the scene and its cameras, moved by whole voxels, give the moved mesh.
#[test]
fn a_moved_scene_gives_the_moved_mesh() {
    let shift = Vector3::new(64.0, -128.0, 32.0) * 0.0625;
    let body = |at: Vector3<f64>| [grey(Body::Ball { at: at.into(), radius: 0.4 })];
    let poses = around([0.0; 3], 1.0, 12);
    let moved: Vec<Pose3> =
        poses.iter().map(|pose| Pose3 { translation: pose.translation + shift, ..*pose }).collect();
    let here = surface_mesh(&map_of(&body(Vector3::zeros()), &poses, voxels_of(0.0625)));
    let there = surface_mesh(&map_of(&body(shift), &moved, voxels_of(0.0625)));
    assert!(here.vertices.len() > 200);
    let difference = here.vertices.len().abs_diff(there.vertices.len());
    assert!(difference * 100 <= here.vertices.len(), "{difference} vertices");
    for at in points(&there) {
        let nearest = points(&here).map(|other| (other + shift - at).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.01, "{at:?}: {nearest} m");
    }
}
