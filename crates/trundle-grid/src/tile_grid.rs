//! Unbounded grid of tiles, shared between clones.

use crate::tile_directory::TileDirectory;
use std::{collections::BTreeSet, sync::Arc};

/// Content of one tile of a [`TileGrid`]: a square of cells.
pub trait TileData: Clone + 'static {
    /// Tile of cells without evidence.
    const EMPTY: Self;
}

/// log2 of the side of a chunk in tiles. Source: ours.
const CHUNK_BITS: i32 = 4;
/// Side of a chunk \[tiles\].
const CHUNK_SIDE: usize = 1 << CHUNK_BITS;

/// Tile coordinates.
pub type TileIndex = (i32, i32);

/// Unbounded grid of tiles in chunks of 16 x 16. Clones share chunks and tiles until one of them writes.
///
/// A clone costs one reference for each chunk (26 x 26 m with tiles of 32 cells of 5 cm). The cost of a read or a write does not
/// depend on the size of the grid. Reference counts are atomic, so clones may live in different threads.
#[derive(Debug, Clone)]
pub struct TileGrid<T> {
    chunks: TileDirectory<Chunk<T>>,
    /// Lowest and highest tile of the bounding box.
    extent: Option<(TileIndex, TileIndex)>,
}

impl<T> Default for TileGrid<T> {
    fn default() -> Self {
        Self { chunks: TileDirectory::default(), extent: None }
    }
}

/// 16 x 16 tiles.
#[derive(Debug, Clone)]
pub(crate) struct Chunk<T> {
    tiles: [Option<Arc<T>>; CHUNK_SIDE * CHUNK_SIDE],
}

impl<T> Chunk<T> {
    const EMPTY: Self = Self { tiles: [const { None }; CHUNK_SIDE * CHUNK_SIDE] };

    /// Stored tiles with their indices.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = (usize, &Arc<T>)> {
        self.tiles.iter().enumerate().filter_map(|(i, tile)| Some((i, tile.as_ref()?)))
    }

    /// Chunk with tiles at these indices.
    pub(crate) fn with(tiles: impl Iterator<Item = (usize, Arc<T>)>) -> Self {
        let mut chunk = Self::EMPTY;
        tiles.for_each(|(index, tile)| chunk.tiles[index] = Some(tile));
        chunk
    }

    fn index(tile: TileIndex) -> usize {
        const MASK: i32 = CHUNK_SIDE as i32 - 1;
        (((tile.1 & MASK) << CHUNK_BITS) | (tile.0 & MASK)) as usize
    }
}

impl<T: TileData> TileGrid<T> {
    /// Stored tile at these tile coordinates.
    pub fn stored(&self, tile: TileIndex) -> Option<&T> {
        self.chunk(tile)?.tiles[Chunk::<T>::index(tile)].as_deref()
    }

    /// Tile to write to. Allocates a missing tile, and copies a tile shared with a clone.
    pub fn tile_mut(&mut self, tile: TileIndex) -> &mut T {
        let slot = self.chunks.slot_mut(chunk_of(tile));
        let chunk = Arc::make_mut(slot.get_or_insert_with(|| Arc::new(Chunk::EMPTY)));
        let extent = &mut self.extent;
        let stored = chunk.tiles[Chunk::<T>::index(tile)].get_or_insert_with(|| {
            grow(extent, tile);
            Arc::new(T::EMPTY)
        });
        Arc::make_mut(stored)
    }

    /// Visits the tiles that differ from `before`, an earlier clone of this grid or of a relative. A tile that only `before` holds is
    /// visited as `None`. Shared chunks and tiles are skipped by reference.
    pub fn changed_tiles(&self, before: &Self, mut visit: impl FnMut(TileIndex, Option<&T>)) {
        for (corner, chunk) in self.chunks() {
            let old = before.chunk(corner);
            if old.is_some_and(|old| Arc::ptr_eq(old, chunk)) {
                continue;
            }
            for (at, tile) in tiles_of(corner, chunk) {
                let same = old.and_then(|old| old.tiles[Chunk::<T>::index(at)].as_ref());
                if !same.is_some_and(|same| Arc::ptr_eq(same, tile)) {
                    visit(at, Some(tile));
                }
            }
        }
        for (corner, old) in before.chunks() {
            let chunk = self.chunk(corner);
            if chunk.is_some_and(|chunk| Arc::ptr_eq(old, chunk)) {
                continue;
            }
            for (at, _) in tiles_of(corner, old) {
                if chunk.is_none_or(|chunk| chunk.tiles[Chunk::<T>::index(at)].is_none()) {
                    visit(at, None);
                }
            }
        }
    }

    /// Lowest and highest tile of the bounding box of all stored and reached tiles; `None` for an empty grid.
    pub fn extent(&self) -> Option<(TileIndex, TileIndex)> {
        self.extent
    }

    /// Grows the bounding box to contain a tile, without storing it.
    pub fn reach_tile(&mut self, tile: TileIndex) {
        grow(&mut self.extent, tile);
    }

    /// Number of stored tiles.
    pub fn tile_count(&self) -> usize {
        self.chunks().map(|(_, chunk)| chunk.tiles().count()).sum()
    }

    /// Stores a chunk at the place of the tile `corner`.
    pub(crate) fn put(&mut self, corner: TileIndex, chunk: Arc<Chunk<T>>) {
        tiles_of(corner, &chunk).for_each(|(at, _)| grow(&mut self.extent, at));
        *self.chunks.slot_mut(chunk_of(corner)) = Some(chunk);
    }

    /// Chunks with their lowest tiles.
    pub(crate) fn chunks(&self) -> impl Iterator<Item = (TileIndex, &Arc<Chunk<T>>)> {
        self.chunks.iter().map(|((x, y), chunk)| ((x << CHUNK_BITS, y << CHUNK_BITS), chunk))
    }

    fn chunk(&self, tile: TileIndex) -> Option<&Arc<Chunk<T>>> {
        self.chunks.get(chunk_of(tile))
    }
}

/// Grows a bounding box to contain a tile.
fn grow(extent: &mut Option<(TileIndex, TileIndex)>, tile: TileIndex) {
    let (low, high) = extent.unwrap_or((tile, tile));
    *extent = Some(((low.0.min(tile.0), low.1.min(tile.1)), (high.0.max(tile.0), high.1.max(tile.1))));
}

fn chunk_of(tile: TileIndex) -> (i32, i32) {
    (tile.0 >> CHUNK_BITS, tile.1 >> CHUNK_BITS)
}

fn tiles_of<T>(corner: TileIndex, chunk: &Chunk<T>) -> impl Iterator<Item = (TileIndex, &Arc<T>)> {
    let at = move |i: usize| (corner.0 + (i % CHUNK_SIDE) as i32, corner.1 + (i / CHUNK_SIDE) as i32);
    chunk.tiles().map(move |(i, tile)| (at(i), tile))
}

/// Bytes of the tiles and directories of several grids. Shared tiles and chunks count once.
pub fn tile_bytes<'a, T: TileData>(grids: impl Iterator<Item = &'a TileGrid<T>>) -> usize {
    let (mut chunks, mut tiles, mut directories) = (BTreeSet::new(), BTreeSet::new(), 0);
    for grid in grids {
        directories += grid.chunks.bytes();
        for (_, chunk) in grid.chunks.iter().filter(|(_, chunk)| chunks.insert(Arc::as_ptr(chunk))) {
            tiles.extend(chunk.tiles().map(|(_, tile)| Arc::as_ptr(tile)));
        }
    }
    directories + chunks.len() * size_of::<Chunk<T>>() + tiles.len() * size_of::<T>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::{Tile, TileMap};
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    /// A map whose tiles hold one number each.
    fn write(map: &mut TileMap, at: (i32, i32), value: i8) {
        map.tile_mut(at).log_odds[0] = value;
    }

    proptest! {
        #[test]
        fn the_changed_tiles_are_those_that_were_written(
            first in prop::collection::btree_map((-40..40_i32, -40..40_i32), any::<i8>(), 0..20),
            second in prop::collection::btree_map((-40..40_i32, -40..40_i32), any::<i8>(), 0..20),
        ) {
            let mut before = TileMap::default();
            first.iter().for_each(|(at, value)| write(&mut before, *at, *value));
            let mut after = before.clone();
            second.iter().for_each(|(at, value)| write(&mut after, *at, *value));
            let mut changed = BTreeMap::new();
            after.changed_tiles(&before, |at, tile| {
                changed.insert(at, tile.map(|tile| tile.log_odds[0]));
            });
            let expected: BTreeMap<_, _> = second.iter().map(|(at, value)| (*at, Some(*value))).collect();
            prop_assert_eq!(&changed, &expected);
            for (at, value) in &first {
                prop_assert_eq!(before.tile(*at).log_odds[0], *value, "the original is unchanged");
            }
            // In the other direction, tiles that exist only in the later map are visited as `None`.
            let mut gone = Vec::new();
            before.changed_tiles(&after, |at, tile| gone.extend(tile.is_none().then_some(at)));
            gone.sort_unstable();
            let only_second: Vec<_> = second.keys().filter(|at| !first.contains_key(at)).copied().collect();
            prop_assert_eq!(gone, only_second);
        }
    }

    #[test]
    fn a_reached_tile_is_in_the_extent_and_is_not_stored() {
        let mut map = TileMap::default();
        write(&mut map, (0, 0), 1);
        map.reach_tile((-20, 7));
        assert_eq!(map.extent(), Some(((-20, 0), (0, 7))));
        assert!(map.stored((-20, 7)).is_none() && map.stored((0, 0)).is_some());
        assert_eq!(map.tile_count(), 1);
    }

    #[test]
    fn shared_tiles_count_once() {
        let mut map = TileMap::default();
        write(&mut map, (3, -20), 1);
        let alone = tile_bytes([&map].into_iter());
        let mut clone = map.clone();
        let shared = tile_bytes([&map, &clone].into_iter());
        assert!(shared < alone + 100, "{shared} bytes of two, {alone} of one");
        write(&mut clone, (3, -20), 2);
        assert!(tile_bytes([&map, &clone].into_iter()) > shared + size_of::<Tile>() - 1);
        assert_eq!(map.extent(), Some(((3, -20), (3, -20))));
        assert_eq!(TileMap::default().extent(), None);
    }
}
