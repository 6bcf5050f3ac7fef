//! `nav_msgs/OccupancyGrid` and `map_msgs/OccupancyGridUpdate`.

use super::stamp;
use crate::generated::geometry_msgs::{Point, Pose, Quaternion};
use crate::generated::map_msgs::OccupancyGridUpdate;
use crate::generated::nav_msgs::{MapMetaData, OccupancyGridMessage};
use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Stamp, Vector2};

/// Value of an unknown cell. Source: `nav_msgs/OccupancyGrid`.
const UNKNOWN_CELL: i8 = -1;
/// Value of a free cell. Source: `nav_msgs/OccupancyGrid`.
const FREE: i8 = 0;
/// Value of an occupied cell. Source: `nav_msgs/OccupancyGrid`.
const OCCUPIED_CELL: i8 = 100;
/// Smallest value of an occupied cell of others. Source: map_server's default `occupied_thresh`, 0.65.
const MIN_OCCUPIED: i8 = 65;
/// Largest value of a free cell of others. Source: map_server's default `free_thresh`, 0.25.
const MAX_FREE: i8 = 25;

/// The grid as a message.
#[must_use]
pub fn to_ros(grid: &OccupancyGrid, at: Stamp, frame: &str) -> OccupancyGridMessage {
    let data = grid.cells().iter().map(|cell| value(*cell)).collect();
    OccupancyGridMessage { header: stamp::header(at, frame), info: info(grid.geometry(), at), data }
}

/// Geometry of the cells, as a message.
#[must_use]
pub fn info(geometry: &GridGeometry, at: Stamp) -> MapMetaData {
    let origin = Pose {
        position: Point { x: geometry.origin.x, y: geometry.origin.y, z: 0.0 },
        orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    };
    MapMetaData {
        map_load_time: stamp::to_ros(at),
        resolution: geometry.resolution as f32,
        width: geometry.width as u32,
        height: geometry.height as u32,
        origin,
    }
}

/// Value of a cell in a message.
#[must_use]
pub fn value(cell: Cell) -> i8 {
    match cell {
        Cell::Unknown => UNKNOWN_CELL,
        Cell::Free => FREE,
        Cell::Occupied => OCCUPIED_CELL,
    }
}

/// The cells that differ between two grids of one geometry, as the rectangle around them; `None` if none does.
#[must_use]
pub fn update(
    old: &OccupancyGrid,
    new: &OccupancyGrid,
    at: Stamp,
    frame: &str,
) -> Option<OccupancyGridUpdate> {
    let geometry = new.geometry();
    let pairs = old.cells().iter().zip(new.cells()).enumerate();
    let mut bounds: Option<[usize; 4]> = None;
    for (i, _) in pairs.filter(|(_, (old, new))| old != new) {
        let cell = geometry.cell(i);
        let [left, bottom, right, top] = bounds.unwrap_or([cell.col, cell.row, cell.col, cell.row]);
        bounds = Some([left.min(cell.col), bottom.min(cell.row), right.max(cell.col), top.max(cell.row)]);
    }
    let [left, bottom, right, top] = bounds?;
    let row = |row: usize| &new.cells()[row * geometry.width + left..=row * geometry.width + right];
    Some(OccupancyGridUpdate {
        header: stamp::header(at, frame),
        x: left as i32,
        y: bottom as i32,
        width: (right - left + 1) as u32,
        height: (top - bottom + 1) as u32,
        data: (bottom..=top).flat_map(row).map(|cell| value(*cell)).collect(),
    })
}

/// The grid of a message; its frame must not be rotated.
///
/// # Errors
/// When size, resolution or origin is not allowed, or the number of cells does not fit.
pub fn from_ros(message: &OccupancyGridMessage) -> Result<OccupancyGrid, Invalid> {
    let info = &message.info;
    let origin = super::pose::pose2(&info.origin)?;
    if origin.theta.abs() > 1e-6 {
        return Err(Invalid::new("turn of the map's origin", origin.theta, "rad", "0"));
    }
    let (width, height) = (info.width as usize, info.height as usize);
    let resolution = f64::from(info.resolution);
    let geometry = GridGeometry::new(resolution, Vector2::new(origin.x, origin.y), width, height)?;
    let cell = |value: &i8| match *value {
        FREE..=MAX_FREE => Cell::Free,
        MIN_OCCUPIED..=OCCUPIED_CELL => Cell::Occupied,
        _ => Cell::Unknown,
    };
    OccupancyGrid::new(geometry, message.data.iter().map(cell).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::CellIndex;

    #[test]
    fn grids_go_there_and_back_and_updates_hold_what_changed() {
        let old = OccupancyGrid::from_ascii(0.05, "#..\n#??\n###").unwrap();
        let message = to_ros(&old, Stamp::default(), "map");
        let back = from_ros(&message).unwrap();
        assert_eq!(back.cells(), old.cells());
        assert_eq!(message.data[..3], [100, 100, 100], "the first row has the lowest y");
        assert_eq!(update(&old, &old, Stamp::default(), "map"), None);
        let mut new = old.clone();
        new.set(CellIndex { col: 1, row: 1 }, Cell::Free);
        new.set(CellIndex { col: 2, row: 2 }, Cell::Occupied);
        let update = update(&old, &new, Stamp::default(), "map").unwrap();
        assert_eq!((update.x, update.y, update.width, update.height), (1, 1, 2, 2));
        assert_eq!(update.data, [0, -1, 0, 100]);
    }

    #[test]
    fn broken_grids_are_refused() {
        let grid = OccupancyGrid::from_ascii(0.05, "#..").unwrap();
        let mut message = to_ros(&grid, Stamp::default(), "map");
        message.data.pop();
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("number of cells is 2"));
        message.info.resolution = f32::NAN;
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("resolution is NaN"));
    }
}
