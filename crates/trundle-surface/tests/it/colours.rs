//! The colour of a surface is the colour seen.

use crate::scene::{Body, look, look_at, map_of, voxels_of};
use nalgebra::Vector3;
use trundle_surface::surface_mesh;

const WALL: Body = Body::Plane { at: [1.5, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] };
/// Width of a stripe, m.
const STRIPE_M: f64 = 0.25;

fn stripes(at: Vector3<f64>) -> [u8; 3] {
    if (at.y / STRIPE_M).floor().rem_euclid(2.0) < 1.0 { [250, 10, 128] } else { [0, 200, 31] }
}

#[test]
fn stripes_keep_their_colours_and_borders() {
    let pose = look_at([0.0; 3], [1.0, 0.0, 0.0]);
    let mesh = surface_mesh(&map_of(&[(WALL, stripes)], &[pose; 3], voxels_of(0.02)));
    let border = |y: f64| (y / STRIPE_M - (y / STRIPE_M).round()).abs() * STRIPE_M;
    let inside: Vec<_> =
        mesh.vertices.iter().zip(&mesh.colors).filter(|(at, _)| border(f64::from(at[1])) > 0.05).collect();
    assert!(inside.len() > 2_000);
    for (at, color) in inside {
        let expected = stripes(Vector3::from(*at).cast());
        assert!(
            (0..3).all(|i| color[i].abs_diff(expected[i]) <= 1),
            "{at:?}: {color:?}, expected {expected:?}"
        );
    }
}

#[test]
fn colours_of_equal_views_are_averaged() {
    let pose = look_at([0.0; 3], [1.0, 0.0, 0.0]);
    let mut map = map_of(&[(WALL, |_| [200, 0, 50])], &[pose; 3], voxels_of(0.03));
    look(&mut map, &[(WALL, |_| [100, 100, 50])], &[pose; 3]);
    let mesh = surface_mesh(&map);
    assert!(mesh.colors.len() > 1_000);
    assert!(mesh.colors.iter().all(|[r, g, b]| r.abs_diff(150) <= 1 && g.abs_diff(50) <= 1 && *b == 50));
}
