//! Several maps taken apart into unique tiles and chunks, for files.

use super::tile::{Tile, TileMap};
use crate::tile_grid::{Chunk, TileIndex};
use std::{collections::BTreeMap, sync::Arc};

/// Lowest tile of a chunk, and the indices of its tiles in the chunk with their numbers in the pool.
pub type ChunkParts = (TileIndex, Vec<(u16, u32)>);

/// Tiles and chunks of several maps, each once, referred to by number.
#[derive(Debug)]
pub struct TilePools<'a> {
    /// Unique tiles.
    pub tiles: Vec<&'a Tile>,
    /// Unique chunks.
    pub chunks: Vec<ChunkParts>,
    /// Numbers of the chunks of each map.
    pub maps: Vec<Vec<u32>>,
}

impl<'a> TilePools<'a> {
    /// Pools of the tiles and chunks of `maps`.
    pub fn new(maps: impl Iterator<Item = &'a TileMap>) -> Self {
        let mut pools = Self { tiles: Vec::new(), chunks: Vec::new(), maps: Vec::new() };
        let (mut seen_tiles, mut seen_chunks) = (BTreeMap::new(), BTreeMap::new());
        for map in maps {
            let mut chunks_of_map = Vec::new();
            for (corner, chunk) in map.chunks() {
                let number = *seen_chunks.entry(Arc::as_ptr(chunk)).or_insert_with(|| {
                    let tile = |(index, tile): (usize, &'a Arc<Tile>)| {
                        let number = *seen_tiles.entry(Arc::as_ptr(tile)).or_insert_with(|| {
                            pools.tiles.push(tile);
                            pools.tiles.len() as u32 - 1
                        });
                        (index as u16, number)
                    };
                    let tiles = chunk.tiles().map(tile).collect();
                    pools.chunks.push((corner, tiles));
                    pools.chunks.len() as u32 - 1
                });
                chunks_of_map.push(number);
            }
            pools.maps.push(chunks_of_map);
        }
        pools
    }
}

/// Maps made from these tiles and chunks. The numbers of tiles and chunks must be in range.
pub fn assemble(tiles: Vec<Tile>, chunks: &[ChunkParts], maps: &[Vec<u32>]) -> Vec<TileMap> {
    let tiles: Vec<Arc<Tile>> = tiles.into_iter().map(Arc::new).collect();
    let chunks: Vec<_> = chunks
        .iter()
        .map(|(corner, parts)| {
            let parts = parts.iter().map(|&(at, tile)| (usize::from(at), Arc::clone(&tiles[tile as usize])));
            (*corner, Arc::new(Chunk::with(parts)))
        })
        .collect();
    let map = |numbers: &Vec<u32>| {
        let mut map = TileMap::default();
        for &number in numbers {
            let (corner, chunk) = &chunks[number as usize];
            map.put(*corner, Arc::clone(chunk));
        }
        map
    };
    maps.iter().map(map).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_come_back_from_their_pools_and_shared_tiles_are_stored_once() {
        let mut first = TileMap::default();
        for k in 0..40 {
            first.tile_mut((k - 20, 3 * k)).log_odds[7] = k as i8;
        }
        let mut second = first.clone();
        second.tile_mut((0, 60)).log_odds[7] = -1;
        let pools = TilePools::new([&first, &second].into_iter());
        assert_eq!((pools.tiles.len(), pools.maps.len()), (41, 2));
        let tiles = pools.tiles.iter().map(|tile| (*tile).clone()).collect();
        let again = assemble(tiles, &pools.chunks, &pools.maps);
        for (map, again) in [&first, &second].into_iter().zip(&again) {
            assert_eq!(map.extent(), again.extent());
            for k in -20..20 {
                let at = (k, 3 * (k + 20));
                assert_eq!(map.tile(at).log_odds, again.tile(at).log_odds);
            }
        }
    }
}
