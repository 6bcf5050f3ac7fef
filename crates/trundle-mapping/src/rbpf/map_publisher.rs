//! Published occupancy grid of the best particle, updated tile by tile.

use trundle_core::{CellIndex, OccupancyGrid};
use trundle_grid::tiles::{Tile, TileMap};
use trundle_grid::{MapperConfig, PublishedGrid, Thresholds, log_odds};

/// Three-valued grid of a map of tiles.
///
/// The publisher keeps the last published map. Tiles that this map shares with the next one have not changed, so only written tiles are
/// updated, even after a change of the best particle.
#[derive(Debug, Clone)]
pub(crate) struct MapPublisher {
    shown: TileMap,
    published: PublishedGrid,
    /// Thresholds in units of the tiles.
    thresholds: Thresholds<i8>,
}

impl MapPublisher {
    pub(crate) fn new(config: &MapperConfig) -> Self {
        let units = |probability: f64| (log_odds(probability) / Tile::LOG_ODDS_UNIT) as i8;
        Self {
            shown: TileMap::default(),
            published: PublishedGrid::new(config.resolution, Tile::SIDE, (-1, -1), (2, 2)),
            thresholds: Thresholds {
                occupied_above: units(config.occupied_above),
                free_below: units(config.free_below),
            },
        }
    }

    /// Published grid.
    pub(crate) fn grid(&self) -> &OccupancyGrid {
        self.published.grid()
    }

    /// Number of maps with changes that were published.
    pub(crate) fn revision(&self) -> u64 {
        self.published.revision()
    }

    /// Publishes `map`. Returns the number of changed tiles.
    pub(crate) fn show(&mut self, map: &TileMap) -> usize {
        let mut bounds: Option<((i32, i32), (i32, i32))> = None;
        let mut count = 0;
        map.changed_tiles(&self.shown, |at, _| {
            let (low, high) = bounds.unwrap_or((at, at));
            bounds = Some(((low.0.min(at.0), low.1.min(at.1)), (high.0.max(at.0), high.1.max(at.1))));
            count += 1;
        });
        let Some((low, high)) = bounds else { return 0 };
        self.published.reach(low, high);
        self.published.begin_revision();
        let (thresholds, published) = (self.thresholds, &mut self.published);
        map.changed_tiles(&self.shown, |at, tile| {
            let log_odds = |x: usize, y: usize| tile.map_or(0, |tile| tile.log_odds[(y << Tile::BITS) | x]);
            published.set_tile(at, |x, y| thresholds.classify(log_odds(x, y)));
        });
        self.shown = map.clone();
        count
    }

    /// Lowest cell and size (columns, rows) of the parts that changed after `revision`, row by row.
    pub(crate) fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        self.published.changes_since(revision)
    }
}
