//! The rooms of a map.
//!
//! Problem: people speak of rooms, a map has cells. Idea: doors are the narrow places of the floor (\[Bormann16\], the segmentation by
//! distances). Where the distance to the nearest wall exceeds half a door, the floor falls apart into one piece for each room. From these
//! pieces the rooms grow over the rest of the floor, from wide places to narrow ones, and meet in the doors. Pieces that no neck separates
//! are joined, and so are pieces that are too small for a room. Obstacles that stand free are furniture, not walls. Cost: a sort of the
//! free cells.

mod furniture;
mod growth;
mod joining;
mod naming_order;
mod outline;
mod regions;
mod room;

pub use room::Room;

use furniture::without_furniture;
use growth::grown;
use joining::joined;
use naming_order::reading_order;
use outline::outline;
use regions::Regions;
use trundle_core::{CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2, require_in};
use trundle_grid::{DistanceField, UnknownIs};

/// Sizes that tell rooms, doors and furniture apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoomLimits {
    /// Width up to which an opening is a door between rooms \[m\], 0.1 to 10. Default 1.
    pub max_door_m: f64,
    /// Smallest area of a room \[m^2\], 0.01 to 1000. Default 1.5.
    pub min_area_m2: f64,
    /// Length up to which an obstacle that stands free is furniture \[m\], 0 to 100. Default 1.5.
    pub max_furniture_m: f64,
}

impl Default for RoomLimits {
    fn default() -> Self {
        Self { max_door_m: 1.0, min_area_m2: 1.5, max_furniture_m: 1.5 }
    }
}

impl RoomLimits {
    /// Returns valid limits unchanged.
    ///
    /// # Errors
    /// When a number is outside the range of its field.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("door width", self.max_door_m, "m", 0.1, 10.0)?;
        require_in("smallest area of a room", self.min_area_m2, "m2", 0.01, 1000.0)?;
        require_in("length of furniture", self.max_furniture_m, "m", 0.0, 100.0)?;
        Ok(self)
    }
}

/// The rooms of a map, in reading order: from the upper left to the lower right.
#[derive(Debug, Clone, PartialEq)]
pub struct MapRooms {
    geometry: GridGeometry,
    /// Index of the room of each cell.
    cells: Vec<Option<u32>>,
    rooms: Vec<Room>,
}

impl MapRooms {
    /// The rooms.
    #[must_use]
    pub fn rooms(&self) -> &[Room] {
        &self.rooms
    }

    /// Position of the cells.
    #[must_use]
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// Index of the room of a cell.
    #[must_use]
    pub fn room_of(&self, cell: CellIndex) -> Option<usize> {
        self.cells[self.geometry.linear(cell)].map(|room| room as usize)
    }

    /// Index of the room at a point of the map frame.
    #[must_use]
    pub fn room_at(&self, point: Vector2) -> Option<usize> {
        self.room_of(self.geometry.cell_at(point)?)
    }
}

/// Divides the free floor of a map into rooms. Furniture within a room belongs to it.
///
/// # Errors
/// When a limit is out of range.
pub fn map_rooms(grid: &OccupancyGrid, limits: RoomLimits) -> Result<MapRooms, Invalid> {
    let limits = limits.validated()?;
    let geometry = *grid.geometry();
    let floor = without_furniture(grid, limits.max_furniture_m);
    let field = DistanceField::from_grid(&floor, UnknownIs::Obstacle);
    let mut regions = grown(&floor, &field, limits.max_door_m / 2.0);
    joined(&mut regions, &field, limits.min_area_m2);
    regions.fill_holes(limits.min_area_m2);
    Ok(listed(geometry, &regions, &field))
}

/// The regions as rooms in reading order.
fn listed(geometry: GridGeometry, regions: &Regions, field: &DistanceField) -> MapRooms {
    let shapes: Vec<(u32, Room)> =
        regions.labels().into_iter().map(|label| (label, room_of(regions, label, field))).collect();
    let order = reading_order(&shapes.iter().map(|(_, room)| room).collect::<Vec<_>>());
    let mut place = vec![None; regions.len()];
    for (index, &shape) in order.iter().enumerate() {
        place[shapes[shape].0 as usize] = Some(index as u32);
    }
    let cells = regions.cells().iter().map(|label| label.and_then(|label| place[label as usize])).collect();
    let rooms = order.iter().map(|&shape| shapes[shape].1.clone()).collect();
    MapRooms { geometry, cells, rooms }
}

fn room_of(regions: &Regions, label: u32, field: &DistanceField) -> Room {
    let geometry = regions.geometry();
    let cells: Vec<usize> = regions.cells_of(label).collect();
    let widest = cells
        .iter()
        .copied()
        .reduce(|best, next| if field.at_linear(next) > field.at_linear(best) { next } else { best });
    let widest = widest.expect("invariant: a region has a cell");
    Room {
        rings: outline(geometry, &cells),
        area_m2: cells.len() as f64 * geometry.resolution * geometry.resolution,
        center: geometry.center(geometry.cell(widest)),
    }
}

#[cfg(test)]
mod tests;
