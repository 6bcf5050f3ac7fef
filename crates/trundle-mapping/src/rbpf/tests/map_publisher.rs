//! The published grid against the map that it shows.

use crate::rbpf::map_publisher::MapPublisher;
use proptest::prelude::*;
use trundle_core::{Cell, Vector2};
use trundle_grid::tiles::{Tile, TileMap};
use trundle_grid::{GridCell, MapperConfig};

/// Class of a cell by the thresholds of the configuration, in log-odds: 0.65 and 0.196.
fn class(log_odds: i8) -> Cell {
    match f64::from(log_odds) * Tile::LOG_ODDS_UNIT {
        l if l > 0.62 => Cell::Occupied,
        l if l < -1.41 => Cell::Free,
        _ => Cell::Unknown,
    }
}

fn write(map: &mut TileMap, (x, y): (i32, i32), log_odds: i8) {
    map.tile_mut(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)] = log_odds;
}

fn log_odds(map: &TileMap, (x, y): (i32, i32)) -> i8 {
    map.tile(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)]
}

fn any_writes() -> impl Strategy<Value = Vec<((i32, i32), i8)>> {
    // Log-odds between the thresholds are at least one unit away from them.
    let value = prop_oneof![-128..-47_i8, -44..19_i8, 22..127_i8];
    prop::collection::vec(((-90..90_i32, -90..90_i32), value), 1..30)
}

/// Whether the grid shows every cell of a map by its class.
fn shows(publisher: &MapPublisher, map: &TileMap, resolution: f64) -> bool {
    (-96..96).flat_map(|x| (-96..96).map(move |y| (x, y))).all(|(x, y)| {
        let at: Vector2 = GridCell { x, y }.center_cells() * resolution;
        publisher.grid().at(at) == class(log_odds(map, (x, y)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn each_cell_is_shown_by_its_class_whichever_relative_is_shown(
        common in any_writes(), one in any_writes(), other in any_writes(),
    ) {
        let config = MapperConfig::default();
        let mut publisher = MapPublisher::new(&config);
        let mut first = TileMap::default();
        common.iter().for_each(|(at, value)| write(&mut first, *at, *value));
        let mut second = first.clone();
        one.iter().for_each(|(at, value)| write(&mut first, *at, *value));
        other.iter().for_each(|(at, value)| write(&mut second, *at, *value));
        for map in [&first, &second, &first] {
            publisher.show(map);
            prop_assert!(shows(&publisher, map, config.resolution));
        }
    }

    #[test]
    fn a_map_that_is_shown_already_changes_nothing(writes in any_writes()) {
        let mut publisher = MapPublisher::new(&MapperConfig::default());
        let mut map = TileMap::default();
        writes.iter().for_each(|(at, value)| write(&mut map, *at, *value));
        let tiles = publisher.show(&map);
        prop_assert_eq!(tiles, map.tile_count());
        let revision = publisher.revision();
        prop_assert_eq!(publisher.changes_since(revision - 1).count(), tiles);
        prop_assert_eq!(publisher.show(&map.clone()), 0);
        prop_assert_eq!(publisher.revision(), revision);
        prop_assert_eq!(publisher.changes_since(revision).count(), 0);
    }
}
