//! Cells that are free by any of nine of their points, not only by their centres.
//!
//! Problem: the middle line of a gap with an even number of cells contains no cell centres. A search over centres then finds no path for a
//! robot that fits with less than half a cell to spare. Between square obstacles the clearance is smallest midway between two faces, two
//! corners, or a face and a corner. These points are centres, middles of edges, or corners of cells.

use crate::search::cell_points::{CellPoints, FreePoints, NO_POINT, OFFSETS, vector};
use crate::search::configuration_space::ConfigurationSpace;

/// The point of each cell: its centre if that is free, else its free point with the largest clearance.
pub(crate) fn free_points(space: &ConfigurationSpace<'_>) -> CellPoints {
    let cells = 0..space.field.geometry().len();
    CellPoints::Free(FreePoints(cells.map(|cell| choose(space, cell)).collect()))
}

fn choose(space: &ConfigurationSpace<'_>, cell: usize) -> u8 {
    if space.is_free_centre(cell) {
        return 0;
    }
    let centre = space.centre(cell);
    if space.field.at_linear(cell) == 0.0 || !space.has_clearance(centre, space.half_diagonal()) {
        return NO_POINT;
    }
    let resolution = space.field.geometry().resolution;
    let clearance = |choice: u8| {
        let point = centre + vector(OFFSETS[usize::from(choice)]) * (resolution / 2.0);
        space.is_free(point).then(|| space.field.clearance(point, space.radius + resolution))
    };
    let free = (1..OFFSETS.len() as u8).filter_map(|choice| Some((choice, clearance(choice)?)));
    free.reduce(|best, next| if next.1 > best.1 { next } else { best }).map_or(NO_POINT, |best| best.0)
}
