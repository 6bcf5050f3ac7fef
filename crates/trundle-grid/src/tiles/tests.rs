//! Laws of the ray update of a map of tiles.

use super::*;
use crate::MapperConfig;
use proptest::prelude::*;
use trundle_core::Pose2;

fn update(blind_range: f64) -> RayUpdate {
    RayUpdate::new(&MapperConfig { blind_range, ..MapperConfig::default() }, NearestField::new(4, 2.0))
}

/// Rays of a scan, ends in cells.
fn any_rays() -> impl Strategy<Value = ScanRays> {
    let ray = (-60.0..60.0_f32, -60.0..60.0_f32, any::<bool>(), any::<bool>());
    prop::collection::vec(ray, 1..40).prop_map(|ends| {
        let mut last_hit = false;
        let rays = ends
            .into_iter()
            .map(|(x, y, hit, joined)| {
                let joined = joined && hit && last_hit;
                last_hit = hit;
                ScanRay { x, y, hit, joined, whole: true, hit_weight: 1.0 }
            })
            .collect();
        ScanRays { rays, ..ScanRays::default() }
    })
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-40.0..40.0_f64, -40.0..40.0_f64, -3.0..3.0_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

/// All bytes of a map, tile by tile.
fn bytes(map: &TileMap) -> Vec<((i32, i32), Vec<u8>)> {
    let mut all = Vec::new();
    map.changed_tiles(&TileMap::default(), |at, tile| {
        let tile = tile.expect("invariant: an empty map has no tiles");
        all.push((at, tile.bytes().chain(tile.coarse).collect()));
    });
    all.sort_unstable();
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// An update moved by whole tiles gives the map moved by whole tiles.
    #[test]
    fn the_map_moves_with_the_robot(rays in any_rays(), pose in any_pose(), cols in -40..40_i32, rows in -40..40_i32) {
        // Positions that are multiples of 1/64 cell are exact.
        let grid = |v: f64| (v * 64.0).round() / 64.0;
        let pose = Pose2 { x: grid(pose.x), y: grid(pose.y), theta: 0.0 };
        let rays = ScanRays {
            rays: rays.rays.iter().map(|r| ScanRay { x: grid(r.x.into()) as f32, y: grid(r.y.into()) as f32, ..*r }).collect(),
            ..rays
        };
        let there = Pose2 { x: pose.x + 32.0 * f64::from(cols), y: pose.y + 32.0 * f64::from(rows), ..pose };
        let (mut a, mut b) = (TileMap::default(), TileMap::default());
        let mut scratch = RayUpdateScratch::default();
        let cells = update(0.65).apply(&mut a, &mut scratch, pose, &rays);
        prop_assert_eq!(update(0.65).apply(&mut b, &mut scratch, there, &rays), cells);
        let moved: Vec<_> = bytes(&a).into_iter().map(|((x, y), tile)| ((x + cols, y + rows), tile)).collect();
        let mut moved = moved;
        moved.sort_unstable();
        prop_assert!(moved == bytes(&b));
    }

    /// Buffers have no effect on later scans.
    #[test]
    fn reused_buffers_change_nothing(first in any_rays(), rays in any_rays(), pose in any_pose(), other in any_pose()) {
        let model = update(0.3);
        let mut used = RayUpdateScratch::default();
        model.apply(&mut TileMap::default(), &mut used, other, &first);
        let (mut a, mut b) = (TileMap::default(), TileMap::default());
        model.apply(&mut a, &mut used, pose, &rays);
        model.apply(&mut b, &mut RayUpdateScratch::default(), pose, &rays);
        prop_assert!(bytes(&a) == bytes(&b));
    }

    /// At the clamps a further scan of the same rays changes no log-odds: the update is idempotent.
    #[test]
    fn a_scan_that_is_repeated_reaches_the_clamps_and_stays(rays in any_rays(), pose in any_pose()) {
        let model = update(0.0);
        let (mut map, mut scratch) = (TileMap::default(), RayUpdateScratch::default());
        for _ in 0..12 {
            model.apply(&mut map, &mut scratch, pose, &rays);
        }
        let before = map.clone();
        model.apply(&mut map, &mut scratch, pose, &rays);
        for (at, _) in bytes(&map) {
            prop_assert!(map.tile(at).log_odds == before.tile(at).log_odds);
            prop_assert!(map.tile(at).log_odds.iter().all(|l| [0, -64, 112].contains(l)));
        }
    }

    /// Free rays undo the hits of the same rays: no obstacle is left, in the log-odds and in the nearest obstacles.
    #[test]
    fn free_rays_remove_every_obstacle_that_they_cross(rays in any_rays(), pose in any_pose()) {
        let model = update(0.0);
        let (mut map, mut scratch) = (TileMap::default(), RayUpdateScratch::default());
        model.apply(&mut map, &mut scratch, pose, &rays);
        // Rays of twice the length, each of which crosses the cell of its former end.
        let free = rays.rays.iter().map(|r| ScanRay { x: 2.0 * r.x, y: 2.0 * r.y, hit: false, joined: false, ..*r });
        let free = ScanRays { rays: free.collect(), ..rays.clone() };
        let obstacles = |map: &TileMap| {
            let own = |tile: &Tile| tile.own.iter().map(|row| row.count_ones()).sum::<u32>();
            bytes(map).iter().map(|(at, _)| own(map.tile(*at))).sum::<u32>()
        };
        let before = obstacles(&map);
        for _ in 0..20 {
            model.apply(&mut map, &mut scratch, pose, &free);
        }
        // A ray of cells may miss the cell of a hit by half a cell; all others are removed.
        let after = obstacles(&map);
        prop_assert!(after * 2 <= before, "{after} of {before} are left");
        for (at, _) in bytes(&map) {
            let tile = map.tile(at);
            for i in 0..Tile::CELLS {
                if tile.log_odds[i] <= -26 {
                    prop_assert!(!tile.nearest[i].is_own(), "a free cell holds no obstacle");
                }
            }
        }
    }

    /// The updated coarse likelihood equals the one computed from the nearest obstacles.
    #[test]
    fn the_coarse_likelihood_follows_from_the_nearest_obstacles(
        scans in prop::collection::vec((any_rays(), any_pose()), 1..4),
    ) {
        let model = update(0.3);
        let (mut map, mut scratch) = (TileMap::default(), RayUpdateScratch::default());
        for (rays, pose) in &scans {
            model.apply(&mut map, &mut scratch, *pose, rays);
        }
        for (at, _) in bytes(&map) {
            let mut again = Tile::from_bytes(&map.tile(at).bytes().collect::<Vec<_>>());
            model.nearest.fill_coarse(&mut again);
            prop_assert!(again.coarse == map.tile(at).coarse && again.own == map.tile(at).own);
        }
    }
}

#[test]
fn a_field_without_obstacles_is_empty_again() {
    let field = NearestField::new(5, 2.0);
    let mut map = TileMap::default();
    let cells: Vec<(i32, i32)> = (0..60).map(|i| (i * 37 % 90 - 40, i * 53 % 70 - 30)).collect();
    for (i, &cell) in cells.iter().enumerate() {
        field.insert(&mut map, cell, NearestObstacle::own(i as i32 % 7, -(i as i32) % 5));
    }
    assert!(map.extent().is_some());
    field.remove(&mut map, &cells);
    map.changed_tiles(&TileMap::default(), |at, tile| {
        let tile = tile.expect("invariant: an empty map has no tiles");
        assert!(tile.nearest.iter().all(|nearest| nearest.is_none()), "tile {at:?}");
        assert!(tile.coarse.iter().all(|value| *value == 0) && tile.own.iter().all(|row| *row == 0));
    });
}

#[test]
fn a_set_cell_has_the_clamp_of_its_class_and_an_unknown_one_stays() {
    use trundle_core::Cell;
    let model = update(0.0);
    let mut map = TileMap::default();
    model.set(&mut map, (13, 14), Cell::Occupied);
    model.set(&mut map, (14, 14), Cell::Free);
    model.set(&mut map, (90, 14), Cell::Unknown);
    let tile = map.tile((0, 0));
    assert_eq!((tile.log_odds[Tile::index(13, 14)], tile.log_odds[Tile::index(14, 14)]), (112, -64));
    assert!(tile.nearest[Tile::index(13, 14)].is_own() && !tile.nearest[Tile::index(14, 14)].is_own());
    assert_eq!(map.extent(), Some(((0, 0), (0, 0))));
}
