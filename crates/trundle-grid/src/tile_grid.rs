//! Unbounded map of tiles, shared between clones.

use super::tile::Tile;
use crate::tile_directory::TileDirectory;
use std::{collections::BTreeSet, sync::Arc};

const CHUNK_BITS: i32 = 4;
const CHUNK_SIDE: usize = 1 << CHUNK_BITS;

/// Tile of every place where nothing is known.
pub(super) static UNKNOWN_TILE: Tile = Tile::EMPTY;

/// Unbounded map of tiles in chunks of 16 x 16. Clones share chunks and tiles until one of them writes.
///
/// A clone costs one reference for each chunk (26 x 26 m at 5 cm). The cost of a read or a write does not depend on the size of the
/// map. Reference counts are atomic, so clones may live in different threads.
#[derive(Debug, Clone, Default)]
pub struct TileMap {
    chunks: TileDirectory<Chunk>,
}

/// 16 x 16 tiles.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    tiles: [Option<Arc<Tile>>; CHUNK_SIDE * CHUNK_SIDE],
}

impl Chunk {
    const EMPTY: Self = Self { tiles: [const { None }; CHUNK_SIDE * CHUNK_SIDE] };

    /// Stored tiles with their indices.
    pub(super) fn tiles(&self) -> impl Iterator<Item = (usize, &Arc<Tile>)> {
        self.tiles.iter().enumerate().filter_map(|(i, tile)| Some((i, tile.as_ref()?)))
    }

    /// Chunk with tiles at these indices.
    pub(super) fn with(tiles: impl Iterator<Item = (usize, Arc<Tile>)>) -> Self {
        let mut chunk = Self::EMPTY;
        tiles.for_each(|(index, tile)| chunk.tiles[index] = Some(tile));
        chunk
    }

    fn index(tile: (i32, i32)) -> usize {
        const MASK: i32 = CHUNK_SIDE as i32 - 1;
        (((tile.1 & MASK) << CHUNK_BITS) | (tile.0 & MASK)) as usize
    }
}

impl TileMap {
    /// Tile at these tile coordinates; a tile of unknown cells where none is stored.
    pub fn tile(&self, tile: (i32, i32)) -> &Tile {
        self.get(tile).map_or(&UNKNOWN_TILE, |tile| tile)
    }

    /// Tile to write to. Allocates the tile if there is none, and copies it if a clone shares it.
    pub fn tile_mut(&mut self, tile: (i32, i32)) -> &mut Tile {
        let slot = self.chunks.slot_mut(chunk_of(tile));
        let chunk = Arc::make_mut(slot.get_or_insert_with(|| Arc::new(Chunk::EMPTY)));
        Arc::make_mut(chunk.tiles[Chunk::index(tile)].get_or_insert_with(|| Arc::new(Tile::EMPTY)))
    }

    /// Visits the tiles that differ from `before`, an earlier clone of this map or of a relative. A tile that only `before` holds is
    /// visited as `None`. Shared chunks and tiles are skipped by reference.
    pub fn changed_tiles(&self, before: &Self, mut visit: impl FnMut((i32, i32), Option<&Tile>)) {
        for (corner, chunk) in self.chunks() {
            let old = before.chunk(corner);
            if old.is_some_and(|old| Arc::ptr_eq(old, chunk)) {
                continue;
            }
            for (at, tile) in tiles_of(corner, chunk) {
                let same = old.and_then(|old| old.tiles[Chunk::index(at)].as_ref());
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
                if chunk.is_none_or(|chunk| chunk.tiles[Chunk::index(at)].is_none()) {
                    visit(at, None);
                }
            }
        }
    }

    /// Lowest and highest coordinates of the stored tiles; `None` of an empty map.
    pub fn extent(&self) -> Option<((i32, i32), (i32, i32))> {
        let tiles = self.chunks().flat_map(|(corner, chunk)| tiles_of(corner, chunk));
        tiles.fold(None, |bounds, (at, _)| {
            let (low, high): ((i32, i32), (i32, i32)) = bounds.unwrap_or((at, at));
            Some(((low.0.min(at.0), low.1.min(at.1)), (high.0.max(at.0), high.1.max(at.1))))
        })
    }

    /// Stores a chunk at the place of the tile `corner`.
    pub(super) fn put(&mut self, corner: (i32, i32), chunk: Arc<Chunk>) {
        *self.chunks.slot_mut(chunk_of(corner)) = Some(chunk);
    }

    /// Chunks with their lowest tiles.
    pub(super) fn chunks(&self) -> impl Iterator<Item = ((i32, i32), &Arc<Chunk>)> {
        self.chunks.iter().map(|((x, y), chunk)| ((x << CHUNK_BITS, y << CHUNK_BITS), chunk))
    }

    fn get(&self, tile: (i32, i32)) -> Option<&Arc<Tile>> {
        self.chunk(tile)?.tiles[Chunk::index(tile)].as_ref()
    }

    fn chunk(&self, tile: (i32, i32)) -> Option<&Arc<Chunk>> {
        self.chunks.get(chunk_of(tile))
    }
}

fn chunk_of(tile: (i32, i32)) -> (i32, i32) {
    (tile.0 >> CHUNK_BITS, tile.1 >> CHUNK_BITS)
}

fn tiles_of(corner: (i32, i32), chunk: &Chunk) -> impl Iterator<Item = ((i32, i32), &Arc<Tile>)> {
    let at = move |i: usize| (corner.0 + (i % CHUNK_SIDE) as i32, corner.1 + (i / CHUNK_SIDE) as i32);
    chunk.tiles().map(move |(i, tile)| (at(i), tile))
}

/// Bytes of the tiles and directories of several maps. Shared tiles and chunks count once.
pub fn tile_bytes<'a>(maps: impl Iterator<Item = &'a TileMap>) -> usize {
    let (mut chunks, mut tiles, mut directories) = (BTreeSet::new(), BTreeSet::new(), 0);
    for map in maps {
        directories += map.chunks.bytes();
        for (_, chunk) in map.chunks.iter().filter(|(_, chunk)| chunks.insert(Arc::as_ptr(chunk))) {
            tiles.extend(chunk.tiles().map(|(_, tile)| Arc::as_ptr(tile)));
        }
    }
    directories + chunks.len() * size_of::<Chunk>() + tiles.len() * size_of::<Tile>()
}

#[cfg(test)]
mod tests {
    use super::*;
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
            // In the other direction, tiles that only the later map holds are visited as `None`.
            let mut gone = Vec::new();
            before.changed_tiles(&after, |at, tile| gone.extend(tile.is_none().then_some(at)));
            gone.sort_unstable();
            let only_second: Vec<_> = second.keys().filter(|at| !first.contains_key(at)).copied().collect();
            prop_assert_eq!(gone, only_second);
        }
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
