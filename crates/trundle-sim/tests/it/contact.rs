//! Contacts of the robot with solids, triangles and people.

use crate::{block, shared_data};
use proptest::prelude::*;
use trundle_core::{Cell, Footprint, Pose2, Vector2};
use trundle_sim::import::{GltfOptions, gltf};
use trundle_sim::{
    HeightBand, Lights, Material, Mesh, Mover, Obstacles, SceneSnapshot, Solid, Triangle, World,
};

fn band(low: f64, high: f64) -> HeightBand {
    HeightBand::new(low, high).unwrap()
}

fn mesh(triangles: &[[[f32; 3]; 3]]) -> Mesh {
    let positions: Vec<[f32; 3]> = triangles.concat();
    let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let triangles = corners.map(|corners| Triangle { corners, material: 0 }).collect();
    let plain = Material { name: "plain".into(), color: [128; 3], texture: None };
    let uvs = vec![[0.0; 2]; positions.len()];
    Mesh::new(positions, uvs, triangles, vec![plain]).unwrap()
}

/// The twelve triangles of an upright box, m.
fn box_mesh([x, y, z]: [f32; 3], [w, d, h]: [f32; 3]) -> Mesh {
    let p = |i: usize| {
        let s = |bit: usize, size: f32| if i >> bit & 1 == 1 { size / 2.0 } else { -size / 2.0 };
        [x + s(0, w), y + s(1, d), z + s(2, h)]
    };
    let quads = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    mesh(&quads.map(|[a, b, c, d]| [[p(a), p(b), p(c)], [p(a), p(c), p(d)]]).concat())
}

fn world(solids: Vec<Solid>, meshes: Vec<Mesh>) -> World {
    World::with_meshes(solids, meshes, 1).unwrap()
}

#[test]
fn a_box_of_triangles_is_as_far_as_a_solid_box() {
    let solid = world(vec![block([2.0, 0.0, 0.5], [1.0, 2.0, 1.0], 0.0)], vec![]);
    let shell = world(vec![], vec![box_mesh([2.0, 0.0, 0.5], [1.0, 2.0, 1.0])]);
    let footprints = [
        Footprint::disc(0.2).unwrap(),
        Footprint::polygon(
            [(0.3, 0.1), (-0.3, 0.1), (-0.3, -0.1), (0.3, -0.1)].map(|(x, y)| Vector2::new(x, y)).into(),
        )
        .unwrap(),
    ];
    for footprint in &footprints {
        for pose in [Pose2::new(0.0, 0.0, 0.3), Pose2::new(3.5, 2.1, 1.0), Pose2::new(1.4, 0.0, 0.0)] {
            let [a, b] =
                [&solid, &shell].map(|world| world.clearance(footprint, pose, band(0.1, 0.6)).unwrap());
            assert!((a - b).abs() < 1e-6, "{a} {b} at {pose:?}");
        }
    }
    let inside = shell.clearance(&footprints[0], Pose2::new(2.0, 0.0, 0.0), band(0.1, 0.6)).unwrap();
    assert!((inside - 0.3).abs() < 1e-6, "surfaces count only: {inside}");
}

#[test]
fn triangles_are_clipped_to_the_band() {
    // A ramp that rises with x: 1 m high at x = 2.
    let ramp = mesh(&[[[0.0, -5.0, 0.0], [2.0, 0.0, 1.0], [0.0, 5.0, 0.0]]]);
    let world = world(vec![], vec![ramp]);
    let gap = |low, high, x| {
        world.clearance(&Footprint::disc(0.1).unwrap(), Pose2::new(x, 0.0, 0.0), band(low, high)).unwrap()
    };
    assert!((gap(0.25, 0.5, 0.0) - 0.4).abs() < 1e-9, "the ramp is 0.25 m high at x = 0.5");
    assert!((gap(0.25, 0.5, 2.0) - 0.9).abs() < 1e-9, "and 0.5 m at x = 1");
    assert_eq!(gap(1.1, 2.0, 0.0), f64::INFINITY);
    assert_eq!(gap(-0.5, 0.0, 0.0), f64::INFINITY, "what only borders on the band does not count");
}

#[test]
fn movers_are_met_where_they_stand() {
    let hall = world(vec![block([5.0, 0.0, 1.0], [0.2, 9.0, 2.0], 0.0)], vec![]);
    let body = world(vec![block([0.5, 0.0, 0.5], [0.2, 0.2, 1.0], 0.0)], vec![]);
    let mover = Mover { body: &body, pose: Pose2::new(1.0, 0.0, std::f64::consts::FRAC_PI_2) };
    let lights = Lights::default();
    let stage = SceneSnapshot { world: &hall, movers: &[mover], lights: &lights };
    let disc = Footprint::disc(0.2).unwrap();
    let gap = |x: f64, y: f64| stage.clearance(&disc, Pose2::new(x, y, 0.0), band(0.1, 0.6)).unwrap();
    assert!((gap(1.0, 1.0) - 0.2).abs() < 1e-9, "turned, the body reaches to y = 0.6");
    assert!((gap(4.0, 0.0) - 0.7).abs() < 1e-9, "the wall is nearer");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]
    #[test]
    fn the_true_grid_and_clearance_agree(
        boxes in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64, 0.1..1.5_f64, 0.1..1.5_f64, -3.0..3.0_f64), 1..6),
    ) {
        let solids = boxes.iter().map(|&(x, y, w, d, yaw)| block([x, y, 0.5], [w, d, 1.0], yaw)).collect();
        let world = world(solids, vec![box_mesh([0.3, 0.4, 0.4], [0.7, 0.3, 0.8])]);
        let grid = world.true_grid(0.1, band(0.1, 0.5)).unwrap();
        let obstacles: Obstacles = world.obstacles(band(0.1, 0.5));
        let geometry = *grid.geometry();
        let h = 0.05 * (1.0 - 1e-5);
        let cell = Footprint::polygon([(h, h), (-h, h), (-h, -h), (h, -h)].map(|(x, y)| Vector2::new(x, y)).into());
        let cell = cell.unwrap();
        for i in 0..geometry.len() {
            let center = geometry.center(geometry.cell(i));
            let gap = obstacles.clearance(&cell, Pose2::new(center.x, center.y, 0.0));
            if gap <= 0.0 || gap > 1e-5 {
                prop_assert_eq!(grid.cells()[i] == Cell::Occupied, gap <= 0.0, "cell {} at {}", i, center);
            }
        }
    }
}

fn small_house() -> Option<World> {
    let mesh = gltf(&shared_data("scenes/small_house.glb")?, &GltfOptions::z_up()).unwrap().mesh;
    Some(world(vec![], vec![mesh]))
}

/// The cells of a map_server map that are surely occupied, as points; 0.05 m, origin (-12.5, -12.5).
fn laser_walls(pgm: &[u8]) -> Vec<Vector2> {
    let mut lines = pgm.split_inclusive(|&b| b == b'\n');
    let header: Vec<&[u8]> = lines.by_ref().filter(|line| !line.starts_with(b"#")).take(3).collect();
    let size = std::str::from_utf8(header[1]).unwrap();
    let (width, height) = size.trim().split_once(' ').unwrap();
    let (width, height): (usize, usize) = (width.parse().unwrap(), height.parse().unwrap());
    let pixels = &pgm[pgm.len() - width * height..];
    let occupied = (0..pixels.len()).filter(|&i| pixels[i] < 89);
    let place = |i: usize| ((i % width) as f64 + 0.5, (height - 1 - i / width) as f64 + 0.5);
    occupied.map(place).map(|(x, y)| Vector2::new(x, y) * 0.05 - Vector2::new(12.5, 12.5)).collect()
}

#[test]
fn the_true_grid_of_small_house_holds_the_walls_that_a_laser_saw() {
    let (Some(house), Some(map)) = (small_house(), shared_data("scenes/small_house_map.pgm")) else { return };
    let grid = house.true_grid(0.05, band(0.15, 0.25)).unwrap();
    let walls = laser_walls(&std::fs::read(map).unwrap());
    assert!(walls.len() > 1000, "{}", walls.len());
    let near = |point: &&Vector2, cells: i32| {
        let mut offsets = (-cells..=cells).flat_map(|dx| (-cells..=cells).map(move |dy| (dx, dy)));
        offsets.any(|(dx, dy)| grid.at(**point + Vector2::new(dx.into(), dy.into()) * 0.05) == Cell::Occupied)
    };
    let share = |cells| walls.iter().filter(|p| near(p, cells)).count() as f64 / walls.len() as f64;
    // The map by the laser's SLAM is itself bent: its whole east wall is 13 cm off.
    assert!(share(1) > 0.85 && share(3) > 0.95, "{} within a cell, {} within three", share(1), share(3));
}

#[test]
fn clearance_in_small_house_is_that_of_all_triangles() {
    let Some(house) = small_house() else { return };
    let obstacles = house.obstacles(band(0.012, 0.6));
    let grid = house.true_grid(0.05, band(0.012, 0.6)).unwrap();
    let disc = Footprint::KOBUKI;
    let free =
        (0..grid.geometry().len()).step_by(997).map(|i| grid.geometry().center(grid.geometry().cell(i)));
    for place in free {
        let gap = obstacles.clearance(&disc, Pose2::new(place.x, place.y, 0.0));
        // The nearest occupied cell is about as far.
        if gap > 0.1 {
            let reach = Footprint::disc(0.1755 + gap - 0.08).unwrap();
            assert!(obstacles.clearance(&reach, Pose2::new(place.x, place.y, 0.0)) > 0.0);
            assert_eq!(grid.at(place), Cell::Free);
        }
    }
}
