//! Bodies seen from all sides: the mesh is closed, faces outwards and holds their volume.

use crate::scene::{Body, around, grey, map_of, voxels_of};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::f64::consts::PI;
use trundle_surface::{SurfaceMesh, surface_mesh};

const BALL_RADIUS_M: f64 = 0.5;

fn ball(voxel: f64) -> SurfaceMesh {
    let at = [0.03, -0.21, 0.4];
    let bodies = [grey(Body::Ball { at, radius: BALL_RADIUS_M })];
    surface_mesh(&map_of(&bodies, &around(at, 1.4, 40), voxels_of(voxel)))
}

fn corner(mesh: &SurfaceMesh, index: u32) -> Vector3<f64> {
    Vector3::from(mesh.vertices[index as usize]).cast()
}

/// Volume inside the triangles, negative if they face inwards: the sum of tetrahedra at the origin, m^3.
fn signed_volume(mesh: &SurfaceMesh) -> f64 {
    let of = |t: &[u32; 3]| corner(mesh, t[0]).dot(&corner(mesh, t[1]).cross(&corner(mesh, t[2])));
    mesh.triangles.iter().map(of).sum::<f64>() / 6.0
}

/// How many triangles have each directed edge.
fn directed_edges(mesh: &SurfaceMesh) -> HashMap<(u32, u32), usize> {
    let mut edges = HashMap::new();
    for t in &mesh.triangles {
        for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *edges.entry((from, to)).or_default() += 1;
        }
    }
    edges
}

/// Each edge has two opposite directions: the surface has no border, and neighbours face the same side.
fn assert_closed(mesh: &SurfaceMesh) {
    let edges = directed_edges(mesh);
    for ((from, to), count) in &edges {
        assert_eq!(edges.get(&(*to, *from)), Some(count), "edge {from} to {to}");
    }
}

#[test]
fn the_mesh_of_a_ball_is_closed_and_oriented() {
    for voxel in [0.02, 0.04] {
        assert_closed(&ball(voxel));
    }
    let mesh = ball(0.04);
    let edges = directed_edges(&mesh);
    assert!(edges.values().all(|count| *count == 1), "an edge has more than two triangles");
    let euler = mesh.vertices.len() as i64 - edges.len() as i64 / 2 + mesh.triangles.len() as i64;
    assert_eq!(euler, 2, "one closed surface without a handle");
}

#[test]
fn volume_and_area_of_a_ball_are_those_of_the_body() {
    for voxel in [0.02, 0.04] {
        let mesh = ball(voxel);
        let (volume, area) = (4.0 / 3.0 * PI * BALL_RADIUS_M.powi(3), 4.0 * PI * BALL_RADIUS_M.powi(2));
        let ratios = (signed_volume(&mesh) / volume, mesh.area() / area);
        assert!(
            (0.97..1.03).contains(&ratios.0) && (0.97..1.05).contains(&ratios.1),
            "{voxel} m: {ratios:?}"
        );
    }
}

#[test]
fn the_mesh_of_a_block_holds_its_volume() {
    let (low, high) = ([-0.3, -0.2, -0.25], [0.31, 0.22, 0.24]);
    let bodies = [grey(Body::Block { low, high })];
    let mesh = surface_mesh(&map_of(&bodies, &around([0.0; 3], 1.3, 60), voxels_of(0.02)));
    assert_closed(&mesh);
    let ratio = signed_volume(&mesh) / (0.61 * 0.42 * 0.49);
    assert!((0.93..1.03).contains(&ratio), "{ratio}");
}

#[test]
fn normals_are_unit_vectors_out_of_the_body() {
    let mesh = ball(0.02);
    let centre = Vector3::new(0.03, -0.21, 0.4);
    let mut cosines = Vec::new();
    for (at, normal) in mesh.vertices.iter().zip(&mesh.normals) {
        let (at, normal) = (Vector3::from(*at).cast::<f64>(), Vector3::from(*normal).cast::<f64>());
        assert!((normal.norm() - 1.0).abs() < 1e-5);
        cosines.push((at - centre).normalize().dot(&normal));
    }
    cosines.sort_by(f64::total_cmp);
    let (min, median) = (cosines[0], cosines[cosines.len() / 2]);
    assert!(min > 0.9 && median > 0.995, "cosine to the radius: {min} at least, median {median}");
}
