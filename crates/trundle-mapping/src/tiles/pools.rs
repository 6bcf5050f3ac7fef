use super::{map::TileMap, tile::Tile};
use std::{collections::BTreeMap, sync::Arc};

/// The tile at a chunk's corner, and the places of its tiles with the numbers of those.
pub(crate) type ChunkParts = ((i32, i32), Vec<(u16, u32)>);

/// Several maps taken apart: tiles, chunks and maps, each once, by their numbers.
pub(crate) struct Pools<'a> {
    pub(crate) tiles: Vec<&'a Tile>,
    pub(crate) chunks: Vec<ChunkParts>,
    /// The chunks of each map.
    pub(crate) maps: Vec<Vec<u32>>,
}

impl<'a> Pools<'a> {
    pub(crate) fn new(maps: impl Iterator<Item = &'a TileMap>) -> Self {
        let mut pools = Self { tiles: Vec::new(), chunks: Vec::new(), maps: Vec::new() };
        let (mut seen_tiles, mut seen_chunks) = (BTreeMap::new(), BTreeMap::new());
        for map in maps {
            let mut of = Vec::new();
            for (corner, chunk) in map.chunks() {
                let number = *seen_chunks.entry(Arc::as_ptr(chunk)).or_insert_with(|| {
                    let tile = |(place, tile): (usize, &'a Arc<Tile>)| {
                        let number = *seen_tiles.entry(Arc::as_ptr(tile)).or_insert_with(|| {
                            pools.tiles.push(tile);
                            pools.tiles.len() as u32 - 1
                        });
                        (place as u16, number)
                    };
                    let tiles = chunk.tiles().map(tile).collect();
                    pools.chunks.push((corner, tiles));
                    pools.chunks.len() as u32 - 1
                });
                of.push(number);
            }
            pools.maps.push(of);
        }
        pools
    }
}

/// Maps put together again; the chunks' numbers of tiles and the maps' numbers of chunks must be in range.
pub(crate) fn assemble(tiles: Vec<Tile>, chunks: &[ChunkParts], maps: &[Vec<u32>]) -> Vec<TileMap> {
    let tiles: Vec<Arc<Tile>> = tiles.into_iter().map(Arc::new).collect();
    let chunks: Vec<_> = chunks
        .iter()
        .map(|(corner, of)| {
            let of = of.iter().map(|&(place, tile)| (usize::from(place), Arc::clone(&tiles[tile as usize])));
            (*corner, TileMap::chunk_of(of))
        })
        .collect();
    let map = |of: &Vec<u32>| {
        let mut map = TileMap::default();
        for &chunk in of {
            let (corner, chunk) = &chunks[chunk as usize];
            map.put(*corner, Arc::clone(chunk));
        }
        map
    };
    maps.iter().map(map).collect()
}
