//! Memory grows with the area of the surface.

use crate::scene::{Body, grey, look, look_at, map_of, voxels_of};
use trundle_core::Pose3;

const WALL: Body = Body::Plane { at: [0.0; 3], normal: [0.0, -1.0, 0.0] };

/// A view of the wall y = 0 at x, from `distance` m.
fn view(x: f64, distance: f64) -> Pose3 {
    look_at([x, -distance, 0.0], [x, 0.0, 0.0])
}

/// Blocks of a map, by their memory; the capacity of a growing list may be twice its length.
fn memory(poses: &[Pose3], voxel: f64) -> f64 {
    map_of(&[grey(WALL)], poses, voxels_of(voxel)).clone().memory() as f64
}

#[test]
fn memory_follows_the_area_and_not_the_volume_in_view() {
    let [one, two, four] = [1, 2, 4].map(|count| {
        let poses: Vec<Pose3> = (0..count).map(|i| view(f64::from(i) * 4.0, 2.0)).collect();
        memory(&poses, 0.04)
    });
    for ratio in [two / one, four / two] {
        assert!((1.3..3.1).contains(&ratio), "{one} {two} {four} bytes");
    }
    // Twice the distance shows four times the area, and eight times the volume.
    let ratio = memory(&[view(0.0, 4.0)], 0.04) / memory(&[view(0.0, 2.0)], 0.04);
    assert!((2.5..6.1).contains(&ratio), "{ratio}");
}

#[test]
fn half_the_voxel_needs_about_four_times_the_memory() {
    let ratio = memory(&[view(0.0, 2.0)], 0.02) / memory(&[view(0.0, 2.0)], 0.04);
    assert!((2.5..6.1).contains(&ratio), "{ratio}");
}

#[test]
fn the_same_view_again_needs_no_memory() {
    let mut map = map_of(&[grey(WALL)], &[view(0.0, 2.0)], voxels_of(0.04));
    let memory = map.memory();
    look(&mut map, &[grey(WALL)], &[view(0.0, 2.0); 20]);
    assert_eq!(map.memory(), memory);
    assert!(!map.is_full());
}
