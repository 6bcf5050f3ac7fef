//! Bytes of the tiles of all maps, run-length coded.

use super::{
    bytes::{Reader, Writer},
    error::FilterFileError,
};
use trundle_grid::tiles::{ChunkParts, Tile, TilePools};

/// Writes the tiles of all maps; shared tiles are written once.
pub(crate) fn write(out: &mut Writer, pools: &TilePools<'_>) {
    out.count(pools.tiles.len());
    for tile in &pools.tiles {
        pack(out, tile.bytes());
    }
    out.count(pools.chunks.len());
    for (corner, tiles) in &pools.chunks {
        out.u32(corner.0 as u32);
        out.u32(corner.1 as u32);
        out.count(tiles.len());
        for (place, tile) in tiles {
            out.u16(*place);
            out.u32(*tile);
        }
    }
    out.count(pools.maps.len());
    for chunks in &pools.maps {
        out.count(chunks.len());
        chunks.iter().for_each(|chunk| out.u32(*chunk));
    }
}

/// Tiles, chunks (corner, places with their tiles) and the chunks of each map.
pub(crate) struct ReadPools {
    pub(crate) tiles: Vec<Tile>,
    pub(crate) chunks: Vec<ChunkParts>,
    pub(crate) maps: Vec<Vec<u32>>,
}

/// Maximum tile coordinate of a valid map. Source: ours.
const MAX_TILE_COORDINATE: i32 = 1 << 20;

pub(crate) fn read(bytes: &mut Reader<'_>) -> Result<ReadPools, FilterFileError> {
    bytes.within = "tiles";
    let tiles = (0..bytes.count(2)?).map(|_| unpack(bytes)).collect::<Result<Vec<_>, _>>()?;
    let mut chunks = Vec::new();
    for _ in 0..bytes.count(12)? {
        let corner = (bytes.u32()? as i32, bytes.u32()? as i32);
        let fair = |v: i32| v.abs() <= MAX_TILE_COORDINATE && v % 16 == 0;
        bytes.require(fair(corner.0) && fair(corner.1), "the corner of a chunk of tiles")?;
        let mut of = Vec::new();
        for _ in 0..bytes.count(6)? {
            let place = bytes.u16()?;
            bytes.require(place < 256, "the place of a tile")?;
            of.push((place, bytes.index(tiles.len(), "the number of a tile")? as u32));
        }
        chunks.push((corner, of));
    }
    let mut maps = Vec::new();
    for _ in 0..bytes.count(4)? {
        let mut of = Vec::new();
        for _ in 0..bytes.count(4)? {
            of.push(bytes.index(chunks.len(), "the number of a chunk of tiles")? as u32);
        }
        maps.push(of);
    }
    Ok(ReadPools { tiles, chunks, maps })
}

/// Run-length code. A count c below 128 precedes c + 1 single bytes; a count from 128 on precedes one byte that repeats c - 125 times.
fn pack(out: &mut Writer, bytes: impl Iterator<Item = u8>) {
    let mut literals: Vec<u8> = Vec::new();
    let flush = |out: &mut Writer, literals: &mut Vec<u8>| {
        for part in literals.chunks(128) {
            out.u8(part.len() as u8 - 1);
            out.0.extend(part);
        }
        literals.clear();
    };
    let mut bytes = bytes.peekable();
    while let Some(byte) = bytes.next() {
        let mut run = 1;
        while run < 130 && bytes.next_if_eq(&byte).is_some() {
            run += 1;
        }
        if run < 3 {
            literals.extend(std::iter::repeat_n(byte, run));
        } else {
            flush(out, &mut literals);
            out.u8((run + 125) as u8);
            out.u8(byte);
        }
    }
    flush(out, &mut literals);
}

fn unpack(bytes: &mut Reader<'_>) -> Result<Tile, FilterFileError> {
    let mut all = Vec::with_capacity(3 * Tile::CELLS);
    while all.len() < 3 * Tile::CELLS {
        let what = usize::from(bytes.u8()?);
        if what < 128 {
            for _ in 0..=what {
                all.push(bytes.u8()?);
            }
        } else {
            let byte = bytes.u8()?;
            all.extend(std::iter::repeat_n(byte, what - 125));
        }
    }
    bytes.require(all.len() == 3 * Tile::CELLS, "the length of a tile")?;
    Ok(Tile::from_bytes(&all))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn packing_loses_nothing(runs in prop::collection::vec((any::<u8>(), 1..300_usize), 1..60)) {
            let mut all: Vec<u8> = runs.iter().flat_map(|&(byte, n)| std::iter::repeat_n(byte, n)).collect();
            all.resize(3 * Tile::CELLS, 7);
            let mut out = Writer::default();
            pack(&mut out, all.iter().copied());
            let tile = unpack(&mut Reader::new(&out.0, "test")).unwrap();
            prop_assert_eq!(tile.bytes().collect::<Vec<_>>(), all);
        }
    }
}
