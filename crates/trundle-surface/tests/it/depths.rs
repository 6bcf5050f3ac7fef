//! Depths that do not count, and objects that left.

use crate::scene::{Body, camera, grey, look, look_at, map_of, voxels_of};
use trundle_core::{ColorImage, DepthImage, Hypotenuse, Pose3, RgbdImage, Stamp};
use trundle_surface::{OccupiedVoxels, surface_mesh};

const WALL: Body = Body::Plane { at: [3.0, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] };
const BALL: Body = Body::Ball { at: [2.0, 0.1, 0.1], radius: 0.3 };

fn ahead() -> Pose3 {
    look_at([0.0; 3], [1.0, 0.0, 0.0])
}

fn flat(depth: f32) -> RgbdImage {
    let color = ColorImage::filled(160, 120, [250; 3]);
    RgbdImage::new(Stamp::default(), color, DepthImage::filled(160, 120, depth)).unwrap()
}

#[test]
fn depths_that_do_not_count_change_nothing() {
    let mut map = map_of(&[grey(WALL), grey(BALL)], &[ahead(); 3], voxels_of(0.03));
    let (before, memory) = (surface_mesh(&map), map.memory());
    let mut voxels = OccupiedVoxels::new(0.05).unwrap();
    for depth in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0, 0.39, 5.01, 1e30, f32::MIN_POSITIVE]
    {
        map.integrate(&flat(depth), &camera(), &ahead()).unwrap();
        voxels.integrate(&flat(depth), &camera(), &ahead(), map.config()).unwrap();
        assert_eq!((surface_mesh(&map), map.memory()), (before.clone(), memory), "depth {depth} m");
        assert_eq!(voxels.iter().count(), 0, "depth {depth} m");
    }
}

#[test]
fn the_bounds_of_the_depth_are_those_of_the_settings() {
    let mut config = voxels_of(0.05);
    config.min_depth = 1.0;
    config.max_depth = 2.5;
    let vertices = |depth: f32| {
        let mut map = map_of(&[], &[], config);
        (0..3).for_each(|_| map.integrate(&flat(depth), &camera(), &ahead()).unwrap());
        surface_mesh(&map).vertices.len()
    };
    assert_eq!([0.95, 2.55].map(vertices), [0, 0]);
    assert!([1.0, 2.5].map(vertices).iter().all(|count| *count > 100));
}

fn near_ball(vertices: &[[f32; 3]]) -> usize {
    let gap = |at: &&[f32; 3]| (at[0] - 2.0).hypotenuse(at[1] - 0.1).hypotenuse(at[2] - 0.1);
    vertices.iter().filter(|at| gap(at) < 0.4).count()
}

#[test]
fn space_before_the_wall_is_cleared_and_space_behind_is_kept() {
    let mut map = map_of(&[grey(WALL), grey(BALL)], &[ahead(); 5], voxels_of(0.03));
    assert!(near_ball(&surface_mesh(&map).vertices) > 100);
    look(&mut map, &[grey(WALL)], &[ahead(); 30]);
    assert_eq!(near_ball(&surface_mesh(&map).vertices), 0, "the ball left");
    let wall = surface_mesh(&map).vertices.len();
    // A ball before the wall hides the wall behind it; that does not remove the wall.
    look(&mut map, &[grey(WALL), grey(BALL)], &[ahead(); 60]);
    let mesh = surface_mesh(&map);
    let on_wall = mesh.vertices.iter().filter(|at| (at[0] - 3.0).abs() < 0.03).count();
    assert!(near_ball(&mesh.vertices) > 100 && on_wall * 100 > wall * 98, "{on_wall} of {wall}");
}

/// The camera without depth behind an object cannot tell that the object left.
#[test]
fn an_image_without_depth_frees_nothing() {
    let mut map = map_of(&[grey(BALL)], &[ahead(); 4], voxels_of(0.03));
    let before = surface_mesh(&map);
    look(&mut map, &[], &[ahead(); 40]);
    assert_eq!(surface_mesh(&map), before);
}
