//! The map of one particle: log-odds and nearest obstacles in small tiles, shared between particles until one writes.

mod draw;
mod field;
mod map;
mod mask;
mod pools;
mod ray;
mod tile;
mod wipe;

pub(crate) use draw::{Brush, DrawScratch};
pub(crate) use field::FieldModel;
pub(crate) use map::{TileMap, TileWindow, tile_bytes};
pub(crate) use pools::{ChunkParts, Pools, assemble};
pub(crate) use tile::{COARSE_SIDE, LOG_ODDS_UNIT, Nearest, TILE_BITS, TILE_CELLS, TILE_SIDE, Tile};
