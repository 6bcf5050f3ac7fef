//! Compact map of tiles for many particles: log-odds in bytes, and the nearest obstacle of each cell.

mod cell_mask;
mod free_update;
mod nearest_field;
mod ray_update;
mod scan_rays;
mod stepped_ray;
mod tile;
mod tile_pools;
mod tile_window;

pub use crate::tile_grid::tile_bytes;
pub use nearest_field::NearestField;
pub use ray_update::{RayUpdate, RayUpdateScratch};
pub use scan_rays::{RaySpan, ScanRay, ScanRays};
pub use tile::{NearestObstacle, Tile, TileMap};
pub use tile_pools::{ChunkParts, TilePools, assemble};
pub use tile_window::TileWindow;

#[cfg(test)]
mod tests;
