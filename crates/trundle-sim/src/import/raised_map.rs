//! A three-dimensional world extruded from an occupancy grid.

use super::blocks::{Block, blocks};
use super::{ImportError, ImportFault};
use crate::materials::{Finish, Paint};
use crate::world::{Cuboid, Shape, Solid};
use serde::{Deserialize, Serialize};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2, Vector3, require_in};

/// Side of a slab of floor or ceiling, m: what one painting covers at full sharpness. Source: ours.
const SLAB_SIDE_M: f64 = 10.0;

/// Thickness of floor and ceiling, m. Source: ours.
const SLAB_THICKNESS_M: f64 = 0.1;

/// Bytes of a texel with its mip levels, and texels per metre of the paints. Source: ours.
const TEXEL_BYTES: f64 = 16.0 / 3.0;
const TEXELS_PER_METRE: f64 = 250.0;

/// Paint of hidden faces.
const HIDDEN: Paint = Paint::Flat { color: [150; 3] };

/// Paints of walls: all with texture, for visual navigation.
const WALLS: [Paint; 4] = [
    Paint::Plaster { color: [214, 208, 190], prints: 0.5 },
    Paint::Wallpaper { color: [188, 204, 190] },
    Paint::Bricks,
    Paint::Plaster { color: [190, 200, 214], prints: 0.7 },
];

/// Paints of lower obstacles.
const THINGS: [Paint; 4] = [
    Paint::Veneer { color: [150, 112, 74] },
    Paint::Fabric { color: [120, 70, 66] },
    Paint::Cardboard,
    Paint::Metal { color: [110, 120, 128] },
];

/// Settings of the walls made from a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RaisedMap {
    /// Height of the walls, m, 0.1 to 20. Default 2.5, a room's.
    pub wall_height: f64,
    /// Whether the world has a ceiling. Default true.
    pub ceiling: bool,
    /// Maximum memory that the world's textures may take, GB, 0.01 to 1000. Default 4.
    pub max_memory_gb: f64,
}

impl Default for RaisedMap {
    fn default() -> Self {
        Self { wall_height: 2.5, ceiling: true, max_memory_gb: 4.0 }
    }
}

impl RaisedMap {
    /// Passes valid options through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("wall_height", self.wall_height, "m", 0.1, 20.0)?;
        require_in("max_memory_gb", self.max_memory_gb, "GB", 0.01, 1000.0)?;
        Ok(self)
    }
}

/// The solids of a map: occupied cells as walls, floor (and ceiling) at known cells, in the frame of the map.
///
/// Cells are merged into few boxes. The true grid of the result equals the map. `file` is for messages.
///
/// # Errors
/// When an option is outside its range, the map has no known cell, or its textures exceed the memory limit; the error gives the size of the
/// map.
pub fn raise_map(file: &str, grid: &OccupancyGrid, options: &RaisedMap) -> Result<Vec<Solid>, ImportError> {
    raise(grid, options).map_err(|fault| ImportFault::Invalid(fault).of(file))
}

/// Distance from the world's origin beyond which f32 does not resolve a tenth of a millimetre, m. Source: ours.
const MAX_COORDINATE_M: f64 = 1e5;

fn raise(grid: &OccupancyGrid, options: &RaisedMap) -> Result<Vec<Solid>, Invalid> {
    let options = options.clone().validated()?;
    for (name, value) in
        [("origin x of the map", grid.geometry().origin.x), ("origin y of the map", grid.geometry().origin.y)]
    {
        require_in(name, value, "m", -MAX_COORDINATE_M, MAX_COORDINATE_M)?;
    }
    let slabs = slabs(grid);
    if slabs.is_empty() {
        return Err(Invalid::new("known cells of the map", 0, "", "1 or more"));
    }
    let blocks = blocks(grid);
    let bytes = memory(grid, &blocks, slabs.len(), &options);
    if bytes > options.max_memory_gb * 1e9 {
        let GridGeometry { width, height, .. } = *grid.geometry();
        let value = format!("{:.3} GB ({width} x {height} cells, {} walls)", bytes / 1e9, blocks.len());
        let expected = format!("at most {} GB", options.max_memory_gb);
        return Err(Invalid::new("memory for the textures of the map", value, "", expected));
    }
    let mut solids: Vec<Solid> = blocks.iter().enumerate().map(|(i, b)| wall(grid, b, i, &options)).collect();
    for (low, high) in slabs {
        let floor = finish([HIDDEN; 4], Paint::Tiles { color: [176, 170, 158] }, HIDDEN);
        solids.push(solid((low, high), (-SLAB_THICKNESS_M, 0.0), floor));
        if options.ceiling {
            let top = options.wall_height;
            solids.push(solid(
                (low, high),
                (top, top + SLAB_THICKNESS_M),
                finish([HIDDEN; 4], HIDDEN, Paint::Ceiling),
            ));
        }
    }
    Ok(solids)
}

/// Squares of the plane that hold a known cell, cut to the map.
fn slabs(grid: &OccupancyGrid) -> Vec<(Vector2, Vector2)> {
    let geometry = grid.geometry();
    let cells = ((SLAB_SIDE_M / geometry.resolution).ceil() as usize).max(1);
    let mut slabs = Vec::new();
    for row in (0..geometry.height).step_by(cells) {
        for col in (0..geometry.width).step_by(cells) {
            let (end_row, end_col) = ((row + cells).min(geometry.height), (col + cells).min(geometry.width));
            let known = (row..end_row).any(|row| {
                let row = &grid.cells()[row * geometry.width..(row + 1) * geometry.width];
                row[col..end_col].iter().any(|&cell| cell != Cell::Unknown)
            });
            if known {
                slabs.push((corner(geometry, col, row), corner(geometry, end_col, end_row)));
            }
        }
    }
    slabs
}

fn corner(geometry: &GridGeometry, col: usize, row: usize) -> Vector2 {
    geometry.origin + Vector2::new(col as f64, row as f64) * geometry.resolution
}

fn wall(grid: &OccupancyGrid, block: &Block, index: usize, options: &RaisedMap) -> Solid {
    let low = corner(grid.geometry(), block.cols.0, block.rows.0);
    let high = corner(grid.geometry(), block.cols.1, block.rows.1);
    let is_wall = (high - low).max() > 1.0;
    let paint = if is_wall { WALLS[index % 4] } else { THINGS[index % 4] };
    let sides = visible_sides(grid, block).map(|is_visible| if is_visible { paint } else { HIDDEN });
    solid((low, high), (0.0, options.wall_height), finish(sides, HIDDEN, HIDDEN))
}

/// Whether a free cell is next to the sides +x, -x, +y, -y.
fn visible_sides(grid: &OccupancyGrid, block: &Block) -> [bool; 4] {
    let GridGeometry { width, height, .. } = *grid.geometry();
    let is_free = |col: usize, row: usize| {
        col < width && row < height && grid.get(CellIndex { col, row }) == Cell::Free
    };
    let beside = |col: usize| (block.rows.0..block.rows.1).any(|row| is_free(col, row));
    let along = |row: usize| (block.cols.0..block.cols.1).any(|col| is_free(col, row));
    // An index of -1 wraps to a column outside of any grid.
    [
        beside(block.cols.1),
        beside(block.cols.0.wrapping_sub(1)),
        along(block.rows.1),
        along(block.rows.0.wrapping_sub(1)),
    ]
}

/// Memory of the textures, bytes.
fn memory(grid: &OccupancyGrid, blocks: &[Block], slabs: usize, options: &RaisedMap) -> f64 {
    let texels = |length: f64| (length * TEXELS_PER_METRE / 16.0).ceil() * 16.0;
    let side = |cells: (usize, usize)| texels((cells.1 - cells.0) as f64 * grid.geometry().resolution);
    let face = |block: &Block| {
        let [right, left, up, down] = visible_sides(grid, block).map(f64::from);
        texels(options.wall_height) * ((right + left) * side(block.rows) + (up + down) * side(block.cols))
    };
    let floor =
        slabs as f64 * (SLAB_SIDE_M * TEXELS_PER_METRE).powi(2) * if options.ceiling { 1.25 } else { 1.0 };
    (blocks.iter().map(face).sum::<f64>() + floor) * TEXEL_BYTES
}

fn solid((low, high): (Vector2, Vector2), (bottom, top): (f64, f64), finish: Finish) -> Solid {
    let (middle, size) = ((low + high) / 2.0, high - low);
    let shape = Shape::Cuboid(Cuboid {
        center: Vector3::new(middle.x, middle.y, (bottom + top) / 2.0),
        size: Vector3::new(size.x, size.y, top - bottom),
        yaw: 0.0,
    });
    Solid { shape, finish }
}

fn finish([right, left, back, front]: [Paint; 4], top: Paint, bottom: Paint) -> Finish {
    Finish { faces: [right, left, back, front, top, bottom], ..Finish::all(HIDDEN) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{HeightBand, World};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_true_grid_of_a_raised_map_is_the_map(cells in prop::collection::vec(0..3_u8, 8 * 11)) {
            prop_assume!(cells.iter().any(|&cell| cell > 0));
            let geometry = GridGeometry::new(0.5, Vector2::new(-1.5, 2.0), 11, 8).unwrap();
            let cell = |&c: &u8| [Cell::Unknown, Cell::Free, Cell::Occupied][usize::from(c)];
            let map = OccupancyGrid::new(geometry, cells.iter().map(cell).collect()).unwrap();
            let world = World::new(raise_map("map", &map, &RaisedMap::default()).unwrap(), 1).unwrap();
            let truth = world.true_grid(0.5, HeightBand::new(0.1, 0.5).unwrap()).unwrap();
            for i in 0..geometry.len() {
                let is_occupied = truth.at(geometry.center(geometry.cell(i))) == Cell::Occupied;
                prop_assert_eq!(is_occupied, map.cells()[i] == Cell::Occupied);
            }
        }
    }

    #[test]
    fn a_room_is_few_boxes_painted_where_they_are_seen() {
        let map = OccupancyGrid::from_ascii(0.5, "#####\n#...#\n#...#\n#####\n???##").unwrap();
        let solids = raise_map("room.yaml", &map, &RaisedMap::default()).unwrap();
        // The lower right corner, the rest of the lower wall, both sides, the upper wall; floor and ceiling.
        assert_eq!(solids.len(), 5 + 2);
        let painted: usize =
            solids[..5].iter().map(|s| s.finish.faces.iter().filter(|&&paint| paint != HIDDEN).count()).sum();
        assert_eq!(painted, 5, "what borders on free cells only");
    }

    #[test]
    fn maps_too_large_or_empty_are_refused_by_name() {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 4000, 4000).unwrap();
        let map = OccupancyGrid::filled(geometry, Cell::Free);
        let error = raise_map("city.yaml", &map, &RaisedMap::default()).unwrap_err().to_string();
        assert!(error.starts_with("city.yaml: memory for the textures of the map is "), "{error}");
        assert!(error.contains("(4000 x 4000 cells, 0 walls), expected at most 4 GB"), "{error}");
        let empty = OccupancyGrid::filled(geometry, Cell::Unknown);
        let error = raise_map("sea.yaml", &empty, &RaisedMap::default()).unwrap_err().to_string();
        assert_eq!(error, "sea.yaml: known cells of the map is 0, expected 1 or more");
        let geometry = GridGeometry::new(0.05, Vector2::new(1e10, 0.0), 4, 4).unwrap();
        let far = OccupancyGrid::filled(geometry, Cell::Occupied);
        let error = raise_map("far.yaml", &far, &RaisedMap::default()).unwrap_err().to_string();
        assert!(error.starts_with("far.yaml: origin x of the map is 1"), "{error}");
    }
}
