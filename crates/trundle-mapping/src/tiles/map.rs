use super::tile::{TILE_BITS, Tile};
use std::{collections::BTreeSet, sync::Arc};

const CHUNK_BITS: i32 = 4;
const CHUNK_SIDE: usize = 1 << CHUNK_BITS;

/// Tiles where nothing is known are all this one.
static NOTHING: Tile = Tile::EMPTY;

/// A map without bounds: tiles in chunks of 16 x 16, both shared between clones until one of them writes.
///
/// Cloning costs one reference for each chunk (26 x 26 m at 5 cm); reading and writing a cell cost the same however
/// large the map is. References are counted atomically, so clones may live in different threads.
#[derive(Debug, Clone, Default)]
pub(crate) struct TileMap {
    first: (i32, i32),
    cols: usize,
    chunks: Vec<Option<Arc<Chunk>>>,
}

/// 16 x 16 tiles.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    tiles: [Option<Arc<Tile>>; CHUNK_SIDE * CHUNK_SIDE],
}

impl Chunk {
    const EMPTY: Self = Self { tiles: [const { None }; CHUNK_SIDE * CHUNK_SIDE] };

    /// Its tiles with their places.
    pub(super) fn tiles(&self) -> impl Iterator<Item = (usize, &Arc<Tile>)> {
        self.tiles.iter().enumerate().filter_map(|(i, tile)| Some((i, tile.as_ref()?)))
    }

    fn place(tile: (i32, i32)) -> usize {
        const MASK: i32 = CHUNK_SIDE as i32 - 1;
        (((tile.1 & MASK) << CHUNK_BITS) | (tile.0 & MASK)) as usize
    }
}

impl TileMap {
    /// The tile at these tile coordinates; the empty one where nothing was seen.
    pub(crate) fn tile(&self, tile: (i32, i32)) -> &Tile {
        self.get(tile).map_or(&NOTHING, |tile| tile)
    }

    /// The tile to write to, made if there is none, copied if a clone shares it.
    pub(crate) fn tile_mut(&mut self, tile: (i32, i32)) -> &mut Tile {
        let slot = self.reach(tile);
        let chunk = Arc::make_mut(self.chunks[slot].get_or_insert_with(|| Arc::new(Chunk::EMPTY)));
        Arc::make_mut(chunk.tiles[Chunk::place(tile)].get_or_insert_with(|| Arc::new(Tile::EMPTY)))
    }

    /// Tiles that are not the same in `before`, an earlier clone of this map or of a relative: shared parts are not looked at.
    pub(crate) fn changed_tiles(&self, before: &Self, mut each: impl FnMut((i32, i32), Option<&Tile>)) {
        for (corner, chunk) in self.chunks() {
            let old = before.chunk(corner);
            if old.is_some_and(|old| Arc::ptr_eq(old, chunk)) {
                continue;
            }
            for (at, tile) in Self::tiles_of(corner, chunk) {
                let same = old.and_then(|old| old.tiles[Chunk::place(at)].as_ref());
                if !same.is_some_and(|same| Arc::ptr_eq(same, tile)) {
                    each(at, Some(tile));
                }
            }
        }
        // What only the other map knows.
        for (corner, old) in before.chunks() {
            let chunk = self.chunk(corner);
            if chunk.is_some_and(|chunk| Arc::ptr_eq(old, chunk)) {
                continue;
            }
            for (at, _) in Self::tiles_of(corner, old) {
                if chunk.is_none_or(|chunk| chunk.tiles[Chunk::place(at)].is_none()) {
                    each(at, None);
                }
            }
        }
    }

    /// A chunk of tiles at these places.
    pub(super) fn chunk_of(tiles: impl Iterator<Item = (usize, Arc<Tile>)>) -> Arc<Chunk> {
        let mut chunk = Chunk::EMPTY;
        tiles.for_each(|(place, tile)| chunk.tiles[place] = Some(tile));
        Arc::new(chunk)
    }

    /// Puts a chunk where its lowest tile is `corner`.
    pub(super) fn put(&mut self, corner: (i32, i32), chunk: Arc<Chunk>) {
        let slot = self.reach(corner);
        self.chunks[slot] = Some(chunk);
    }

    /// The lowest and the highest coordinates of tiles that hold something.
    pub(crate) fn extent(&self) -> Option<((i32, i32), (i32, i32))> {
        let tiles = self.chunks().flat_map(|(corner, chunk)| Self::tiles_of(corner, chunk));
        tiles.fold(None, |bounds, (at, _)| {
            let (low, high): ((i32, i32), (i32, i32)) = bounds.unwrap_or((at, at));
            Some(((low.0.min(at.0), low.1.min(at.1)), (high.0.max(at.0), high.1.max(at.1))))
        })
    }

    fn get(&self, tile: (i32, i32)) -> Option<&Arc<Tile>> {
        self.chunk(tile)?.tiles[Chunk::place(tile)].as_ref()
    }

    fn chunk(&self, tile: (i32, i32)) -> Option<&Arc<Chunk>> {
        self.slot(tile).and_then(|slot| self.chunks[slot].as_ref())
    }

    /// Each chunk with the tile at its corner.
    pub(super) fn chunks(&self) -> impl Iterator<Item = ((i32, i32), &Arc<Chunk>)> {
        let corner = |i: usize| {
            let (col, row) = ((i % self.cols) as i32, (i / self.cols) as i32);
            ((self.first.0 + col) << CHUNK_BITS, (self.first.1 + row) << CHUNK_BITS)
        };
        self.chunks.iter().enumerate().filter_map(move |(i, chunk)| Some((corner(i), chunk.as_ref()?)))
    }

    fn tiles_of(corner: (i32, i32), chunk: &Chunk) -> impl Iterator<Item = ((i32, i32), &Arc<Tile>)> {
        let at = move |i: usize| (corner.0 + (i % CHUNK_SIDE) as i32, corner.1 + (i / CHUNK_SIDE) as i32);
        chunk.tiles.iter().enumerate().filter_map(move |(i, tile)| Some((at(i), tile.as_ref()?)))
    }

    fn slot(&self, tile: (i32, i32)) -> Option<usize> {
        let (x, y) = (tile.0 >> CHUNK_BITS, tile.1 >> CHUNK_BITS);
        let (col, row) =
            (x.wrapping_sub(self.first.0) as u32 as usize, y.wrapping_sub(self.first.1) as u32 as usize);
        let slot = row.saturating_mul(self.cols).saturating_add(col);
        (col < self.cols && slot < self.chunks.len()).then_some(slot)
    }

    /// Grows the directory so that it holds the chunk of `tile`; its slot.
    fn reach(&mut self, tile: (i32, i32)) -> usize {
        if let Some(slot) = self.slot(tile) {
            return slot;
        }
        let (x, y) = (tile.0 >> CHUNK_BITS, tile.1 >> CHUNK_BITS);
        let rows = self.chunks.len().checked_div(self.cols).unwrap_or(0);
        let (low, high) = if rows == 0 {
            ((x, y), (x, y))
        } else {
            let last = (self.first.0 + self.cols as i32 - 1, self.first.1 + rows as i32 - 1);
            ((self.first.0.min(x), self.first.1.min(y)), (last.0.max(x), last.1.max(y)))
        };
        let (cols, new_rows) = ((high.0 - low.0 + 1) as usize, (high.1 - low.1 + 1) as usize);
        let mut chunks = vec![None; cols * new_rows];
        for (i, chunk) in self.chunks.drain(..).enumerate() {
            let col = (self.first.0 - low.0) as usize + i % self.cols;
            let row = (self.first.1 - low.1) as usize + i / self.cols;
            chunks[row * cols + col] = chunk;
        }
        *self = Self { first: low, cols, chunks };
        self.slot(tile).expect("invariant: the directory was grown to reach the tile")
    }
}

/// Bytes of the tiles and directories of all maps together, what they share counted once.
pub(crate) fn tile_bytes<'a>(maps: impl Iterator<Item = &'a TileMap>) -> usize {
    let (mut chunks, mut tiles, mut directories) = (BTreeSet::new(), BTreeSet::new(), 0);
    for map in maps {
        directories += map.chunks.capacity() * size_of::<Option<Arc<Chunk>>>();
        for chunk in map.chunks.iter().flatten().filter(|chunk| chunks.insert(Arc::as_ptr(chunk))) {
            tiles.extend(chunk.tiles.iter().flatten().map(Arc::as_ptr));
        }
    }
    directories + chunks.len() * size_of::<Chunk>() + tiles.len() * size_of::<Tile>()
}

/// The tiles of a rectangle of the map, for many look-ups.
#[derive(Debug)]
pub(crate) struct TileWindow<'a> {
    /// The lowest cell.
    pub(crate) corner: (i32, i32),
    cols: usize,
    rows: usize,
    tiles: Vec<&'a Tile>,
}

impl<'a> TileWindow<'a> {
    /// Whole tiles that hold all cells from `low` to `high`.
    pub(crate) fn new(map: &'a TileMap, low: (i32, i32), high: (i32, i32)) -> Self {
        let first = (low.0 >> TILE_BITS, low.1 >> TILE_BITS);
        let last = (high.0 >> TILE_BITS, high.1 >> TILE_BITS);
        let (cols, rows) = ((last.0 - first.0 + 1) as usize, (last.1 - first.1 + 1) as usize);
        let mut tiles = Vec::with_capacity(cols * rows);
        for y in first.1..=last.1 {
            tiles.extend((first.0..=last.0).map(|x| map.tile((x, y))));
        }
        Self { corner: (first.0 << TILE_BITS, first.1 << TILE_BITS), cols, rows, tiles }
    }

    /// Columns and rows of tiles.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.cols, self.rows)
    }

    /// The tiles, row by row from the lowest.
    pub(crate) fn tiles(&self) -> &[&'a Tile] {
        &self.tiles
    }

    /// The tile and the place in it of a cell counted from the window's corner; outside, the empty tile's.
    #[inline]
    pub(crate) fn at(&self, x: i32, y: i32) -> (&'a Tile, usize) {
        let (col, row) = ((x >> TILE_BITS) as u32 as usize, (y >> TILE_BITS) as u32 as usize);
        let inside = (col < self.cols) & (row < self.rows);
        let tile = if inside { self.tiles[row * self.cols + col] } else { &NOTHING };
        (tile, Tile::place(x, y))
    }
}
