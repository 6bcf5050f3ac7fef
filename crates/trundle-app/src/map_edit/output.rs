//! The folder of an edited map.

use crate::AppError;
use std::path::PathBuf;
use trundle_core::{Cell, GridGeometry, OccupancyGrid};
use trundle_io::{OutputFolder, Summary, write_map};
use trundle_viz::MapPicture;

/// An edited map whose folder is written.
#[derive(Debug, Clone, PartialEq)]
pub struct EditedMap {
    /// The numbers, one row each.
    pub rows: Vec<Vec<String>>,
    /// The picture to look at.
    pub picture: PathBuf,
}

/// A row of a table.
pub(super) fn row(name: &str, value: impl Into<String>) -> Vec<String> {
    vec![name.to_owned(), value.into()]
}

/// An area \[m^2\] as text.
pub(super) fn area_text(cells: usize, geometry: &GridGeometry) -> String {
    format!("{:.2} m2", area(cells, geometry))
}

/// The area of cells \[m^2\].
pub(super) fn area(cells: usize, geometry: &GridGeometry) -> f64 {
    cells as f64 * geometry.resolution * geometry.resolution
}

/// The numbers of a map for scripts.
pub(super) fn set_map_numbers(summary: &mut Summary, grid: &OccupancyGrid) {
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let count = |value: Cell| grid.cells().iter().filter(|cell| **cell == value).count();
    summary
        .set("success", true)
        .set("resolution_m", resolution)
        .set("origin_x_m", origin.x)
        .set("origin_y_m", origin.y)
        .set("width_cells", width)
        .set("height_cells", height)
        .set("occupied_cells", count(Cell::Occupied))
        .set("free_cells", count(Cell::Free))
        .set("unknown_cells", count(Cell::Unknown))
        .set("free_m2", area(count(Cell::Free), grid.geometry()));
}

/// The size of a map in words.
pub(super) fn size_row(grid: &OccupancyGrid) -> Vec<String> {
    let GridGeometry { resolution, width, height, .. } = *grid.geometry();
    let side = |cells: usize| cells as f64 * resolution;
    row("map", format!("{:.2} x {:.2} m, {width} x {height} cells", side(width), side(height)))
}

/// Writes `map.pgm`, `map.yaml`, `overview.png` and `summary.json`, and commits the folder.
pub(super) fn write_edited(
    grid: &OccupancyGrid,
    summary: &mut Summary,
    rows: Vec<Vec<String>>,
    folder: OutputFolder,
) -> Result<EditedMap, AppError> {
    write_map(&folder, "map", grid)?;
    set_map_numbers(summary, grid);
    let picture = MapPicture::over(grid).to_png();
    write_pictured("overview.png", &picture, summary, rows, folder)
}

/// Writes a picture and `summary.json`, and commits the folder.
pub(super) fn write_pictured(
    name: &str,
    picture: &[u8],
    summary: &Summary,
    rows: Vec<Vec<String>>,
    folder: OutputFolder,
) -> Result<EditedMap, AppError> {
    folder.write(name, picture)?;
    folder.write("summary.json", summary.to_json().as_bytes())?;
    Ok(EditedMap { rows, picture: folder.commit()?.join(name) })
}
