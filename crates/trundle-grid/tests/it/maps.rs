//! Laws of grids of log-odds, of published grids, and of compact tiles.

use proptest::prelude::*;
use std::collections::BTreeMap;
use trundle_core::{Cell, Pose2, Vector2};
use trundle_grid::tiles::{
    NearestField, NearestObstacle, RayUpdate, RayUpdateScratch, ScanRays, Tile, TileMap,
};
use trundle_grid::{GridCell, LogOddsGrid, MapperConfig, PublishedGrid, Thresholds, log_odds, probability};

/// Reach of the field of nearest obstacles, cells.
const REACH: i32 = 4;

fn any_obstacles() -> impl Strategy<Value = BTreeMap<(i32, i32), (i32, i32)>> {
    prop::collection::btree_map((-40..40_i32, -40..40_i32), (-7..=7_i32, -7..=7_i32), 1..20)
}

/// The map with these obstacles: cell, and position in the cell in 1/16 cells from its centre.
fn map_of(field: &NearestField, obstacles: &BTreeMap<(i32, i32), (i32, i32)>) -> TileMap {
    let mut map = TileMap::default();
    for (&cell, &(x, y)) in obstacles {
        field.insert(&mut map, cell, NearestObstacle::own(x, y));
    }
    map
}

fn nearest(map: &TileMap, (x, y): (i32, i32)) -> NearestObstacle {
    map.tile(Tile::of_cell(x, y)).nearest[Tile::index(x, y)]
}

/// The smallest squared distance of a cell's centre from an obstacle in the cells within reach, 1/256 cells squared.
fn brute_force(obstacles: &BTreeMap<(i32, i32), (i32, i32)>, (x, y): (i32, i32)) -> Option<i32> {
    let within = obstacles.iter().filter(|((ox, oy), _)| (ox - x).abs() <= REACH && (oy - y).abs() <= REACH);
    within.map(|((ox, oy), (px, py))| ((ox - x) * 16 + px).pow(2) + ((oy - y) * 16 + py).pow(2)).min()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_cell_within_reach_stores_the_nearest_obstacle(obstacles in any_obstacles()) {
        let map = map_of(&NearestField::new(REACH, 1.5), &obstacles);
        for cell in (-45..45).flat_map(|x| (-45..45).map(move |y| (x, y))) {
            let found = nearest(&map, cell);
            let expected = brute_force(&obstacles, cell);
            prop_assert_eq!((!found.is_none()).then(|| found.squared()), expected, "cell {:?}", cell);
        }
    }

    #[test]
    fn an_inserted_and_removed_obstacle_leaves_the_other_distances(obstacles in any_obstacles(), extra in (-40..40_i32, -40..40_i32)) {
        prop_assume!(!obstacles.contains_key(&extra));
        let field = NearestField::new(REACH, 1.5);
        let before = map_of(&field, &obstacles);
        let mut after = before.clone();
        field.insert(&mut after, extra, NearestObstacle::own(0, 0));
        prop_assert!(nearest(&after, extra).is_own());
        field.remove(&mut after, &[extra]);
        prop_assert!(!nearest(&after, extra).is_own());
        for cell in (-45..45).flat_map(|x| (-45..45).map(move |y| (x, y))) {
            let (was, is) = (nearest(&before, cell), nearest(&after, cell));
            // The update adds no obstacle, and none is nearer than the true one.
            prop_assert!(is.is_none() || (!was.is_none() && is.squared() >= was.squared()), "cell {:?}", cell);
        }
    }

    #[test]
    fn a_published_grid_holds_what_was_written_last(writes in prop::collection::vec((-30..30_i32, -30..30_i32, 0_u8..3), 1..60)) {
        let kind = |i: u8| [Cell::Unknown, Cell::Free, Cell::Occupied][usize::from(i)];
        let (mut published, mut model) = (PublishedGrid::new(0.5, 8, (0, 0), (1, 1)), BTreeMap::new());
        for (x, y, value) in writes {
            published.begin_revision();
            published.reach((x >> 3, y >> 3), (x >> 3, y >> 3));
            published.set(GridCell { x, y }, kind(value));
            model.insert((x, y), kind(value));
        }
        for ((x, y), value) in model {
            prop_assert_eq!(published.grid().at(GridCell { x, y }.center_cells() * 0.5), value);
        }
        prop_assert_eq!(published.changes_since(published.revision()).count(), 0);
    }

    #[test]
    fn more_log_odds_are_a_higher_probability_and_zero_is_one_half(a in -9.0..9.0_f64, more in 1e-3..5.0_f64) {
        prop_assert!(probability(a + more) > probability(a));
        prop_assert!((log_odds(probability(a)) - a).abs() < 1e-9);
        prop_assert_eq!((probability(0.0), log_odds(0.5)), (0.5, 0.0));
    }

    #[test]
    fn a_higher_log_odds_is_never_a_freer_class(a in -5.0..5.0_f32, more in 0.0..5.0_f32) {
        let thresholds = Thresholds { occupied_above: 0.6_f32, free_below: -0.8 };
        let rank = |cell: Cell| match cell { Cell::Free => 0, Cell::Unknown => 1, Cell::Occupied => 2 };
        prop_assert!(rank(thresholds.classify(a + more)) >= rank(thresholds.classify(a)));
    }
}

#[test]
fn a_hit_of_evidence_stays_in_its_own_cell() {
    let mut grid = LogOddsGrid::default();
    let cell = GridCell { x: -65, y: 63 };
    grid.entry(cell).add_hit(Vector2::new(0.25, 0.75));
    assert_eq!(grid.get(cell).and_then(|evidence| evidence.hit()), Some(Vector2::new(0.25, 0.75)));
    let beside = GridCell { x: -64, ..cell };
    assert_eq!(grid.get(beside).and_then(|evidence| evidence.hit()), None);
    assert_eq!((grid.log_odds(cell), grid.tile_bounds()), (0.0, ((-2, 0), (1, 1))));
}

#[test]
fn a_cell_set_from_an_occupancy_grid_is_at_the_clamp_of_its_class() {
    let config = MapperConfig::default();
    let update = RayUpdate::new(&config, NearestField::new(REACH, 1.5));
    let mut map = TileMap::default();
    let log_odds =
        |map: &TileMap, x: i32| f64::from(map.tile((0, 0)).log_odds[Tile::index(x, 3)]) * Tile::LOG_ODDS_UNIT;
    update.set(&mut map, (1, 3), Cell::Occupied);
    update.set(&mut map, (2, 3), Cell::Free);
    update.set(&mut map, (3, 3), Cell::Unknown);
    assert_eq!([1, 2, 3].map(|x| log_odds(&map, x)), [config.clamp_high, -config.clamp_low, 0.0]);
    assert!(nearest(&map, (1, 3)).is_own() && !nearest(&map, (2, 3)).is_own());
}

#[test]
fn a_scan_without_rays_changes_no_tile() {
    let update = RayUpdate::new(&MapperConfig::default(), NearestField::new(REACH, 1.5));
    let mut map = TileMap::default();
    let cells =
        update.apply(&mut map, &mut RayUpdateScratch::default(), Pose2::IDENTITY, &ScanRays::default());
    assert_eq!((cells, map.tile_count()), (0, 0));
}
